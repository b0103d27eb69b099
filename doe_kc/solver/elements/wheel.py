"""Wheel on its carrier: rigid, or sprung at the wheel centre (hub and bearing compliance)."""

from __future__ import annotations

import casadi as ca

from doe_kc.axle.model import NM_PER_DEG
from doe_kc.solver import rotation
from doe_kc.solver.builder import Body, Builder, body
from doe_kc.solver.elements._base import hardpoint, mirror
from doe_kc.solver.elements._cuts import cut
from doe_kc.solver.freedoms import rotations

SPIN_STIFFNESS = 1e11
"""N mm/rad about the carrier's Y: the reference's brake lock, stiff but not ideal."""
NMM_PER_NM = 1000.0


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
        torque *= ca.vertcat(_stiffer(b, side, torque[0]), 1, _stiffer(b, side, torque[2]))
    moment = rotation.spring_moment(turn, torque, kappa, slope)
    for i, freedom in enumerate(turns):
        b.resist(freedom.name, moment[i])
    return b.join(f"hub {side}", wheel, carrier, turns)


def _stiffer(b: Builder, side: str, moment: ca.SX) -> ca.SX:
    """Stiffness under a moment over that at rest: 1 + (f - 1) q / (1 + q), q = (moment / M0)^2. moment: its
    linear part."""
    square = (moment / b.constant(b.parameter(f"hub.reference@{side}") * NMM_PER_NM)) ** 2
    return 1 + b.constant(b.parameter(f"hub.loaded_factor@{side}") - 1) * square / (1 + square)
