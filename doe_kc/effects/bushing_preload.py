"""Offset forces f0 of bushings in local axes, mirrored on the right: LLR = [Fx, Fy, Fz] in N."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar

from doe_kc.axle.model import BUSHINGS, Axle, both
from doe_kc.effects._base import Effect, effect, per_bushing


@effect
class BushingPreload(Effect):
    """Bushing preload."""

    id: ClassVar[str] = "bushing_preload"
    label: ClassVar[str] = "Bushing preload"

    def read(self, given: Mapping[str, Any], source: str) -> dict[str, Any]:
        return per_bushing(given or {"LLR": [0.0, 600.0, 0.0]}, BUSHINGS, 3, source)

    def extend(self, axle: Axle, options: Mapping[str, Any]) -> Axle:
        values: dict[str, float] = {}
        for bushing, force in options.items():
            for axis, value in zip(("Fx", "Fy", "Fz"), force, strict=True):
                values |= both(f"{bushing}.preload.{axis}", value)
        return axle.changed(values)
