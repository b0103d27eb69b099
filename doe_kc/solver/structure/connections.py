"""Bushings, rods, ball joints that give way, and joints that close a loop."""

from __future__ import annotations

from collections.abc import Callable

import casadi as ca

from doe_kc.axle.structure import (
    CHASSIS,
    BallConnection,
    BushingConnection,
    LineConnection,
    Structure,
    of_side,
)
from doe_kc.solver.builder import Builder
from doe_kc.solver.elements import bushing
from doe_kc.solver.elements._base import hardpoint, reflection
from doe_kc.solver.elements.ball_joint import turning_ball
from doe_kc.solver.elements.tie_rod import CENTRING_STIFFNESS, SMOOTHING, add_rod
from doe_kc.solver.structure.bodies import ball_cut, line_cut
from doe_kc.solver.structure.line import line_axes
from doe_kc.solver.structure.tree import SideJoint
from doe_kc.solver.structure.words import in_words, joint_words

BallForce = Callable[[Builder, BallConnection, str, ca.SX], ca.SX]
"""Force (3,) in N that draws the points of a ball joint together, of their distance (3,) in mm."""


def add_bushings(b: Builder, structure: Structure) -> None:
    """Every bushing on both sides."""
    for bush in structure.bushings:
        for side in structure.sides(single=bush.single):
            inner = structure.part_on_side(bush.inner, side)
            bushing.connect(
                b,
                bush.name,
                side,
                at=hardpoint(b, bush.at, side),
                axes=_axes(b, bush, side),
                inner=None if inner == CHASSIS else b.bodies[inner],
                outer=b.bodies[structure.part_on_side(bush.outer, side)],
            )


def _axes(b: Builder, bush: BushingConnection, side: str) -> ca.SX:
    """(3, 3) local axes as columns: those of the type, or z along a line, mirrored on the right."""
    if bush.line is not None:
        return b.constant(line_axes(b, *bush.line, side))
    return reflection(side) @ ca.SX(ca.DM(bush.axes))


def add_rods(b: Builder, structure: Structure) -> None:
    """Every rod on both sides; free play is in those that the rack steers by."""
    steered = structure.rack.rods if structure.rack is not None else ()
    for rod in structure.rods:
        for side in structure.sides(single=rod.single):
            first, second = (b.bodies[structure.part_on_side(body, side)] for body in (rod.a, rod.b))
            plays = b.topology.free_play_right if side == "R" else b.topology.free_play_left
            ends = (first, rod.at_a), (second, rod.at_b)
            add_rod(b, rod.name, side, *ends, plays=plays and rod.name in steered)


def add_playing_balls(b: Builder, structure: Structure) -> None:
    """Ball joints with free play."""
    for ball in structure.balls:
        for side in structure.sides(single=ball.single):
            if of_side(ball.name, side) in b.topology.play_balls:
                _between(b, ball, side, _play)


def _between(b: Builder, ball: BallConnection, side: str, law: BallForce) -> None:
    """The force of a law between the points of both bodies that a ball joint joins."""
    structure, at = b.topology.structure, hardpoint(b, ball.at, side)
    first = ball_cut(b, ball, side, structure.part_on_side(ball.a, side))
    second = b.bodies[structure.part_on_side(ball.b, side)]
    force = law(b, ball, side, second.point(at) - first.point(at))
    b.push(first, force, second.point(at))
    b.push(second, -force, second.point(at))
    turning_ball(b, in_words(ball.name), first, second, side)


def _spring(b: Builder, ball: BallConnection, side: str, apart: ca.SX) -> ca.SX:
    return b.constant(b.parameter(of_side(f"{ball.name}.rate", side))) * apart


def _play(b: Builder, ball: BallConnection, side: str, apart: ca.SX) -> ca.SX:
    """Force along the line between the points, k0 r + k1 (s(r - gap/2) - s(-r - gap/2)), as in a rod.

    The law is odd in r, so that its quotient with r is smooth at 0.
    """
    gap, contact = (
        b.constant(b.parameter(of_side(f"{ball.name}.{key}", side))) for key in ("gap", "contact")
    )
    radius = ca.sqrt(ca.dot(apart, apart) + TINY**2)
    smoothing = SMOOTHING / contact

    def ramp(x: ca.SX) -> ca.SX:
        return (x + ca.sqrt(x**2 + smoothing**2)) / 2

    size = CENTRING_STIFFNESS * radius + contact * (ramp(radius - gap / 2) - ramp(-radius - gap / 2))
    return size / radius * apart


TINY = 1e-9
"""mm; keeps the direction of no distance defined."""


def close_loops(b: Builder, loops: tuple[SideJoint, ...]) -> None:
    """Forces of the joints that no body hangs by."""
    for joint in loops:
        if isinstance(joint.connection, BallConnection):
            law = _spring if joint.type == "sprung ball" else _rigid
            _between(b, joint.connection, joint.side, law)
        elif isinstance(joint.connection, LineConnection):
            _close_cylinder(b, joint, joint.connection)


def _rigid(b: Builder, ball: BallConnection, side: str, apart: ca.SX) -> ca.SX:
    """The points of both bodies coincide: three forces."""
    label = joint_words(ball.name, side)
    return ca.vertcat(
        *(b.rigid(f"{label}.{axis}", f"{label} (ball joint)", apart[i]) for i, axis in enumerate("xyz"))
    )


def _close_cylinder(b: Builder, joint: SideJoint, line: LineConnection) -> None:
    """Both ends of the second body's line lie on the first body's: two transverse forces at either."""
    first, second = line_cut(b, line, joint.side, joint.a), b.bodies[joint.b]
    start, end = hardpoint(b, line.at_a, joint.side), hardpoint(b, line.at_b, joint.side)
    axes = first.axes @ b.constant(line_axes(b, line.at_a, line.at_b, joint.side)[:, :2])
    label = joint_words(joint.name, joint.side)
    for name, at in ((line.at_a, start), (line.at_b, end)):
        apart = second.point(at) - first.point(start)
        for i, axis in enumerate("xy"):
            across = axes[:, i]
            violation = ca.dot(across, apart)
            force = b.rigid(f"{label}.{name}.{axis}", f"{label} (cylindrical joint)", violation) * across
            b.push(second, -force, second.point(at))
            b.push(first, force, second.point(at))
