"""Knuckle on the lower ball joint; the damper tube is part of it, or sprung to it at the strut clamp."""

from __future__ import annotations

from dataclasses import replace
from typing import ClassVar

import casadi as ca

from doe_kc.axle.model import NM_PER_DEG
from doe_kc.curves import SIDES
from doe_kc.solver import rotation
from doe_kc.solver.builder import Body, Builder, body
from doe_kc.solver.elements._base import Element, Stage, element, hardpoint, reflection
from doe_kc.solver.elements._cuts import ROTATION_AXES, cut, side_axes, turn_pair
from doe_kc.solver.freedoms import rotations


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
            carrier = b.bodies[f"ball joint.{side}"]
            turned, turns = rotations(name)
            knuckle = body(name, ball, carrier.origin, turned)
            b.bodies[f"carrier.{side}"] = b.bodies[f"knuckle.{side}"] = b.join(
                name, knuckle, carrier, turns, carries_moment=False
            )
            _turning_ball(b, carrier, knuckle, side)
            clamp = cut(b, "tube|knuckle", side, knuckle, [("CLAMP", side)], strut_axes)
            bends = b.topology.strut_bending
            b.bodies[f"tube.{side}"] = _bending_tube(b, clamp, side) if bends else clamp


def strut_axis(b: Builder, side: str) -> ca.SX:
    """Unit vector LWD -> UPB at design."""
    key = f"strut axis@{side}"
    if key not in b.points:
        along = hardpoint(b, "UPB", side) - hardpoint(b, "LWD", side)
        b.points[key] = b.constant(along / ca.norm_2(along))
    return b.points[key]


def strut_axes(b: Builder, side: str) -> ca.SX:
    """(3, 3) axes as columns: z along the strut axis, x and y by the shortest turn from the chassis."""
    mirrored = reflection(side)
    return mirrored @ rotation.minimal_rotation_from_z(mirrored @ strut_axis(b, side))


def _turning_ball(b: Builder, carrier: Body, knuckle: Body, side: str) -> None:
    """Probes against the ball joint's rotations, in the arm's axes."""
    if not b.topology.probes:
        return
    gibbs = rotation.relative(carrier.gibbs, knuckle.gibbs)
    kappa, slope = rotation.angle_ratio(ca.dot(gibbs, gibbs))
    axes = side_axes(b, side)
    phi = axes.T @ (kappa * gibbs)
    pairs = [turn_pair(b, "ball joint", dof, side, phi[i]) for i, dof in enumerate(ROTATION_AXES)]
    moment = carrier.axes @ rotation.spring_moment(gibbs, axes @ ca.vertcat(*pairs), kappa, slope)
    b.turn(carrier, moment)
    b.turn(knuckle, -moment)


def _bending_tube(b: Builder, knuckle: Body, side: str) -> Body:
    """Tube turning about the clamp: bending about both transverse axes, torsion about the damper axis.

    The flexibility multiplies the moment instead of dividing the stiffness, so that 0 is a rigid clamp.
    """
    clamp = hardpoint(b, "CLAMP", side)
    name = f"tube {side}"
    turn, turns = rotations(name, knuckle.axes)
    tube = body(name, clamp, knuckle.point(clamp), rotation.compose(knuckle.gibbs, turn))
    flexibility = b.constant(b.parameter(f"strut.flexibility@{side}"))
    turns = [replace(freedom, compliance=flexibility) for freedom in turns]
    bending = b.constant(b.parameter(f"strut.bending@{side}") * NM_PER_DEG)
    torsion = b.constant(b.parameter(f"strut.torsion@{side}") * NM_PER_DEG)
    kappa, slope = rotation.angle_ratio(ca.dot(turn, turn))
    axis, phi = strut_axis(b, side), kappa * turn
    torque = bending * phi + (torsion - bending) * ca.dot(axis, phi) * axis
    moment = rotation.spring_moment(turn, torque, kappa, slope)
    for i, freedom in enumerate(turns):
        b.resist(freedom.name, moment[i])
    return b.join(f"strut clamp {side}", tube, knuckle, turns)
