"""The contact point moves by F / k along a horizontal force."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any, ClassVar

from doe_kc.axle.model import Axle, both
from doe_kc.effects._base import Effect, Option, Part, effect
from doe_kc.effects.hypothesis import Size


@effect
class TyreHorizontalCompliance(Effect):
    """Tyre horizontal compliance."""

    id: ClassVar[str] = "tyre_horizontal_compliance"
    label: ClassVar[str] = "Tyre horizontal compliance"
    part: ClassVar[Part] = "axle"
    table: ClassVar[str] = "tyre_horizontal"
    options: ClassVar[Mapping[str, Option]] = {
        "k_lat_N_mm": Option(180.0, "N/mm"),
        "k_long_N_mm": Option(250.0, "N/mm"),
    }

    physics: ClassVar[str] = (
        "The contact patch moves under the wheel along a horizontal force, and the tyre load's lever with it."
    )
    mistaken_for: ClassVar[tuple[str, ...]] = ("hub_compliance", "tyre.rate", "bushing_progression")
    shown_by: ClassVar[str] = "travel of the pad against travel of the wheel centre under the same force"
    sizes: ClassVar[tuple[Size, ...]] = (
        Size("k_lat_N_mm", 180.0, "N/mm", "compliance"),
        Size("k_long_N_mm", 250.0, "N/mm", "compliance"),
    )

    def extend(self, axle: Axle, options: Mapping[str, Any]) -> Axle:
        changed = axle.changed(
            both("tyre.lat_rate", options["k_lat_N_mm"]) | both("tyre.long_rate", options["k_long_N_mm"])
        )
        return replace(changed, topology=replace(axle.topology, tyre_horizontal=True))
