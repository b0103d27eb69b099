"""Motions of an axle's bodies that nothing resists, and joints that hold one motion twice, at design.

Every body has six small motions. Ideal joints forbid some of them, bushings, springs and the column resist
others: each is a row of two matrices. What no row sees is free; a combination of the ideal joints' rows that
is zero is held twice. Tyres are left out: a wheel that only its tyre holds is not guided.
Reference: J. G. de Jalon, E. Bayo, Kinematic and Dynamic Simulation of Multibody Systems, Springer, 1994,
chapter 3 (rank of the constraint Jacobian).
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from doe_kc.axle.geometry import point
from doe_kc.axle.model import Axle
from doe_kc.axle.structure import CHASSIS, BushingConnection, Structure
from doe_kc.ground.errors import InputError
from doe_kc.ground.typing import FloatArray

LEVER = 100.0
"""mm; a turn counts as much as the shift of a point at this lever."""
RANK = 1e-7
"""Smallest over largest singular value that is no zero."""
NEAR = 2.0
"""mm from an axis within which a hardpoint counts as on it."""
TAKES_PART = 0.05
"""Of the largest motion of a body, above which a body takes part in a free motion; of joints likewise."""
ALONE = 0.999
"""Share of a free motion in one body above which it is that body's alone."""


@dataclass(frozen=True)
class JointRow:
    """What one joint sees of small motions: row (6 n,) over all bodies, by the joint's name in words."""

    joint: str
    row: FloatArray


def check_freedoms(axle: Axle, structure: Structure, source: str) -> None:
    """InputError for a motion that nothing resists, or one that ideal joints hold twice."""
    matrix = _Motions(axle, structure)
    ideal, resisting = list(matrix.ideal()), list(matrix.resisting())
    free = _null_vectors(np.array([r.row for r in (*ideal, *resisting)]))
    if len(free):
        raise InputError(
            f"{source}: nothing resists that {matrix.motion_in_words(free)}; a link, joint or bushing is "
            "missing in the axle type."
        )
    twice = _null_vectors(np.array([r.row for r in ideal]).T) if ideal else np.empty((0, 0))
    if len(twice):
        weights = np.abs(twice[0])
        names = [r.joint for r, w in zip(ideal, weights, strict=True) if w > TAKES_PART * weights.max()]
        raise InputError(
            f"{source}: one motion is held twice by {', '.join(dict.fromkeys(names))}; put a bushing in the "
            "place of one of these joints in the axle type."
        )


FreeTurns = Mapping[str, Sequence[str] | None]
"""Of every bushing as a joint, which of the turns Tx, Ty, Tz it leaves free; None: it stays a bushing."""


def wheel_freedoms(axle: Axle, structure: Structure, free_turns: FreeTurns) -> int:
    """In how many ways the wheel centres move up and down at design, 0 to 2, the bushings being joints."""
    motions = _Motions(axle, structure)
    free = _null_vectors(np.array([*motions.jointed(free_turns), *motions.held_rack()]))
    heights = np.array([motions.height(side) for side in "LR"])
    return int(np.linalg.matrix_rank(heights @ free.T, tol=1e-6)) if len(free) else 0


def free_spins(axle: Axle, structure: Structure, free_turns: FreeTurns) -> dict[str, FloatArray]:
    """Body -> unit axis (3,) of the turn that it makes alone, the bushings being joints; a link's, not a
    wheel carrier's. Of the left side and of single bodies."""
    motions = _Motions(axle, structure)
    rows = np.array(list(motions.jointed(free_turns)))
    out: dict[str, FloatArray] = {}
    for body in (*structure.bodies, *structure.single_bodies):
        free = _null_vectors(rows[:, motions.columns(body)])
        if body != structure.carrier and len(free) == 1:
            turn = free[0][3:]
            out[body] = turn / np.linalg.norm(turn)
    return out


def _null_vectors(matrix: FloatArray) -> FloatArray:
    """(k, columns) vectors that a matrix (rows, columns) maps to zero."""
    _, values, vectors = np.linalg.svd(matrix)
    padded = np.zeros(matrix.shape[1])
    padded[: len(values)] = values
    return np.asarray(vectors[padded <= RANK * max(values[0], 1e-300)])


