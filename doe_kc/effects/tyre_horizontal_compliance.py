"""The contact point moves by F / k along a horizontal force."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any, ClassVar

from doe_kc.axle.model import Axle, both
from doe_kc.effects._base import Effect, Option, effect


@effect
class TyreHorizontalCompliance(Effect):
    """Tyre horizontal compliance."""

    id: ClassVar[str] = "tyre_horizontal_compliance"
    label: ClassVar[str] = "Tyre horizontal compliance"
    table: ClassVar[str] = "tyre_horizontal"
    options: ClassVar[Mapping[str, Option]] = {
        "k_lat_N_mm": Option(180.0, "N/mm"),
        "k_long_N_mm": Option(250.0, "N/mm"),
    }

    def extend(self, axle: Axle, options: Mapping[str, Any]) -> Axle:
        changed = axle.changed(
            both("tyre.lat_rate", options["k_lat_N_mm"]) | both("tyre.long_rate", options["k_long_N_mm"])
        )
        return replace(changed, topology=replace(axle.topology, tyre_horizontal=True))
