"""The lower ball joint sits in the arm on a spring that is equal in all directions."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any, ClassVar

from doe_kc.axle.model import Axle, both
from doe_kc.effects._base import Effect, Option, effect
from doe_kc.effects.hypothesis import Size


@effect
class BallJointCompliance(Effect):
    """Lower-ball-joint compliance."""

    id: ClassVar[str] = "ball_joint_compliance"
    label: ClassVar[str] = "Lower-ball-joint compliance"
    options: ClassVar[Mapping[str, Option]] = {"k_N_mm": Option(12000.0, "N/mm")}

    physics: ClassVar[str] = (
        "The lower ball joint and the arm's end yield, so that the foot of the kingpin axis moves under load."
    )
    mistaken_for: ClassVar[tuple[str, ...]] = ("hub_compliance", "llf.Fx", "llr.Fx", "subframe_flexibility")
    shown_by: ClassVar[str] = "a dial gauge between knuckle and lower arm at the ball under lateral force"
    sizes: ClassVar[tuple[Size, ...]] = (Size("k_N_mm", 12000.0, "N/mm", "compliance"),)

    def extend(self, axle: Axle, options: Mapping[str, Any]) -> Axle:
        changed = axle.changed(both("ball_joint.rate", options["k_N_mm"]))
        return replace(changed, topology=replace(axle.topology, ball_joint=True))
