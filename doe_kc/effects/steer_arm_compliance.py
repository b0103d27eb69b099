"""Steer arm as a round steel beam from SAH to ROB; its stiffness follows the outer radius."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any, ClassVar

from doe_kc.axle.model import Axle, both
from doe_kc.effects._base import Effect, Option, Part, effect
from doe_kc.effects.hypothesis import Size


@effect
class SteerArmCompliance(Effect):
    """Steer-arm compliance."""

    id: ClassVar[str] = "steer_arm_compliance"
    part: ClassVar[Part] = "steer_arm"
    label: ClassVar[str] = "Steer-arm compliance"
    options: ClassVar[Mapping[str, Option]] = {
        "radius_mm": Option(14.0, "mm"),
    }

    physics: ClassVar[str] = (
        "The steer arm bends under the tie rod's force, so that the wheel steers with load."
    )
    mistaken_for: ClassVar[tuple[str, ...]] = ("tie_rod_compliance", "rack_mount_compliance", "scb.Tz")
    shown_by: ClassVar[str] = "a dial gauge between steer-arm end and knuckle under lateral force"
    sizes: ClassVar[tuple[Size, ...]] = (Size("radius_mm", 14.0, "mm", "compliance", power=4.0),)
    replaces: ClassVar[tuple[str, ...]] = ("steer_arm.radius",)

    def present(self, axle: Axle) -> bool:
        return axle.topology.steer_arm

    def extend(self, axle: Axle, options: Mapping[str, Any]) -> Axle:
        changed = axle.changed(both("steer_arm.radius", options["radius_mm"]))
        return replace(changed, topology=replace(axle.topology, steer_arm=True))
