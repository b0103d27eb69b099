"""Ball joint: a body on a ball that sits in another, rigidly or on a spring (see `_sprung`)."""

from __future__ import annotations

import casadi as ca

from doe_kc.solver import rotation
from doe_kc.solver.builder import Body, Builder, body
from doe_kc.solver.elements._cuts import ROTATION_AXES, side_axes, turn_pair
from doe_kc.solver.freedoms import rotations


def ball_body(b: Builder, name: str, carrier: Body, ball: ca.SX) -> Body:
    """Body that turns about the ball at the design point `ball` of its carrier, free of moments."""
    turned, turns = rotations(name)
    child = body(name, ball, carrier.point(ball), turned)
    return b.join(name, child, carrier, turns, carries_moment=False)


def turning_ball(b: Builder, interface: str, carrier: Body, child: Body, side: str) -> None:
    """Probes against a ball joint's rotations, in the carrier's axes."""
    if not b.topology.probes:
        return
    gibbs = rotation.relative(carrier.gibbs, child.gibbs)
    kappa, slope = rotation.angle_ratio(ca.dot(gibbs, gibbs))
    axes = side_axes(b, side)
    phi = axes.T @ (kappa * gibbs)
    pairs = [turn_pair(b, interface, dof, side, phi[i]) for i, dof in enumerate(ROTATION_AXES)]
    moment = carrier.axes @ rotation.spring_moment(gibbs, axes @ ca.vertcat(*pairs), kappa, slope)
    b.turn(carrier, moment)
    b.turn(child, -moment)