class _Motions:
    """Small motions of all bodies: shift in mm at the chassis frame's origin, then turn in 1/LEVER rad."""

    def __init__(self, axle: Axle, structure: Structure) -> None:
        self._axle, self._structure = axle, structure
        sided = [f"{name}.{side}" for name in structure.bodies for side in "LR"]
        self._bodies = [*structure.single_bodies, *sided]

    def _place(self, body: str, side: str) -> int | None:
        """First column of a body; None of the vehicle body, which stands still."""
        return None if body == CHASSIS else 6 * self._bodies.index(self._structure.on_side(body, side))

    def _at(self, name: str, side: str) -> FloatArray:
        """(3,) hardpoint in the chassis frame."""
        mirrored = np.array([1.0, -1.0 if side == "R" else 1.0, 1.0])
        return np.asarray(point(self._axle, name, side) * mirrored)

    def _row(
        self, ends: Sequence[tuple[str, int]], side: str, at: FloatArray, along: FloatArray
    ) -> FloatArray:
        """Of the shift along a direction of the material points at `at`; ends: bodies and signs."""
        row = np.zeros(6 * len(self._bodies))
        for body, sign in ends:
            if (place := self._place(body, side)) is not None:
                row[place : place + 3] += sign * along
                row[place + 3 : place + 6] += sign * np.cross(at, along) / LEVER
        return row

    def _turn(self, ends: Sequence[tuple[str, int]], side: str, about: FloatArray) -> FloatArray:
        row = np.zeros(6 * len(self._bodies))
        for body, sign in ends:
            if (place := self._place(body, side)) is not None:
                row[place + 3 : place + 6] += sign * about
        return row

    def _shifts(self, joint: str, a: str, b: str, side: str, at: FloatArray) -> Iterator[JointRow]:
        for along in np.eye(3):
            yield JointRow(joint, self._row(((b, 1), (a, -1)), side, at, along))

    def ideal(self) -> Iterator[JointRow]:
        """Rows of ball joints, rods, cylindrical joints, the rack, strut clamp and steer arm."""
        s = self._structure
        for ball in s.balls:
            for side in s.sides(single=ball.single):
                yield from self._shifts(
                    _words(ball.name, side), ball.a, ball.b, side, self._at(ball.at, side)
                )
        for rod in s.rods:
            for side in s.sides(single=rod.single):
                yield JointRow(_words(rod.name, side), self._along(rod.a, rod.at_a, rod.b, rod.at_b, side))
        for line in s.cylindricals:
            for side in s.sides(single=line.single):
                start, end = self._at(line.at_a, side), self._at(line.at_b, side)
                ends = ((line.b, 1), (line.a, -1))
                for across in _across(end - start):
                    yield JointRow(_words(line.name, side), self._row(ends, side, start, across))
                    yield JointRow(_words(line.name, side), self._turn(ends, side, across))
        for part, words in ((s.strut, "strut clamp"), (s.steer_arm, "steer arm")):
            for side in "LR" if part is not None else "":
                assert part is not None
                name, at = _words(words, side), self._at(part.at, side)
                yield from self._shifts(name, part.carrier, part.body, side, at)
                for about in np.eye(3):
                    yield JointRow(name, self._turn(((part.body, 1), (part.carrier, -1)), side, about))
        if s.rack is not None:
            ends = ((s.rack.body, 1), (s.rack.carrier, -1))
            at = (self._at(s.rack.at, "L") + self._at(s.rack.at, "R")) / 2.0
            for along in np.eye(3):
                yield JointRow("rack", self._turn(ends, "", along))
                if along[1] == 0.0:
                    yield JointRow("rack", self._row(ends, "", at, along))

    def resisting(self) -> Iterator[JointRow]:
        """Rows of bushings, springs and the column."""
        s = self._structure
        for bush in s.bushings:
            for side in s.sides(single=bush.single):
                name, at = _words(bush.name, side), self._at(bush.at, side)
                yield from self._shifts(name, bush.inner, bush.outer, side, at)
                for about in np.eye(3):
                    yield JointRow(name, self._turn(((bush.outer, 1), (bush.inner, -1)), side, about))
        for spring in s.springs:
            for side in s.sides(single=spring.single):
                yield JointRow(spring.name, self._along(spring.a, spring.at_a, spring.b, spring.at_b, side))
        if s.rack is not None:
            at, ends = self._at(s.rack.at, "L"), ((s.rack.body, 1), (s.rack.carrier, -1))
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
        s = self._structure
        for bush in s.bushings:
            free = free_turns[bush.name]
            if free is None:
                continue
            for side in s.sides(single=bush.single):
                name, at = _words(bush.name, side), self._at(bush.at, side)
                yield from self._shifts(name, bush.inner, bush.outer, side, at)
                for turn, about in self._local_axes(bush, side).items():
                    if turn not in free:
                        yield JointRow(name, self._turn(((bush.outer, 1), (bush.inner, -1)), side, about))

    def _local_axes(self, bush: BushingConnection, side: str) -> dict[str, FloatArray]:
        """Directions about which Tx, Ty and Tz turn; those of a line are not told apart but for z."""
        mirrored = np.array([1.0, -1.0 if side == "R" else 1.0, 1.0])
        if bush.line is not None:
            along = self._at(bush.line[1], side) - self._at(bush.line[0], side)
            return dict(zip(("Tx", "Ty"), _across(along), strict=True)) | {
                "Tz": along / np.linalg.norm(along)
            }
        axes = np.array(bush.axes).T
        return {f"T{axis}": mirrored * vector for axis, vector in zip("xyz", axes, strict=True)}

    def held_rack(self) -> Iterator[FloatArray]:
        """Row of the rack's travel against its carrier."""
        rack = self._structure.rack
        if rack is not None:
            ends = ((rack.body, 1), (rack.carrier, -1))
            yield self._row(ends, "", self._at(rack.at, "L"), np.array([0.0, 1.0, 0.0]))

    def height(self, side: str) -> FloatArray:
        """Row of the wheel centre's rise."""
        return self._row(
            ((self._structure.carrier, 1),), side, self._at("WLC", side), np.array([0.0, 0.0, 1.0])
        )

    def _along(self, a: str, at_a: str, b: str, at_b: str, side: str) -> FloatArray:
        """Of the change of the distance between two points."""
        start, end = self._at(at_a, side), self._at(at_b, side)
        along = (end - start) / np.linalg.norm(end - start)
        return self._row(((b, 1),), side, end, along) + self._row(((a, -1),), side, start, along)

    def motion_in_words(self, free: FloatArray) -> str:
        """The simplest of the free motions (k, 6 n): `toe link left turns about the line TLI-TLO`."""
        motions = free.reshape(len(free), len(self._bodies), 6)
        parts = [np.linalg.svd(motions[:, i])[1:] for i in range(len(self._bodies))]
        most = int(np.argmax([values[0] for values, _ in parts]))
        values, vectors = parts[most]
        words, side = _parted(self._bodies[most])
        if values[0] < ALONE:
            return self._joint_motion(motions)
        ways = int(np.sum(values > ALONE))
        if ways == 1:
            return f"{_words(words, side)} {self._how(words, side, vectors[0])}"
        fixed = [p for p in self._points(words) if self._stands(self._at(p, side or "L"), vectors[:ways])]
        about = f"turns about {fixed[0]}" if fixed else "moves"
        return f"{_words(words, side)} {about} in {ways} ways"

    def _joint_motion(self, motions: FloatArray) -> str:
        """Of several bodies, told by the one that moves most."""
        sizes = [self._size(body, motion) for body, motion in zip(self._bodies, motions[0], strict=True)]
        most = int(np.argmax(sizes))
        moving = [b for b, size in zip(self._bodies, sizes, strict=True) if size > TAKES_PART * max(sizes)]
        words, side = _parted(self._bodies[most])
        others = [_words(*_parted(b)) for b in moving if b != self._bodies[most]]
        together = f", together with {', '.join(others)}" if others else ""
        return f"{_words(words, side)} {self._how(words, side, motions[0, most])}{together}"

    @staticmethod
    def _stands(at: FloatArray, motions: FloatArray) -> bool:
        """Whether a point of a body moves in none of its motions (m, 6)."""
        return all(np.linalg.norm(m[:3] + np.cross(m[3:] / LEVER, at)) < NEAR / LEVER for m in motions)

    def _size(self, body: str, motion: FloatArray) -> float:
        """mm that the fastest of its points moves."""
        name, _, side = body.partition(".")
        shift, turn = motion[:3], motion[3:] / LEVER
        return max(
            (
                float(np.linalg.norm(shift + np.cross(turn, self._at(p, side or "L"))))
                for p in self._points(name)
            ),
            default=float(np.linalg.norm(motion)),
        )

    def _points(self, body: str) -> list[str]:
        """Two-sided hardpoints on a body."""
        s = self._structure
        out = [ball.at for ball in s.balls if body in (ball.a, ball.b) and not ball.single]
        out += [bush.at for bush in s.bushings if body in (bush.inner, bush.outer) and not bush.single]
        for line in (*s.rods, *s.cylindricals, *s.springs):
            out += [
                at for b, at in ((line.a, line.at_a), (line.b, line.at_b)) if b == body and not line.single
            ]
        return list(dict.fromkeys(out + (["WLC"] if body == s.carrier else [])))

    def _how(self, name: str, side: str, motion: FloatArray) -> str:
        shift, turn = motion[:3], motion[3:] / LEVER
        if np.linalg.norm(turn) * LEVER < TAKES_PART * np.linalg.norm(shift):
            return f"moves along {_direction(shift)}"
        axis = turn / np.linalg.norm(turn)
        on_axis = np.cross(axis, shift) / np.linalg.norm(turn)
        near = [
            p
            for p in self._points(name)
            if np.linalg.norm(np.cross(self._at(p, side or "L") - on_axis, axis)) < NEAR
        ]
        if len(near) >= 2:
            return f"turns about the line {near[0]}-{near[1]}"
        through = f" through {near[0]}" if near else ""
        return f"turns about {_direction(axis)}{through}"


def _across(along: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Two unit vectors across a direction and each other."""
    _, _, vectors = np.linalg.svd(along[None, :])
    return vectors[1], vectors[2]


def _direction(vector: FloatArray) -> str:
    x, y, z = vector / np.linalg.norm(vector)
    return f"({x:.2f}, {y:.2f}, {z:.2f})"


def _parted(body: str) -> tuple[str, str]:
    name, _, side = body.partition(".")
    return name, side


def _words(name: str, side: str) -> str:
    return f"{name.replace('_', ' ')} {({'L': 'left', 'R': 'right'}).get(side, '')}".strip()
