"""Motions of an axle's bodies that nothing resists, and joints that hold one motion twice, at design.

Every body has six small motions. Ideal joints forbid some of them, bushings, springs and the column resist
others: each is a row of two matrices. What no row sees is free; a combination of the ideal joints' rows that
is zero is held twice. Tyres are left out: a wheel that only its tyre holds is not guided.
Reference: J. G. de Jalon, E. Bayo, Kinematic and Dynamic Simulation of Multibody Systems, Springer, 1994,
chapter 3 (rank of the constraint Jacobian).
"""

from __future__ import annotations

import numpy as np

from doe_kc.axle.model import Axle
from doe_kc.axle.small_motions import LEVER, FreeTurns, SmallMotions, words_of_side
from doe_kc.axle.structure import Structure
from doe_kc.ground.errors import InputError
from doe_kc.ground.typing import FloatArray

RANK = 1e-7
"""Smallest over largest singular value that is no zero."""
NEAR = 2.0
"""mm from an axis within which a hardpoint counts as on it."""
TAKES_PART = 0.05
"""Of the largest motion of a body, above which a body takes part in a free motion; of joints likewise."""
ALONE = 0.999
"""Share of a free motion in one body above which it is that body's alone."""


def check_freedoms(axle: Axle, structure: Structure, source: str) -> None:
    """InputError for a motion that nothing resists, or one that ideal joints hold twice."""
    matrix = SmallMotions(axle, structure)
    ideal, resisting = list(matrix.ideal()), list(matrix.resisting())
    free = _null_vectors(np.array([r.row for r in (*ideal, *resisting)]))
    if len(free):
        raise InputError(
            f"{source}: nothing resists that {_motion_in_words(matrix, free)}; a link, joint or bushing is "
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


def wheel_freedoms(axle: Axle, structure: Structure, free_turns: FreeTurns) -> int:
    """In how many ways the wheel centres move up and down at design, 0 to 2, the bushings being joints."""
    motions = SmallMotions(axle, structure)
    free = _null_vectors(np.array([*motions.jointed(free_turns), *motions.held_rack()]))
    heights = np.array([motions.height(side) for side in "LR"])
    return int(np.linalg.matrix_rank(heights @ free.T, tol=1e-6)) if len(free) else 0


def free_spins(axle: Axle, structure: Structure, free_turns: FreeTurns) -> dict[str, FloatArray]:
    """Body -> unit axis (3,) of the turn that it makes alone, the bushings being joints; a link's, not a
    wheel carrier's. Of the left side and of single bodies."""
    motions = SmallMotions(axle, structure)
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


def _motion_in_words(motions: SmallMotions, free: FloatArray) -> str:
    """The simplest of the free motions (k, 6 n): `toe link left turns about the line TLI-TLO`."""
    of_bodies = free.reshape(len(free), len(motions.bodies), 6)
    parts = [np.linalg.svd(of_bodies[:, i])[1:] for i in range(len(motions.bodies))]
    most = int(np.argmax([values[0] for values, _ in parts]))
    values, vectors = parts[most]
    words, side = _parted(motions.bodies[most])
    if values[0] < ALONE:
        return _joint_motion(motions, of_bodies[0])
    ways = int(np.sum(values > ALONE))
    if ways == 1:
        return f"{words_of_side(words, side)} {_how(motions, words, side, vectors[0])}"
    fixed = [
        p for p in _points(motions.structure, words) if _stands(motions.at(p, side or "L"), vectors[:ways])
    ]
    about = f"turns about {fixed[0]}" if fixed else "moves"
    return f"{words_of_side(words, side)} {about} in {ways} ways"


def _joint_motion(motions: SmallMotions, free: FloatArray) -> str:
    """Of several bodies, (n, 6), told by the one that moves most."""
    sizes = [_size(motions, body, motion) for body, motion in zip(motions.bodies, free, strict=True)]
    most = int(np.argmax(sizes))
    moving = [b for b, size in zip(motions.bodies, sizes, strict=True) if size > TAKES_PART * max(sizes)]
    words, side = _parted(motions.bodies[most])
    others = [words_of_side(*_parted(b)) for b in moving if b != motions.bodies[most]]
    together = f", together with {', '.join(others)}" if others else ""
    return f"{words_of_side(words, side)} {_how(motions, words, side, free[most])}{together}"


def _stands(at: FloatArray, motions: FloatArray) -> bool:
    """Whether a point of a body moves in none of its motions (m, 6)."""
    return all(np.linalg.norm(m[:3] + np.cross(m[3:] / LEVER, at)) < NEAR / LEVER for m in motions)


def _size(motions: SmallMotions, body: str, motion: FloatArray) -> float:
    """mm that the fastest of its points moves."""
    name, _, side = body.partition(".")
    shift, turn = motion[:3], motion[3:] / LEVER
    return max(
        (
            float(np.linalg.norm(shift + np.cross(turn, motions.at(p, side or "L"))))
            for p in _points(motions.structure, name)
        ),
        default=float(np.linalg.norm(motion)),
    )


def _points(structure: Structure, body: str) -> list[str]:
    """Two-sided hardpoints on a body."""
    out = [ball.at for ball in structure.balls if body in (ball.a, ball.b) and not ball.single]
    out += [bush.at for bush in structure.bushings if body in (bush.inner, bush.outer) and not bush.single]
    for line in (*structure.rods, *structure.cylindricals, *structure.springs):
        out += [at for b, at in ((line.a, line.at_a), (line.b, line.at_b)) if b == body and not line.single]
    return list(dict.fromkeys(out + (["WLC"] if body == structure.carrier else [])))


def _how(motions: SmallMotions, name: str, side: str, motion: FloatArray) -> str:
    shift, turn = motion[:3], motion[3:] / LEVER
    if np.linalg.norm(turn) * LEVER < TAKES_PART * np.linalg.norm(shift):
        return f"moves along {_direction(shift)}"
    axis = turn / np.linalg.norm(turn)
    on_axis = np.cross(axis, shift) / np.linalg.norm(turn)
    near = [
        p
        for p in _points(motions.structure, name)
        if np.linalg.norm(np.cross(motions.at(p, side or "L") - on_axis, axis)) < NEAR
    ]
    if len(near) >= 2:
        return f"turns about the line {near[0]}-{near[1]}"
    through = f" through {near[0]}" if near else ""
    return f"turns about {_direction(axis)}{through}"


def _direction(vector: FloatArray) -> str:
    x, y, z = vector / np.linalg.norm(vector)
    return f"({x:.2f}, {y:.2f}, {z:.2f})"


def _parted(body: str) -> tuple[str, str]:
    name, _, side = body.partition(".")
    return name, side
