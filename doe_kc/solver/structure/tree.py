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

from doe_kc.axle.structure import (
    CHASSIS,
    BallConnection,
    LineConnection,
    SplitBody,
    SteerArmBeam,
    StrutClamp,
    of_side,
)
from doe_kc.axle.topology import Topology

JointType = Literal["weld", "rack", "cylindrical", "ball", "clamp", "beam", "sprung ball"]
CONSTRAINED: dict[JointType, int] = {
    "weld": 6,
    "rack": 5,
    "cylindrical": 4,
    "ball": 3,
    "clamp": 3,
    "beam": 3,
    "sprung ball": 0,
}
"""Freedoms that a joint takes. A ball on a spring takes none, but moves with the body that carries it, so
that a stiff one is no small difference of long ways."""


@dataclass(frozen=True)
class SideJoint:
    """A joint of one side between two bodies' instances."""

    type: JointType
    name: str
    side: str
    a: str
    b: str
    connection: BallConnection | LineConnection | SplitBody | StrutClamp | SteerArmBeam | None

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


def joints(topology: Topology) -> Iterator[SideJoint]:
    """All joints that can carry a body; ball joints with play are none."""
    structure = topology.structure

    def ends(a: str, b: str, side: str) -> tuple[str, str]:
        return structure.part_on_side(a, side), structure.part_on_side(b, side)

    if (rack := structure.rack) is not None:
        yield SideJoint("rack", "rack", "", rack.carrier, rack.body, None)
    for side in "LR":
        if (split := structure.subframe) is not None and not topology.flexible_subframe:
            yield SideJoint("weld", "sub-frame half", side, split.body, f"{split.body}.{side}", split)
        if (clamp := structure.strut) is not None:
            kind: JointType = "clamp" if topology.strut_bending else "weld"
            yield SideJoint(kind, "strut clamp", side, *ends(clamp.carrier, clamp.body, side), clamp)
        if (beam := structure.steer_arm) is not None:
            kind = "beam" if topology.steer_arm else "weld"
            yield SideJoint(kind, "steer arm", side, *ends(beam.carrier, beam.body, side), beam)
    for line in structure.cylindricals:
        for side in structure.sides(single=line.single):
            yield SideJoint("cylindrical", line.name, side, *ends(line.a, line.b, side), line)
    for ball in structure.balls:
        for side in structure.sides(single=ball.single):
            name = of_side(ball.name, side)
            if name not in topology.play_balls:
                kind = "sprung ball" if name in topology.elastic_balls else "ball"
                yield SideJoint(kind, ball.name, side, *ends(ball.a, ball.b, side), ball)


def joint_tree(topology: Topology) -> JointTree:
    """The tree with the fewest unknowns; ties are broken by the order of the type file."""
    structure = topology.structure
    ranked = sorted(joints(topology), key=lambda j: -CONSTRAINED[j.type])
    chosen, loops = _spanning(ranked, [CHASSIS, *structure.parts])
    rack = structure.rack.body if structure.rack is not None else ""
    bodies = sorted(structure.parts, key=lambda body: body == rack)  # it hangs on its carrier
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
    """Bodies that hang on the chassis or are free in space, then those that hang on them, ring after ring:
    what is alike on both sides stands beside each other. A rack that carries nothing comes last."""
    branches, ring = list[Branch](), [CHASSIS]
    placed = _reached(chosen, CHASSIS)
    for body in bodies:
        if body not in placed:
            ring.append(body)
            placed |= _reached(chosen, body)
            branches.append(Branch(body, "", None))
    placed = set(ring)
    while ring:
        hanging = [
            Branch(joint.other(body), body, joint)
            for body in ring
            for joint in chosen
            if body in (joint.a, joint.b) and joint.other(body) not in placed
        ]
        branches += hanging
        ring = [branch.body for branch in hanging]
        placed |= set(ring)
    parents = {branch.parent for branch in branches}

    def last(branch: Branch) -> bool:
        joint = branch.joint
        return joint is not None and joint.type == "rack" and branch.body not in parents

    yield from sorted(branches, key=last)


def _reached(chosen: Sequence[SideJoint], start: str) -> set[str]:
    """All bodies that joints connect with one."""
    reached, ring = {start}, [start]
    while ring:
        ring = [
            joint.other(body)
            for body in ring
            for joint in chosen
            if body in (joint.a, joint.b) and joint.other(body) not in reached
        ]
        reached |= set(ring)
    return reached
