"""Lateral force in opposition at the ground."""

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
class LateralOpposite(LoadCase):
    """Force in N at each contact point, + = inwards on both (to the right on the left wheel); pads held."""

    id: ClassVar[str] = "lateral_opposite"
    label: ClassVar[str] = "Lateral force, opposite"
    channel: ClassVar[str] = "force_y"
    unit: ClassVar[str] = "N"
    input_label: ClassVar[str] = "Lateral force per wheel (inwards +)"
    window: ClassVar[float] = 1000.0

    def controls(self, value: FloatArray, static: Datum) -> Controls:
        return held_pads(static) | {"lateral_L": value, "lateral_R": -value}


load_case(LateralOpposite(amplitude=2000.0, steps=20))
