"""Lateral force in phase, 30 mm behind the contact point."""

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
class LateralOffset(LoadCase):
    """Force in N at the ground, 30 mm behind each contact point, + = to the right; pads hold their height."""

    offset: float = 30.0
    """Distance of the force behind the contact point, mm."""

    id: ClassVar[str] = "lateral_offset"
    label: ClassVar[str] = "Lateral force, 30 mm offset"
    channel: ClassVar[str] = "force_y"
    unit: ClassVar[str] = "N"
    input_label: ClassVar[str] = "Lateral force per wheel (both wheels to the right +)"
    window: ClassVar[float] = 1000.0

    def controls(self, value: FloatArray, static: Datum) -> Controls:
        return held_pads(static) | {
            "lateral_L": value,
            "lateral_R": value,
            "lateral_offset": self.offset,
        }


load_case(LateralOffset(amplitude=2000.0, steps=20))
