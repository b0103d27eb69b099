"""Steer arm as a round steel beam from SAH to ROB; its stiffness follows the outer radius."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any, ClassVar

from doe_kc.axle.model import Axle, both
from doe_kc.effects._base import Effect, Option, effect


@effect
class SteerArmCompliance(Effect):
    """Steer-arm compliance."""

    id: ClassVar[str] = "steer_arm_compliance"
    label: ClassVar[str] = "Steer-arm compliance"
    options: ClassVar[Mapping[str, Option]] = {
        "radius_mm": Option(14.0, "mm"),
    }

    def extend(self, axle: Axle, options: Mapping[str, Any]) -> Axle:
        changed = axle.changed(both("steer_arm.radius", options["radius_mm"]))
        return replace(changed, topology=replace(axle.topology, steer_arm=True))
