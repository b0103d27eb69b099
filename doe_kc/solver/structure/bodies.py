"""The bodies of a structure, placed one after the other along its tree of joints."""

from __future__ import annotations

import casadi as ca

from doe_kc.axle.structure import CHASSIS, BallConnection, LineConnection, Structure
from doe_kc.solver import rotation
from doe_kc.solver.builder import Body, Builder, body
from doe_kc.solver.elements._base import hardpoint
from doe_kc.solver.elements.steering import add_rack
from doe_kc.solver.elements.subframe import flexible_joint, free_body
from doe_kc.solver.freedoms import rotations, slide, twist
from doe_kc.solver.structure.tree import Branch, JointTree, SideJoint


def side_word(name: str, side: str) -> str:
    """Name of a part in messages: `lower arm L`."""
    return f"{name.replace('_', ' ')} {side}".strip()


def add_bodies(b: Builder, structure: Structure, tree: JointTree, split: str) -> None:
    """Every body of the tree in `b.bodies`, the chassis too. split: single body that has halves besides."""
    zero = ca.SX.zeros(3)
    b.bodies[CHASSIS] = Body(CHASSIS, zero, zero, zero, ca.SX.eye(3))
    for branch in tree.branches:
        b.bodies[branch.body] = _placed(b, structure, branch)
    if split:
        centre = split_centre(b, structure)
        for side in "LR":
            flexible_joint(b, b.bodies[split], b.bodies[f"{split}.{side}"], centre)


def split_centre(b: Builder, structure: Structure) -> ca.SX:
    """Mean of the points at which the parts of a split body are joined."""
    names = structure.subframe.centre if structure.subframe is not None else ()
    points = [hardpoint(b, name, side) for name in names for side in "LR"]
    return b.constant(sum(points[1:], points[0]) / len(points))


def _placed(b: Builder, structure: Structure, branch: Branch) -> Body:
    name, _, side = branch.body.partition(".")
    words, joint = side_word(name, side), branch.joint
    if joint is None:
        return free_body(b, words, _reference_point(b, structure, name, side))
    parent = b.bodies[branch.parent]
    if joint.type == "rack" and structure.rack is not None:
        return add_rack(b, parent, structure.rack.at)
    if isinstance(joint.connection, BallConnection):
        return _on_ball(b, words, parent, hardpoint(b, joint.connection.at, joint.side))
    assert isinstance(joint.connection, LineConnection)
    return _on_cylinder(b, words, parent, joint, joint.connection)


def _reference_point(b: Builder, structure: Structure, name: str, side: str) -> ca.SX:
    """Origin of a free body: the first ball joint or bushing on it; of a single one the mean of the sides."""
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


def _on_ball(b: Builder, words: str, parent: Body, ball: ca.SX) -> Body:
    turned, turns = rotations(words)
    child = body(words, ball, parent.point(ball), turned)
    return b.join(words, child, parent, turns, carries_moment=False)


def _on_cylinder(b: Builder, words: str, parent: Body, joint: SideJoint, line: LineConnection) -> Body:
    """The child slides along and turns about the line, its origin in the line's end on it."""
    start, end = hardpoint(b, line.at_a, joint.side), hardpoint(b, line.at_b, joint.side)
    axis = b.constant((end - start) / ca.norm_2(end - start))
    along = parent.axes @ axis
    slid, slides = slide(f"{words} slide", along)
    turned, twists = twist(f"{words} twist", along)
    origin = parent.point(end) + along * slid
    child = body(words, end, origin, rotation.compose(parent.gibbs, axis * turned))
    return b.join(words, child, parent, slides + twists)
