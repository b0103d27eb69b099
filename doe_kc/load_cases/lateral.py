"""Lateral force at the ground, in phase: + = to the right on both wheels."""

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
class Lateral(LoadCase):
    """Force in N at each contact point, + = to the right on both wheels; pads hold their height."""

    id: ClassVar[str] = "lateral"
    label: ClassVar[str] = "Lateral force"
    channel: ClassVar[str] = "force_y"
    unit: ClassVar[str] = "N"
    input_label: ClassVar[str] = "Lateral force per wheel (both wheels to the right +)"
    window: ClassVar[float] = 1000.0

    def controls(self, value: FloatArray, static: Datum) -> Controls:
        return held_pads(static) | {"lateral_L": value, "lateral_R": value}


load_case(Lateral(amplitude=2000.0, steps=20))
