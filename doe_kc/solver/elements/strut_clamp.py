"""Strut clamp: a damper tube on springs in the part that carries it."""

from __future__ import annotations

from dataclasses import replace

import casadi as ca

from doe_kc.axle.model import NM_PER_DEG
from doe_kc.solver import rotation
from doe_kc.solver.builder import Body, Builder, body
from doe_kc.solver.elements._base import hardpoint
from doe_kc.solver.freedoms import rotations


def clamped_part(b: Builder, name: str, carrier: Body, at: str, axis: ca.SX, side: str) -> Body:
    """Part that turns about the hardpoint `at`: bending about both axes across `axis` (3,), torsion about it.

    The flexibility multiplies the moment instead of dividing the stiffness, so that 0 is a rigid clamp.
    """
    clamp = hardpoint(b, at, side)
    turn, turns = rotations(name, carrier.axes)
    part = body(name, clamp, carrier.point(clamp), rotation.compose(carrier.gibbs, turn))
    flexibility = b.constant(b.parameter(f"strut.flexibility@{side}"))
    turns = [replace(freedom, compliance=flexibility) for freedom in turns]
    bending = b.constant(b.parameter(f"strut.bending@{side}") * NM_PER_DEG)
    torsion = b.constant(b.parameter(f"strut.torsion@{side}") * NM_PER_DEG)
    kappa, slope = rotation.angle_ratio(ca.dot(turn, turn))
    phi = kappa * turn
    torque = bending * phi + (torsion - bending) * ca.dot(axis, phi) * axis
    moment = rotation.spring_moment(turn, torque, kappa, slope)
    for i, freedom in enumerate(turns):
        b.resist(freedom.name, moment[i])
    return b.join(f"strut clamp {side}", part, carrier, turns)
