"""Sub-frame on four bushings: one rigid body, or two halves sprung to a centre part that carries the rack."""

from __future__ import annotations

from typing import ClassVar

import casadi as ca

from doe_kc.axle.model import NM_PER_DEG
from doe_kc.curves import SIDES
from doe_kc.solver import rotation
from doe_kc.solver.builder import Body, Builder, body
from doe_kc.solver.elements import bushing
from doe_kc.solver.elements._base import Element, Stage, element, hardpoint, reflection
from doe_kc.solver.elements._cuts import cut
from doe_kc.solver.freedoms import rotations, translations

MOUNTS = [(name, side) for name in ("SFF", "SFR") for side in SIDES]


def _mount_centre(b: Builder) -> ca.SX:
    points = [hardpoint(b, name, side) for name, side in MOUNTS]
    return b.constant((points[0] + points[1] + points[2] + points[3]) / 4)


def free_body(b: Builder, name: str, centre: ca.SX) -> Body:
    """Body with six freedoms, its origin at the design point `centre`."""
    moved, shifts = translations(name)
    turned, turns = rotations(name)
    return b.join(name, body(name, centre, centre + moved, turned), None, shifts + turns)


@element
class Subframe(Element):
    """Bodies `subframe.centre` (carries rack and column) and `subframe.L`/`.R` (carry the arms)."""

    id: ClassVar[str] = "subframe"
    stage: ClassVar[Stage] = "body"
    rank: ClassVar[int] = 10

    def assemble(self, b: Builder) -> None:
        centre = _mount_centre(b)
        b.bodies["subframe.centre"] = free_body(b, "sub-frame", centre)
        for side in SIDES:
            if b.topology.flexible_subframe:
                half = free_body(b, f"sub-frame half {side}", centre)
                flexible_joint(b, b.bodies["subframe.centre"], half, centre)
            else:
                half = b.bodies["subframe.centre"]
            b.bodies[f"subframe.{side}"] = cut(b, "sub-frame half|centre", side, half, MOUNTS)
            for point, mount in (("SFF", "sff"), ("SFR", "sfr")):
                bushing.connect(
                    b,
                    mount,
                    side,
                    at=hardpoint(b, point, side),
                    axes=reflection(side),
                    inner=None,
                    outer=b.bodies[f"subframe.{side}"],
                )


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
