"""Lower ball joint: the ball at LWB sits rigidly in the lower arm, or on a spring equal in all directions."""

from __future__ import annotations

from typing import ClassVar

from doe_kc.curves import SIDES
from doe_kc.solver.builder import Body, Builder
from doe_kc.solver.elements._base import Element, Stage, element, hardpoint
from doe_kc.solver.elements._cuts import SHIFTS, cut
from doe_kc.solver.elements._sprung import sprung_ball


@element
class BallJoint(Element):
    """Body `ball joint.L`/`.R`: carries the knuckle's ball; its force is k times its displacement."""

    id: ClassVar[str] = "ball_joint"
    stage: ClassVar[Stage] = "body"
    rank: ClassVar[int] = 25

    def assemble(self, b: Builder) -> None:
        for side in SIDES:
            arm = b.bodies[f"arm.{side}"]
            arm = cut(b, "ball joint|arm", side, arm, [("LWB", side)], dofs=SHIFTS)
            b.bodies[f"ball joint.{side}"] = _sprung_ball(b, arm, side) if b.topology.ball_joint else arm


def _sprung_ball(b: Builder, arm: Body, side: str) -> Body:
    """Massless body at LWB, displaced in the arm's axes."""
    rate = b.constant(b.parameter(f"ball_joint.rate@{side}"))
    ball = hardpoint(b, "LWB", side)
    return sprung_ball(b, f"ball joint {side}", arm, ball, lambda deflection: rate * deflection)
