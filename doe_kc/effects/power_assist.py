"""Power assist that is still active on the rig: it adds to the column's force, the more that is there."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any, ClassVar

from doe_kc.axle.model import Axle
from doe_kc.effects._base import Effect, Option, Part, effect
from doe_kc.effects.hypothesis import Size


@effect
class PowerAssist(Effect):
    """Power assist active."""

    id: ClassVar[str] = "power_assist"
    label: ClassVar[str] = "Power assist active"
    part: ClassVar[Part] = "rack"
    options: ClassVar[Mapping[str, Option]] = {
        "gain": Option(1.0, "-"),
        "reference_N": Option(300.0, "N"),
    }

    physics: ClassVar[str] = (
        "The power assist was on: it helps to hold the rack as soon as the column is wound up, so that toe "
        "answers large loads less than small ones."
    )
    mistaken_for: ClassVar[tuple[str, ...]] = ("bushing_progression", "scb.Tz", "steering_friction")
    shown_by: ClassVar[str] = "lateral force in phase with the engine on and off"
    sizes: ClassVar[tuple[Size, ...]] = (
        Size("gain", 1.0, "-"),
        Size("reference_N", 300.0, "N", "shape"),
    )

    def extend(self, axle: Axle, options: Mapping[str, Any]) -> Axle:
        changed = axle.changed(
            {"power_assist.gain": options["gain"], "power_assist.reference": options["reference_N"]}
        )
        return replace(changed, topology=replace(axle.topology, power_assist=True))
