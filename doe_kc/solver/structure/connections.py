"""Bushings, rods, ball joints that give way, and joints that close a loop."""

from __future__ import annotations

import casadi as ca

from doe_kc.axle.structure import CHASSIS, BallConnection, LineConnection, Structure, of_side
from doe_kc.solver import rotation
from doe_kc.solver.builder import Body, Builder
from doe_kc.solver.elements import bushing
from doe_kc.solver.elements._base import hardpoint, reflection
from doe_kc.solver.elements.tie_rod import CENTRING_STIFFNESS, SMOOTHING, add_rod
from doe_kc.solver.structure.bodies import side_word
from doe_kc.solver.structure.tree import SideJoint, instance

AXES = [f"{row}{column}" for row in "xyz" for column in "123"]
"""Places of a bushing's axes among the axle's values: chassis component, then local axis."""


def add_bushings(b: Builder, structure: Structure, split: str) -> None:
    """Every bushing on both sides."""
    for bush in structure.bushings:
        for side in structure.sides(single=bush.single):
            inner = instance(structure, bush.inner, side, split)
            bushing.connect(
                b,
                bush.name,
                side,
                at=hardpoint(b, bush.at, side),
                axes=_axes(b, bush.name, bush.line, side),
                inner=None if inner == CHASSIS else b.bodies[inner],
                outer=b.bodies[instance(structure, bush.outer, side, split)],
            )


def _axes(b: Builder, name: str, line: tuple[str, str] | None, side: str) -> ca.SX:
    """(3, 3) local axes as columns: numbers of the axle, or z along a line, the rest by the shortest turn."""
    mirrored = reflection(side)
    if line is None:
        rows = [b.parameter(f"{name}.axes.{place}") for place in AXES]
        return b.constant(mirrored @ ca.reshape(ca.vertcat(*rows), 3, 3).T)
    along = mirrored @ (hardpoint(b, line[1], side) - hardpoint(b, line[0], side))
    return b.constant(mirrored @ rotation.minimal_rotation_from_z(along / ca.norm_2(along)))


def add_rods(b: Builder, structure: Structure, split: str) -> None:
    """Every rod on both sides; free play is in those that the rack steers by."""
    steered = structure.rack.rods if structure.rack is not None else ()
    for rod in structure.rods:
        for side in structure.sides(single=rod.single):
            first, second = (b.bodies[instance(structure, body, side, split)] for body in (rod.a, rod.b))
            plays = b.topology.free_play_right if side == "R" else b.topology.free_play_left
            ends = (first, rod.at_a), (second, rod.at_b)
            add_rod(b, rod.name, side, *ends, plays=plays and rod.name in steered)


def add_yielding_balls(b: Builder, structure: Structure, split: str) -> None:
    """Ball joints that are springs, or have free play."""
    for ball in structure.balls:
        for side in structure.sides(single=ball.single):
            name = of_side(ball.name, side)
            if name not in (*b.topology.elastic_balls, *b.topology.play_balls):
                continue
            first, second = (b.bodies[instance(structure, body, side, split)] for body in (ball.a, ball.b))
            at = hardpoint(b, ball.at, side)
            apart = second.point(at) - first.point(at)
            law = _spring if name in b.topology.elastic_balls else _play
            force = law(b, ball, side, apart)
            b.push(first, force, second.point(at))
            b.push(second, -force, second.point(at))


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
    """Constraint forces of the joints that no body hangs by."""
    for joint in loops:
        first, second = b.bodies[joint.a], b.bodies[joint.b]
        if isinstance(joint.connection, BallConnection):
            _close_ball(b, joint, first, second, hardpoint(b, joint.connection.at, joint.side))
        elif isinstance(joint.connection, LineConnection):
            _close_cylinder(b, joint, joint.connection, first, second)


def _close_ball(b: Builder, joint: SideJoint, first: Body, second: Body, at: ca.SX) -> None:
    """The points of both bodies coincide: three forces."""
    apart = second.point(at) - first.point(at)
    label = side_word(joint.name, joint.side)
    force = ca.vertcat(
        *(b.rigid(f"{label}.{axis}", f"{label} (ball joint)", apart[i]) for i, axis in enumerate("xyz"))
    )
    b.push(second, -force, second.point(at))
    b.push(first, force, second.point(at))


def _close_cylinder(b: Builder, joint: SideJoint, line: LineConnection, first: Body, second: Body) -> None:
    """Both ends of the second body's line lie on the first body's: two transverse forces at either."""
    start, end = hardpoint(b, line.at_a, joint.side), hardpoint(b, line.at_b, joint.side)
    mirrored = reflection(joint.side)
    along = mirrored @ (end - start)
    turn = rotation.minimal_rotation_from_z(along / ca.norm_2(along))
    axes = first.axes @ b.constant(mirrored @ turn[:, :2])
    label = side_word(joint.name, joint.side)
    for name, at in ((line.at_a, start), (line.at_b, end)):
        apart = second.point(at) - first.point(start)
        for i, axis in enumerate("xy"):
            across = axes[:, i]
            violation = ca.dot(across, apart)
            force = b.rigid(f"{label}.{name}.{axis}", f"{label} (cylindrical joint)", violation) * across
            b.push(second, -force, second.point(at))
            b.push(first, force, second.point(at))
