"""Cubic progression F = k (d + b d^3) of bushings: LLR = [bx, by, bz] in 1/mm^2."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar

from doe_kc.axle.places import Places
from doe_kc.effects._base import Part, effect
from doe_kc.effects._bushing_values import BushingValues
from doe_kc.effects._places import DEFAULT_PLACES
from doe_kc.ground.errors import InputError


@effect
class BushingProgression(BushingValues):
    """Bushing progression."""

    id: ClassVar[str] = "bushing_progression"
    label: ClassVar[str] = "Bushing progression"
    part: ClassVar[Part] = "axle"
    table: ClassVar[str] = "bushing_cubic"
    quantity: ClassVar[str] = "cubic"
    unit: ClassVar[str] = "1/mm^2"
    signed: ClassVar[bool] = False
    usual: ClassVar[float] = 0.05
    typical: ClassVar[Mapping[str, float]] = {"upb": 0.02}

    most: ClassVar[float] = 10.0
    """Typical is of a bushing that works over 2 mm; one that has its stop within 1 mm looks far sharper."""

    physics: ClassVar[str] = (
        "A bushing stiffens as it deflects, so that compliance curves flatten towards large loads."
    )
    mistaken_for: ClassVar[tuple[str, ...]] = ("bushing_preload", "tie_rod_free_play", "power_assist")
    shown_by: ClassVar[str] = "force over deflection of the bushing on a test bench; loads of twice the size"

    def default(self) -> dict[str, list[float]]:
        return {"LLR": [0.05, 0.05, 0.05], "UPB": [0.02, 0.02, 0.02]}

    def read(
        self, options: Mapping[str, Any], source: str, places: Places = DEFAULT_PLACES
    ) -> dict[str, Any]:
        checked = super().read(options, source, places)
        for bushing, values in checked.items():
            if bushing != "added" and min(values) < 0:
                raise InputError(
                    f"{source}: effect {self.id}: {bushing.upper()} = {values}, expected numbers >= 0; "
                    "a negative progression lets the force fall at large deflection."
                )
        return checked
