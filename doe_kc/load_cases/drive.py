"""Drive force at the wheel centre."""

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
class Drive(LoadCase):
    """Force in N at each wheel centre, + = forwards; pads hold their height."""

    id: ClassVar[str] = "drive"
    label: ClassVar[str] = "Drive force"
    channel: ClassVar[str] = "force_x"
    unit: ClassVar[str] = "N"
    input_label: ClassVar[str] = "Drive force per wheel (forwards +)"
    window: ClassVar[float] = 1000.0

    def controls(self, value: FloatArray, static: Datum) -> Controls:
        return held_pads(static) | {"drive_L": value, "drive_R": value}


load_case(Drive(amplitude=2000.0, steps=20))
