"""Rack travel per turn of the steering wheel that is not the data sheet's: factor on rack_mm_per_rev."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar

from doe_kc.axle.model import Axle
from doe_kc.effects._base import Effect, Option, Part, effect
from doe_kc.effects.hypothesis import Size


@effect
class SteeringRatio(Effect):
    """Wrong steering ratio."""

    id: ClassVar[str] = "steering_ratio"
    label: ClassVar[str] = "Wrong steering ratio"
    part: ClassVar[Part] = "rack"
    options: ClassVar[Mapping[str, Option]] = {"factor": Option(1.03, "-")}

    physics: ClassVar[str] = (
        "The pinion has another pitch than the model's, so that one turn of the steering wheel moves the "
        "rack further or less far."
    )
    mistaken_for: ClassVar[tuple[str, ...]] = ("rig_input_gain", "ROB.x", "tie_rod_compliance")
    shown_by: ClassVar[str] = "rack travel over steering-wheel angle with unloaded wheels"
    sizes: ClassVar[tuple[Size, ...]] = (Size("factor", 1.03, "-", "factor", signed=True),)

    def combined(self, before: Mapping[str, Any], after: Mapping[str, Any], axle: Axle) -> dict[str, Any]:
        one, other = self.read(before, axle.name), self.read(after, axle.name)
        return {"factor": one["factor"] * other["factor"]}

    def extend(self, axle: Axle, options: Mapping[str, Any]) -> Axle:
        return axle.changed({"steering.rack_mm_per_rev": options["factor"] * axle.rack_mm_per_rev})
