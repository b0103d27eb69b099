"""Steering input at the pinion."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from doe_kc.ground.typing import FloatArray
from doe_kc.load_cases._base import (
    Controls,
    Datum,
    LoadCase,
    held_pads,
    load_case,
)


@dataclass(frozen=True)
class Steer(LoadCase):
    """Steering-wheel angle in deg, + moves the rack to the right (+Y); pads hold their height."""

    id: ClassVar[str] = "steer"
    label: ClassVar[str] = "Steering input"
    channel: ClassVar[str] = "steering_wheel"
    unit: ClassVar[str] = "deg"
    input_label: ClassVar[str] = "Steering-wheel angle (rack to the right +)"
    window: ClassVar[float] = 100.0

    def controls(self, value: FloatArray, static: Datum) -> Controls:
        return held_pads(static) | {"rack": value * static.rack_mm_per_rev / 360.0}


load_case(Steer(amplitude=60.0 * 360.0 / 52.0, steps=30))
