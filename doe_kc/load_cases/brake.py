"""Brake force at the ground with the wheel locked."""

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
class Brake(LoadCase):
    """Force in N at each contact point, wheel locked to the knuckle, + = rearwards; pads held."""

    id: ClassVar[str] = "brake"
    label: ClassVar[str] = "Brake force"
    channel: ClassVar[str] = "force_x"
    unit: ClassVar[str] = "N"
    input_label: ClassVar[str] = "Brake force per wheel (rearwards +)"
    window: ClassVar[float] = 1000.0

    def controls(self, value: FloatArray, static: Datum) -> Controls:
        return held_pads(static) | {"brake_L": value, "brake_R": value}


load_case(Brake(amplitude=2000.0, steps=20))
