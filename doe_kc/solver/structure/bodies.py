"""The bodies of a structure, placed one after the other along its tree of joints."""

from __future__ import annotations

import casadi as ca

from doe_kc.axle.structure import (
    CHASSIS,
    BallConnection,
    LineConnection,
    SplitBody,
    SteerArmBeam,
    Structure,
    StrutClamp,
    of_side,
)
from doe_kc.curves import SIDES
from doe_kc.solver import rotation
from doe_kc.solver.builder import Body, Builder, body
from doe_kc.solver.elements._base import hardpoint
from doe_kc.solver.elements._cuts import SHIFTS, cut, push_pair, turn_pair
from doe_kc.solver.elements._sprung import sprung_ball
from doe_kc.solver.elements.ball_joint import ball_body, turning_ball
from doe_kc.solver.elements.steer_arm import beam_end
from doe_kc.solver.elements.steering import add_rack
from doe_kc.solver.elements.strut_clamp import clamped_part
from doe_kc.solver.elements.subframe import flexible_joint, free_body
from doe_kc.solver.freedoms import slide, twist
from doe_kc.solver.structure.line import line_axes, line_direction
from doe_kc.solver.structure.tree import Branch, JointTree, SideJoint
from doe_kc.solver.structure.words import in_words, joint_words, part_words


def add_bodies(b: Builder, tree: JointTree) -> None:
    """Every body of the tree in `b.bodies`, the chassis too."""
    structure, zero = b.topology.structure, ca.SX.zeros(3)
    b.bodies[CHASSIS] = Body(CHASSIS, zero, zero, zero, ca.SX.eye(3))
    for branch in tree.branches:
        b.bodies[branch.body] = _placed(b, structure, branch)
    if structure.subframe is not None and b.topology.flexible_subframe:
        _spring_halves(b, structure.subframe)


def _spring_halves(b: Builder, split: SplitBody) -> None:
    for side in SIDES:
        half = b.bodies[f"{split.body}.{side}"]
        flexible_joint(b, b.bodies[split.body], half, half.design)
        b.bodies[f"{split.body}.{side}"] = _cut_half(b, split, side, half)


def _cut_half(b: Builder, split: SplitBody, side: str, half: Body) -> Body:
    middle = [(name, each) for name in split.centre for each in SIDES]
    return cut(b, f"{in_words(split.body)} half|centre", side, half, middle)


def _placed(b: Builder, structure: Structure, branch: Branch) -> Body:
    words, joint = part_words(structure, branch.body), branch.joint
    if joint is None:
        return free_body(b, words, _reference_point(b, structure, branch.body))
    parent = b.bodies[branch.parent]
    if isinstance(joint.connection, SplitBody):
        return _cut_half(b, joint.connection, joint.side, parent)
    if isinstance(joint.connection, StrutClamp):
        return _in_clamp(b, words, parent, joint.connection, joint)
    if isinstance(joint.connection, SteerArmBeam):
        return _on_beam(b, words, parent, joint.connection, joint)
    if isinstance(joint.connection, BallConnection):
        return _on_ball(b, words, branch, joint.connection, joint)
    if isinstance(joint.connection, LineConnection):
        return _on_cylinder(b, words, branch, joint.connection, joint)
    assert structure.rack is not None
    return add_rack(b, parent, structure.rack.at, in_words(structure.rack.carrier))


def _reference_point(b: Builder, structure: Structure, part: str) -> ca.SX:
    """Origin of a free body: the first ball joint or bushing on it, of a single one the mean of the sides; of
    one that may be split the middle of its joints."""
    name, _, side = part.partition(".")
    if structure.subframe is not None and name == structure.subframe.body:
        points = [hardpoint(b, at, s) for at in structure.subframe.centre for s in SIDES]
        return b.constant(sum(points[1:], points[0]) / len(points))
    places = [
        *((ball.at, ball.single) for ball in structure.balls if name in (ball.a, ball.b)),
        *((bush.at, bush.single) for bush in structure.bushings if name in (bush.inner, bush.outer)),
        *((line.at_a, line.single) for line in structure.cylindricals if name in (line.a, line.b)),
    ]
    at, single = places[0]
    if single:
        return hardpoint(b, at, "")
    if side:
        return hardpoint(b, at, side)
    return b.constant((hardpoint(b, at, "L") + hardpoint(b, at, "R")) / 2)


