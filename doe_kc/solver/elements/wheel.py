"""Wheel on its carrier: rigid, or sprung at the wheel centre (hub and bearing compliance)."""

from __future__ import annotations

import casadi as ca

from doe_kc.axle.model import NM_PER_DEG
from doe_kc.solver import rotation
from doe_kc.solver.builder import Body, Builder, body
from doe_kc.solver.elements._base import hardpoint, mirror
from doe_kc.solver.elements._cuts import cut
from doe_kc.solver.elements._stiffening import stiffened
from doe_kc.solver.freedoms import rotations

SPIN_STIFFNESS = 1e11
"""N mm/rad about the carrier's Y: the reference's brake lock, stiff but not ideal."""


def add_wheel(b: Builder, carrier: Body, side: str, carrier_noun: str) -> None:
    """Body `wheel.SIDE`, points `wheel centre.SIDE` and `spin.SIDE`, the outward spin axis (chassis frame).

    carrier_noun: what probes call the carrier.
    """
    carrier = cut(b, f"wheel|{carrier_noun}", side, carrier, [("WLC", side)])
    wheel = _sprung_wheel(b, carrier, side) if b.topology.hub else carrier
    b.bodies[f"wheel.{side}"] = wheel
    b.points[f"wheel centre.{side}"] = wheel.point(hardpoint(b, "WLC", side))
    b.points[f"spin.{side}"] = wheel.axes @ _design_spin_axis(b, side)


def _design_spin_axis(b: Builder, side: str) -> ca.SX:
    toe = b.parameter(f"static.toe@{side}") * ca.pi / 180
    camber = b.parameter(f"static.camber@{side}") * ca.pi / 180
    return b.constant(
        ca.vertcat(
            -ca.sin(toe) * ca.cos(camber),
            -mirror(side) * ca.cos(toe) * ca.cos(camber),
            -ca.sin(camber),
        )
    )


def _sprung_wheel(b: Builder, carrier: Body, side: str) -> Body:
    centre = hardpoint(b, "WLC", side)
    name = f"wheel {side}"
    turn, turns = rotations(name, carrier.axes)
    wheel = body(name, centre, carrier.point(centre), rotation.compose(carrier.gibbs, turn))
    camber = b.constant(b.parameter(f"hub.camber@{side}") * NM_PER_DEG)
    toe = b.constant(b.parameter(f"hub.toe@{side}") * NM_PER_DEG)
    kappa, slope = rotation.angle_ratio(ca.dot(turn, turn))
    torque = ca.vertcat(camber, SPIN_STIFFNESS, toe) * (kappa * turn)
    if b.topology.hub_stiffens:
        camber, toe = (stiffened(b, "hub", side, torque[i] ** 2) for i in (0, 2))
        torque *= 1 + ca.vertcat(camber, 0, toe)
    moment = rotation.spring_moment(turn, torque, kappa, slope)
    for i, freedom in enumerate(turns):
        b.resist(freedom.name, moment[i])
    return b.join(f"hub {side}", wheel, carrier, turns)
