"""Pads raised before the sweep, which redefines the static state; on top of the file's ride height."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar

from doe_kc.axle.model import Axle
from doe_kc.effects._base import Effect, Option, Part, effect
from doe_kc.effects.hypothesis import Size


@effect
class RideHeightOffset(Effect):
    """Ride-height offset."""

    id: ClassVar[str] = "ride_height_offset"
    label: ClassVar[str] = "Ride-height offset"
    part: ClassVar[Part] = "axle"
    table: ClassVar[str] = "ride_height"
    options: ClassVar[Mapping[str, Option]] = {
        "offset_mm": Option(7.0, "mm", positive=False),
    }

    physics: ClassVar[str] = (
        "The car stood higher or lower on the rig than in the model, so that every sweep starts at another "
        "point of the wheel's path."
    )
    mistaken_for: ClassVar[tuple[str, ...]] = ("ride_height", "bushing_preload", "static.toe")
    shown_by: ClassVar[str] = "the height of the wheel arch over the wheel centre, measured before the sweep"
    sizes: ClassVar[tuple[Size, ...]] = (Size("offset_mm", 7.0, "mm", signed=True),)
    replaces: ClassVar[tuple[str, ...]] = ("ride_height",)

    def combined(self, before: Mapping[str, Any], after: Mapping[str, Any], axle: Axle) -> dict[str, Any]:
        one, other = self.read(before, axle.name), self.read(after, axle.name)
        return {"offset_mm": one["offset_mm"] + other["offset_mm"]}

    def extend(self, axle: Axle, options: Mapping[str, Any]) -> Axle:
        return axle.changed({"ride_height": axle.values["ride_height"] + options["offset_mm"]})
