"""Rotation springs between knuckle and wheel at the wheel centre, about the knuckle's X and Z."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any, ClassVar

from doe_kc.axle.model import Axle, both
from doe_kc.effects._base import Effect, Option, Part, effect
from doe_kc.effects.hypothesis import Size


@effect
class HubCompliance(Effect):
    """Hub and wheel-bearing compliance."""

    id: ClassVar[str] = "hub_compliance"
    label: ClassVar[str] = "Hub and wheel-bearing compliance"
    part: ClassVar[Part] = "axle"
    table: ClassVar[str] = "hub"
    options: ClassVar[Mapping[str, Option]] = {
        "camber_Nm_deg": Option(6000.0, "Nm/deg"),
        "toe_Nm_deg": Option(9000.0, "Nm/deg"),
    }

    physics: ClassVar[str] = (
        "Wheel bearing and knuckle yield, so that the wheel tilts and turns against its carrier under load."
    )
    mistaken_for: ClassVar[tuple[str, ...]] = (
        *("strut_bending", "ball_joint_compliance", "ball_compliance", "upb.Fy"),
    )
    shown_by: ClassVar[str] = (
        "camber at the hub against a target on the knuckle under lateral force; a pure overturning moment"
    )
    sizes: ClassVar[tuple[Size, ...]] = (
        Size("camber_Nm_deg", 6000.0, "Nm/deg", "compliance"),
        Size("toe_Nm_deg", 9000.0, "Nm/deg", "compliance"),
    )

    def extend(self, axle: Axle, options: Mapping[str, Any]) -> Axle:
        changed = axle.changed(
            both("hub.camber", options["camber_Nm_deg"]) | both("hub.toe", options["toe_Nm_deg"])
        )
        return replace(changed, topology=replace(axle.topology, hub=True))
