"""Free bodies, and the springs between the parts of a sub-frame that gives way."""

from __future__ import annotations

import casadi as ca

from doe_kc.axle.model import NM_PER_DEG
from doe_kc.solver import rotation
from doe_kc.solver.builder import Body, Builder, body
from doe_kc.solver.freedoms import rotations, translations


def free_body(b: Builder, name: str, centre: ca.SX) -> Body:
    """Body with six freedoms, its origin at the design point `centre`."""
    moved, shifts = translations(name)
    turned, turns = rotations(name)
    return b.join(name, body(name, centre, centre + moved, turned), None, shifts + turns)


def flexible_joint(b: Builder, inner: Body, outer: Body, at: ca.SX) -> None:
    """Springs `subframe.k*`, `subframe.kr*` in the inner body's axes between two bodies at a design point."""
    k = b.constant(ca.vertcat(*[b.parameter(f"subframe.k{a}") for a in "xyz"]))
    kr = b.constant(ca.vertcat(*[b.parameter(f"subframe.kr{a}") for a in "xyz"]) * NM_PER_DEG)
    d = inner.axes.T @ (outer.point(at) - inner.point(at))
    gibbs = rotation.relative(inner.gibbs, outer.gibbs)
    kappa, slope = rotation.angle_ratio(ca.dot(gibbs, gibbs))
    force = inner.axes @ (k * d)
    moment = inner.axes @ rotation.spring_moment(gibbs, kr * (kappa * gibbs), kappa, slope)
    b.push(inner, force, outer.point(at))
    b.push(outer, -force, outer.point(at))
    b.turn(inner, moment)
    b.turn(outer, -moment)
