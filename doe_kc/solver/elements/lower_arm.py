"""Lower arm on its front and rear bushing, whose axes ride on the sub-frame."""

from __future__ import annotations

from typing import ClassVar

import casadi as ca

from doe_kc.curves import SIDES
from doe_kc.solver.builder import Builder, body
from doe_kc.solver.elements import bushing
from doe_kc.solver.elements._base import Element, Stage, element, hardpoint, reflection
from doe_kc.solver.freedoms import rotations, translations

ARM_AXES = ca.SX([[0, 1, 0], [-1, 0, 0], [0, 0, 1]])
"""Chassis axes turned -90 deg about Z, as columns: local x = -Y, local y = +X (thesis, section 3.3)."""


@element
class LowerArm(Element):
    """Body `arm.L`/`.R`, its origin in the lower ball joint."""

    id: ClassVar[str] = "lower_arm"
    stage: ClassVar[Stage] = "body"
    rank: ClassVar[int] = 20

    def assemble(self, b: Builder) -> None:
        for side in SIDES:
            ball = hardpoint(b, "LWB", side)
            name = f"lower arm {side}"
            moved, shifts = translations(name)
            turned, turns = rotations(name)
            arm = b.join(name, body(name, ball, ball + moved, turned), None, shifts + turns)
            b.bodies[f"arm.{side}"] = arm
            for point, mount in (("LLF", "llf"), ("LLR", "llr")):
                bushing.connect(
                    b,
                    mount,
                    side,
                    at=hardpoint(b, point, side),
                    axes=reflection(side) @ ARM_AXES,
                    inner=b.bodies[f"subframe.{side}"],
                    outer=arm,
                )
