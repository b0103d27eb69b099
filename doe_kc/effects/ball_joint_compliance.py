"""The lower ball joint sits in the arm on a spring that is equal in all directions."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any, ClassVar

from doe_kc.axle.model import Axle, both
from doe_kc.axle.places import BALL_JOINT
from doe_kc.axle.structure import of_side
from doe_kc.curves import SIDES
from doe_kc.effects._base import Effect, Option, Part, effect
from doe_kc.effects.hypothesis import Size


@effect
class BallJointCompliance(Effect):
    """Lower-ball-joint compliance."""

    id: ClassVar[str] = "ball_joint_compliance"
    part: ClassVar[Part] = "ball_joint"
    label: ClassVar[str] = "Lower-ball-joint compliance"
    options: ClassVar[Mapping[str, Option]] = {"k_N_mm": Option(12000.0, "N/mm")}

    physics: ClassVar[str] = (
        "The lower ball joint and the arm's end yield, so that the foot of the kingpin axis moves under load."
    )
    mistaken_for: ClassVar[tuple[str, ...]] = ("hub_compliance", "llf.Fx", "llr.Fx", "subframe_flexibility")
    shown_by: ClassVar[str] = "a dial gauge between knuckle and lower arm at the ball under lateral force"
    sizes: ClassVar[tuple[Size, ...]] = (Size("k_N_mm", 12000.0, "N/mm", "compliance"),)

    def extend(self, axle: Axle, options: Mapping[str, Any]) -> Axle:
        changed = axle.changed(both(f"{BALL_JOINT}.rate", options["k_N_mm"]))
        own = {of_side(BALL_JOINT, side) for side in SIDES}
        there = tuple(sorted({*axle.topology.elastic_balls, *own}))
        return replace(changed, topology=replace(axle.topology, elastic_balls=there))