def _in_clamp(b: Builder, words: str, parent: Body, clamp: StrutClamp, joint: SideJoint) -> Body:
    def axes(builder: Builder, side: str) -> ca.SX:
        return line_axes(builder, *clamp.line, side)

    names = f"{in_words(clamp.body)}|{in_words(clamp.carrier)}"
    parent = cut(b, names, joint.side, parent, [(clamp.at, joint.side)], axes)
    if joint.type == "weld":
        return parent
    axis = line_direction(b, *clamp.line, joint.side)
    return clamped_part(b, words, parent, clamp.at, axis, joint.side)


def _on_beam(b: Builder, words: str, parent: Body, beam: SteerArmBeam, joint: SideJoint) -> Body:
    names = f"{in_words(beam.body)}|{in_words(beam.carrier)}"
    parent = cut(b, names, joint.side, parent, [(beam.at, joint.side)], dofs=SHIFTS)
    if joint.type == "weld":
        return parent
    return beam_end(b, words, parent, beam.root, beam.at, joint.side)


def _on_ball(b: Builder, words: str, branch: Branch, ball: BallConnection, joint: SideJoint) -> Body:
    """The child turns about the ball, which sits in its parent, rigidly or on a spring."""
    carrier = ball_cut(b, ball, joint.side, branch.parent)
    at, label = hardpoint(b, ball.at, joint.side), joint_words(ball.name, joint.side)
    if joint.type == "sprung ball":
        rate = b.constant(b.parameter(of_side(f"{ball.name}.rate", joint.side)))
        carrier = sprung_ball(b, label, carrier, at, lambda deflection: rate * deflection)
    child = ball_body(b, words, carrier, at)
    turning_ball(b, in_words(ball.name), carrier, child, joint.side)
    return child


def ball_cut(b: Builder, ball: BallConnection, side: str, part: str) -> Body:
    """The part that a ball sits in, or with probes a body that they dislocate from it."""
    seat = ball.seat or in_words(part.partition(".")[0])
    return cut(b, f"{in_words(ball.name)}|{seat}", side, b.bodies[part], [(ball.at, side)], dofs=SHIFTS)


def _on_cylinder(b: Builder, words: str, branch: Branch, line: LineConnection, joint: SideJoint) -> Body:
    """The child slides along and turns about the line, its origin in the line's end on it.

    Point `slide NAME.SIDE`: lengthening of the line from design, mm.
    """
    side, names = joint.side, line_interface(line)
    first = branch.parent == joint.a
    end, parent = hardpoint(b, line.at_b, side), line_cut(b, line, side, branch.parent)
    axis = line_direction(b, line.at_a, line.at_b, side) * (1 if first else -1)
    along, label = parent.axes @ axis, joint_words(f"{line.name} slide", side)
    turning = joint_words(f"{line.name} twist", side)
    slid, slides = slide(label, along)
    turned, twists = twist(turning, along)
    origin = parent.point(end) + along * slid
    child = body(words, end, origin, rotation.compose(parent.gibbs, axis * turned))
    b.join(joint_words(line.name, side), child, parent, slides + twists)
    b.points[f"slide {line.name}.{side}"] = slid
    b.resist(label, push_pair(b, names, "z", side, slid))
    b.resist(turning, turn_pair(b, names, "rz", side, 2 * ca.atan(turned)))
    return child


def line_interface(line: LineConnection) -> str:
    """What probes call a cylindrical joint: `rod|tube`."""
    return f"{in_words(line.b)}|{in_words(line.a)}"


def line_cut(b: Builder, line: LineConnection, side: str, part: str) -> Body:
    """The part that carries a cylindrical joint's line, or with probes a body that they dislocate from it."""
    middle = [(line.at_a, side), (line.at_b, side)]

    def axes(builder: Builder, of: str) -> ca.SX:
        return line_axes(builder, line.at_a, line.at_b, of)

    return cut(b, line_interface(line), side, b.bodies[part], middle, axes, ("x", "y", "rx", "ry"))
