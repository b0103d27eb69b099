"""What joints, bushings and springs see of small motions of an axle's bodies, at design: a row each."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from doe_kc.axle.geometry import point
from doe_kc.axle.model import Axle
from doe_kc.axle.structure import CHASSIS, BushingConnection, Structure
from doe_kc.ground.typing import FloatArray

LEVER = 100.0
"""mm; a turn counts as much as the shift of a point at this lever."""

FreeTurns = Mapping[str, Sequence[str] | None]
"""Of every bushing as a joint, which of the turns Tx, Ty, Tz it leaves free; None: it stays a bushing."""


@dataclass(frozen=True)
class JointRow:
    """What one joint sees of small motions: row (6 n,) over all bodies, by the joint's name in words."""

    joint: str
    row: FloatArray


class SmallMotions:
    """Small motions of all bodies: shift in mm at the chassis frame's origin, then turn in 1/LEVER rad.

    bodies: (n,) in the order of the columns, six each; those of a side as `knuckle.L`.
    """

    def __init__(self, axle: Axle, structure: Structure) -> None:
        self._axle, self.structure = axle, structure
        sided = [f"{name}.{side}" for name in structure.bodies for side in "LR"]
        self.bodies = [*structure.single_bodies, *sided]

    def _place(self, body: str, side: str) -> int | None:
        """First column of a body; None of the vehicle body, which stands still."""
        return None if body == CHASSIS else 6 * self.bodies.index(self.structure.on_side(body, side))

    def at(self, name: str, side: str) -> FloatArray:
        """(3,) mm, a hardpoint in the chassis frame; side empty: a single one. KeyError for one unknown."""
        mirrored = np.array([1.0, -1.0 if side == "R" else 1.0, 1.0])
        return np.asarray(point(self._axle, name, side) * mirrored)

    def _row(
        self, ends: Sequence[tuple[str, int]], side: str, at: FloatArray, along: FloatArray
    ) -> FloatArray:
        """Of the shift along a direction of the material points at `at`; ends: bodies and signs."""
        row = np.zeros(6 * len(self.bodies))
        for body, sign in ends:
            if (place := self._place(body, side)) is not None:
                row[place : place + 3] += sign * along
                row[place + 3 : place + 6] += sign * np.cross(at, along) / LEVER
        return row

    def _turn(self, ends: Sequence[tuple[str, int]], side: str, about: FloatArray) -> FloatArray:
        row = np.zeros(6 * len(self.bodies))
        for body, sign in ends:
            if (place := self._place(body, side)) is not None:
                row[place + 3 : place + 6] += sign * about
        return row

    def _shifts(self, joint: str, a: str, b: str, side: str, at: FloatArray) -> Iterator[JointRow]:
        for along in np.eye(3):
            yield JointRow(joint, self._row(((b, 1), (a, -1)), side, at, along))

    def ideal(self) -> Iterator[JointRow]:
        """Rows of ball joints, rods, cylindrical joints, the rack, strut clamp and steer arm."""
        s = self.structure
        for ball in s.balls:
            for side in s.sides(single=ball.single):
                yield from self._shifts(
                    words_of_side(ball.name, side), ball.a, ball.b, side, self.at(ball.at, side)
                )
        for rod in s.rods:
            for side in s.sides(single=rod.single):
                yield JointRow(
                    words_of_side(rod.name, side), self._along(rod.a, rod.at_a, rod.b, rod.at_b, side)
                )
        for line in s.cylindricals:
            for side in s.sides(single=line.single):
                start, end = self.at(line.at_a, side), self.at(line.at_b, side)
                ends = ((line.b, 1), (line.a, -1))
                for across in _across(end - start):
                    yield JointRow(words_of_side(line.name, side), self._row(ends, side, start, across))
                    yield JointRow(words_of_side(line.name, side), self._turn(ends, side, across))
        for part, words in ((s.strut, "strut clamp"), (s.steer_arm, "steer arm")):
            for side in "LR" if part is not None else "":
                assert part is not None
                name, at = words_of_side(words, side), self.at(part.at, side)
                yield from self._shifts(name, part.carrier, part.body, side, at)
                for about in np.eye(3):
                    yield JointRow(name, self._turn(((part.body, 1), (part.carrier, -1)), side, about))
        if s.rack is not None:
            ends = ((s.rack.body, 1), (s.rack.carrier, -1))
            at = (self.at(s.rack.at, "L") + self.at(s.rack.at, "R")) / 2.0
            for along in np.eye(3):
                yield JointRow("rack", self._turn(ends, "", along))
                if along[1] == 0.0:
                    yield JointRow("rack", self._row(ends, "", at, along))

    def resisting(self) -> Iterator[JointRow]:
        """Rows of bushings, springs and the column."""
        s = self.structure
        for bush in s.bushings:
            for side in s.sides(single=bush.single):
                name, at = words_of_side(bush.name, side), self.at(bush.at, side)
                yield from self._shifts(name, bush.inner, bush.outer, side, at)
                for about in np.eye(3):
                    yield JointRow(name, self._turn(((bush.outer, 1), (bush.inner, -1)), side, about))
        for spring in s.springs:
            for side in s.sides(single=spring.single):
                yield JointRow(spring.name, self._along(spring.a, spring.at_a, spring.b, spring.at_b, side))
        if s.rack is not None:
            at, ends = self.at(s.rack.at, "L"), ((s.rack.body, 1), (s.rack.carrier, -1))
            yield JointRow("column", self._row(ends, "", at, np.array([0.0, 1.0, 0.0])))

    def columns(self, body: str) -> slice:
        """Of a body of the left side or a single one."""
        place = self._place(body, "L")
        assert place is not None
        return slice(place, place + 6)

    def jointed(self, free_turns: FreeTurns) -> Iterator[FloatArray]:
        """Rows of all ideal joints, those in the place of bushings too."""
        yield from (r.row for r in (*self.ideal(), *self._bushing_joints(free_turns)))

    def _bushing_joints(self, free_turns: FreeTurns) -> Iterator[JointRow]:
        s = self.structure
        for bush in s.bushings:
            free = free_turns[bush.name]
            if free is None:
                continue
            for side in s.sides(single=bush.single):
                name, at = words_of_side(bush.name, side), self.at(bush.at, side)
                yield from self._shifts(name, bush.inner, bush.outer, side, at)
                for turn, about in self._local_axes(bush, side).items():
                    if turn not in free:
                        yield JointRow(name, self._turn(((bush.outer, 1), (bush.inner, -1)), side, about))

    def _local_axes(self, bush: BushingConnection, side: str) -> dict[str, FloatArray]:
        """Directions about which Tx, Ty and Tz turn; those of a line are not told apart but for z."""
        mirrored = np.array([1.0, -1.0 if side == "R" else 1.0, 1.0])
        if bush.line is not None:
            along = self.at(bush.line[1], side) - self.at(bush.line[0], side)
            return dict(zip(("Tx", "Ty"), _across(along), strict=True)) | {
                "Tz": along / np.linalg.norm(along)
            }
        axes = np.array(bush.axes).T
        return {f"T{axis}": mirrored * vector for axis, vector in zip("xyz", axes, strict=True)}

    def held_rack(self) -> Iterator[FloatArray]:
        """Row of the rack's travel against its carrier."""
        rack = self.structure.rack
        if rack is not None:
            ends = ((rack.body, 1), (rack.carrier, -1))
            yield self._row(ends, "", self.at(rack.at, "L"), np.array([0.0, 1.0, 0.0]))

    def height(self, side: str) -> FloatArray:
        """Row of the wheel centre's rise."""
        return self._row(
            ((self.structure.carrier, 1),), side, self.at("WLC", side), np.array([0.0, 0.0, 1.0])
        )

    def _along(self, a: str, at_a: str, b: str, at_b: str, side: str) -> FloatArray:
        """Of the change of the distance between two points."""
        start, end = self.at(at_a, side), self.at(at_b, side)
        along = (end - start) / np.linalg.norm(end - start)
        return self._row(((b, 1),), side, end, along) + self._row(((a, -1),), side, start, along)


def _across(along: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Two unit vectors across a direction and each other."""
    _, _, vectors = np.linalg.svd(along[None, :])
    return vectors[1], vectors[2]


def words_of_side(name: str, side: str) -> str:
    """`tie rod left` of `tie_rod` and `L`; side empty: of a single one."""
    return f"{name.replace('_', ' ')} {({'L': 'left', 'R': 'right'}).get(side, '')}".strip()
