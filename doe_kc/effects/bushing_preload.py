"""Offset forces f0 of bushings in local axes, mirrored on the right: LLR = [Fx, Fy, Fz] in N."""

from __future__ import annotations

from typing import ClassVar

from doe_kc.effects._base import Part, effect
from doe_kc.effects._bushing_values import BushingValues


@effect
class BushingPreload(BushingValues):
    """Bushing preload."""

    id: ClassVar[str] = "bushing_preload"
    label: ClassVar[str] = "Bushing preload"
    part: ClassVar[Part] = "axle"
    quantity: ClassVar[str] = "preload"
    unit: ClassVar[str] = "N"
    signed: ClassVar[bool] = True
    usual: ClassVar[float] = 600.0

    physics: ClassVar[str] = (
        "A bushing was clamped or swaged off its free position and pushes on the arm at ride height."
    )
    mistaken_for: ClassVar[tuple[str, ...]] = ("ride_height_offset", "bushing_progression", "static.toe")
    shown_by: ClassVar[str] = "loosen and re-torque the bushing at ride height, then repeat the alignment"

    def default(self) -> dict[str, list[float]]:
        return {"LLR": [0.0, 600.0, 0.0]}
