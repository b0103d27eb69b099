"""Pads raised before the sweep, which redefines the static state."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar

from doe_kc.axle.model import Axle
from doe_kc.effects._base import Effect, Option, effect


@effect
class RideHeightOffset(Effect):
    """Ride-height offset."""

    id: ClassVar[str] = "ride_height_offset"
    label: ClassVar[str] = "Ride-height offset"
    table: ClassVar[str] = "ride_height"
    options: ClassVar[Mapping[str, Option]] = {
        "offset_mm": Option(7.0, "mm", positive=False),
    }

    def extend(self, axle: Axle, options: Mapping[str, Any]) -> Axle:
        return axle.changed({"ride_height": options["offset_mm"]})
