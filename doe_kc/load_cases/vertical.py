"""Vertical motion: both pads move together, or both wheel centres by a two-sided actuator."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Literal

from doe_kc.ground.typing import FloatArray
from doe_kc.load_cases._base import Controls, Datum, LoadCase, load_case


@dataclass(frozen=True)
class Vertical(LoadCase):
    """Parallel wheel travel; input = travel in mm, + = wheels up.

    control: "pad" prescribes the pads (the tyre can lift off); "wheel" prescribes the travel of the
        wheel centres by an actuator that may also pull, so the tyre load can be negative.
    """

    control: Literal["pad", "wheel"] = "pad"

    id: ClassVar[str] = "vertical"
    label: ClassVar[str] = "Vertical motion"
    channel: ClassVar[str] = "pad_z"
    unit: ClassVar[str] = "mm"
    input_label: ClassVar[str] = "Pad travel (up +)"
    window: ClassVar[float] = 20.0

    def controls(self, value: FloatArray, static: Datum) -> Controls:
        if self.control == "wheel":
            left, right = static.wheel_centre_z
            return {
                "hold_wheel_centre": 1.0,
                "bilateral": 1.0,
                "wc_z_L": left + value,
                "wc_z_R": right + value,
            }
        return {"pad_L": static.pad[0] + value, "pad_R": static.pad[1] + value}


load_case(Vertical(amplitude=80.0, steps=32))
