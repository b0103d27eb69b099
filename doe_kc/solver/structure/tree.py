"""Which joints carry the bodies of a structure, so that its equations have the fewest unknowns.

Bodies and joints are a graph. A joint that is a branch of the tree gives its child the freedoms that it
leaves free; a body without a joint below it is free in space (six unknowns); a joint that closes a loop costs
the forces that it carries. So the tree of the largest sum of constrained freedoms is best: Kruskal's
algorithm.
Reference: R. Featherstone, Rigid Body Dynamics Algorithms, Springer, 2008, chapters 4 and 8.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Literal

from doe_kc.axle.structure import CHASSIS, BallConnection, LineConnection, Structure

JointType = Literal["ball", "cylindrical", "rack"]
CONSTRAINED: dict[JointType, int] = {"rack": 5, "cylindrical": 4, "ball": 3}
"""Freedoms that a joint takes."""


@dataclass(frozen=True)
class SideJoint:
    """A joint of one side between two bodies' instances."""

    type: JointType
    name: str
    side: str
    a: str
    b: str
    connection: BallConnection | LineConnection | None

    def other(self, body: str) -> str:
        """The body at its other end."""
        return self.b if body == self.a else self.a


@dataclass(frozen=True)
class Branch:
    """A body and the joint it hangs by on its parent; joint None: free in space."""

    body: str
    parent: str
    joint: SideJoint | None


@dataclass(frozen=True)
class JointTree:
    """branches: parents before children. loops: joints that close a loop."""

    branches: tuple[Branch, ...]
    loops: tuple[SideJoint, ...]


def instances(structure: Structure, split: str = "") -> list[str]:
    """Names of all bodies, one a side. split: a single body that has halves besides."""
    sided = [f"{name}.{side}" for name in structure.bodies for side in "LR"]
    halves = [f"{split}.{side}" for side in "LR"] if split else []
    return [*structure.single_bodies, *halves, *sided]


def instance(structure: Structure, body: str, side: str, split: str = "") -> str:
    """Name of the body that a connection of a side is on: of a split body the half of its side."""
    if side and body == split:
        return f"{body}.{side}"
    return structure.on_side(body, side)


def joints(structure: Structure, elastic: Sequence[str] = (), split: str = "") -> Iterator[SideJoint]:
    """All ideal joints. elastic: ball joints that are none, by name of either side."""
    if (rack := structure.rack) is not None:
        yield SideJoint("rack", "rack", "", rack.carrier, rack.body, None)
    for line in structure.cylindricals:
        for side in structure.sides(single=line.single):
            a, b = (instance(structure, body, side, split) for body in (line.a, line.b))
            yield SideJoint("cylindrical", line.name, side, a, b, line)
    for ball in structure.balls:
        for side in structure.sides(single=ball.single):
            if (f"{ball.name}@{side}" if side else ball.name) not in elastic:
                a, b = (instance(structure, body, side, split) for body in (ball.a, ball.b))
                yield SideJoint("ball", ball.name, side, a, b, ball)


def joint_tree(structure: Structure, elastic: Sequence[str] = (), split: str = "") -> JointTree:
    """The tree with the fewest unknowns; ties are broken by the order of the type file."""
    ranked = sorted(joints(structure, elastic, split), key=lambda j: -CONSTRAINED[j.type])
    chosen, loops = _spanning(ranked, [CHASSIS, *instances(structure, split)])
    rack = structure.rack.body if structure.rack is not None else ""
    bodies = sorted(instances(structure, split), key=lambda body: body == rack)  # it hangs on its carrier
    return JointTree(tuple(_branches(chosen, bodies)), tuple(loops))


def _spanning(ranked: Sequence[SideJoint], bodies: Sequence[str]) -> tuple[list[SideJoint], list[SideJoint]]:
    """(joints of the tree, joints that close a loop)."""
    group = {body: body for body in bodies}

    def root(body: str) -> str:
        while group[body] != body:
            body = group[body]
        return body

    chosen: list[SideJoint] = []
    loops: list[SideJoint] = []
    for joint in ranked:
        a, b = root(joint.a), root(joint.b)
        if a == b:
            loops.append(joint)
        else:
            group[b] = a
            chosen.append(joint)
    return chosen, loops


def _branches(chosen: Sequence[SideJoint], bodies: Sequence[str]) -> Iterator[Branch]:
    """Bodies from the chassis outwards, then from the first body of what does not hang on it."""
    placed = {CHASSIS}

    def outwards(body: str) -> Iterator[Branch]:
        for joint in chosen:
            if body in (joint.a, joint.b) and (child := joint.other(body)) not in placed:
                placed.add(child)
                yield Branch(child, body, joint)
                yield from outwards(child)

    yield from outwards(CHASSIS)
    for body in bodies:
        if body not in placed:
            placed.add(body)
            yield Branch(body, "", None)
            yield from outwards(body)
