"""Knuckle on the lower ball joint; the damper tube is part of it, or sprung to it at the strut clamp."""

from __future__ import annotations

from typing import ClassVar

import casadi as ca

from doe_kc.solver import rotation
from doe_kc.solver.builder import Body, Builder, body, rotations
from doe_kc.solver.elements._base import NM_PER_DEG, SIDES, Element, Stage, element, hardpoint

NEARLY_RIGID = 1e-4
"""Flexibility in place of 0, for the rigid side of an axle whose other strut bends."""


@element
class Knuckle(Element):
    """Bodies `knuckle.L`/`.R` and `tube.L`/`.R`."""

    id: ClassVar[str] = "knuckle"
    stage: ClassVar[Stage] = "body"
    rank: ClassVar[int] = 30

    def assemble(self, b: Builder) -> None:
        for side in SIDES:
            ball = hardpoint(b, "LWB", side)
            name = f"knuckle {side}"
            arm = b.bodies[f"arm.{side}"]
            turned, turns = rotations(name)
            knuckle = body(name, ball, arm.origin, turned)
            b.bodies[f"knuckle.{side}"] = b.join(name, knuckle, arm, turns, carries_moment=False)
            bends = b.topology.strut_bending
            b.bodies[f"tube.{side}"] = _bending_tube(b, knuckle, side) if bends else knuckle


def strut_axis(b: Builder, side: str) -> ca.SX:
    """Unit vector LWD -> UPB at design."""
    key = f"strut axis@{side}"
    if key not in b.points:
        along = hardpoint(b, "UPB", side) - hardpoint(b, "LWD", side)
        b.points[key] = b.constant(along / ca.norm_2(along))
    return b.points[key]


def _bending_tube(b: Builder, knuckle: Body, side: str) -> Body:
    """Tube turning about the clamp: bending about both transverse axes, torsion about the damper axis."""
    clamp = hardpoint(b, "CLAMP", side)
    name = f"tube {side}"
    turn, turns = rotations(name, knuckle.axes)
    tube = body(name, clamp, knuckle.point(clamp), rotation.compose(knuckle.gibbs, turn))
    flexibility = b.parameter(f"strut.flexibility@{side}")
    softness = ca.if_else(flexibility > 0, flexibility, flexibility + NEARLY_RIGID) / NM_PER_DEG
    bending = b.constant(b.parameter(f"strut.bending@{side}") / softness)
    torsion = b.constant(b.parameter(f"strut.torsion@{side}") / softness)
    kappa, slope = rotation.angle_ratio(ca.dot(turn, turn))
    axis, phi = strut_axis(b, side), kappa * turn
    torque = bending * phi + (torsion - bending) * ca.dot(axis, phi) * axis
    moment = rotation.spring_moment(turn, torque, kappa, slope)
    for i, freedom in enumerate(turns):
        b.resist(freedom.name, moment[i])
    return b.join(f"strut clamp {side}", tube, knuckle, turns)
