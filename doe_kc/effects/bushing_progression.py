"""Cubic progression F = k (d + b d^3) of bushings: LLR = [bx, by, bz] in 1/mm^2."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar

from doe_kc.axle.model import BUSHINGS, Axle, both
from doe_kc.effects._base import Effect, effect, per_bushing
from doe_kc.errors import InputError


@effect
class BushingProgression(Effect):
    """Bushing progression."""

    id: ClassVar[str] = "bushing_progression"
    label: ClassVar[str] = "Bushing progression"
    table: ClassVar[str] = "bushing_cubic"

    def read(self, given: Mapping[str, Any], source: str) -> dict[str, Any]:
        default = {"LLR": [0.05, 0.05, 0.05], "UPB": [0.02, 0.02, 0.02]}
        checked = per_bushing(given or default, BUSHINGS, 3, source)
        for bushing, values in checked.items():
            if min(values) < 0:
                raise InputError(
                    f"{source}: effect {self.id}: {bushing.upper()} = {values}, expected numbers >= 0; "
                    "a negative progression lets the force fall at large deflection."
                )
        return checked

    def extend(self, axle: Axle, options: Mapping[str, Any]) -> Axle:
        values: dict[str, float] = {}
        for bushing, cubic in options.items():
            for axis, value in zip(("Fx", "Fy", "Fz"), cubic, strict=True):
                values |= both(f"{bushing}.cubic.{axis}", value)
        return axle.changed(values)
