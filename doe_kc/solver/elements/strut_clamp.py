"""Strut clamp: a damper tube on springs in the part that carries it."""

from __future__ import annotations

from dataclasses import replace

import casadi as ca

from doe_kc.axle.model import NM_PER_DEG
from doe_kc.solver import rotation
from doe_kc.solver.builder import LOAD_CASE, Body, Builder, body
from doe_kc.solver.elements._base import hardpoint
from doe_kc.solver.elements._stiffening import stiffened
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
    torque = _torque(phi, bending, torsion, axis)
    if b.topology.strut_stiffens:
        torque += _stiffening(b, name, phi, bending, torsion, axis, side)
    moment = rotation.spring_moment(turn, torque, kappa, slope)
    for i, freedom in enumerate(turns):
        b.resist(freedom.name, moment[i])
    return b.join(f"strut clamp {side}", part, carrier, turns)


def _torque(phi: ca.SX, bending: ca.SX, torsion: ca.SX, axis: ca.SX) -> ca.SX:
    return bending * phi + (torsion - bending) * ca.dot(axis, phi) * axis


def _stiffening(
    b: Builder, name: str, phi: ca.SX, bending: ca.SX, torsion: ca.SX, axis: ca.SX, side: str
) -> ca.SX:
    """Further torque (3,) beyond the turn at rest, phi0: K (phi - phi0) (f - 1) q / (1 + q).

    q = (phi - phi0) . K (phi - phi0) k / M0^2, k of bending: a function of the energy, so that the torque has
    a potential. The weight of the car bends the clamp at rest, where the stiffness is what the rig sees about
    it; the state is that turn.
    """
    rest = ca.SX.sym(f"{name} at rest", 3)
    on = b.control(LOAD_CASE)
    b.state(rest, on * rest + (1 - on) * phi)
    beyond = on * (phi - rest)
    torque = _torque(beyond, bending, torsion, axis)
    return stiffened(b, "strut", side, bending * ca.dot(beyond, torque)) * torque
