"""Checks that an axle can exist before the solver meets it."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations

import numpy as np

from doe_kc.axle.model import Axle
from doe_kc.axle.structure import Structure, of_side
from doe_kc.ground.errors import InputError
from doe_kc.ground.typing import FloatArray

MIN_DISTANCE = 1.0
"""mm; joints closer than this are the same point for every practical purpose."""

FARTHEST = 1e5
"""mm; no car is 100 m long: such a coordinate is in another unit."""

NEAR_CENTRE_PLANE = 30.0
"""mm; a joint this near to y = 0, as that of a cross-beam's halves, may be moved across by tuning. The
wrong sign of a joint outside of it is refused."""


def point(axle: Axle, name: str, side: str = "L") -> FloatArray:
    """(3,) hardpoint of a side in left-hand coordinates, mm; side empty: of a single one, as it is."""
    return np.array([axle.values[of_side(f"{name}.{axis}", side)] for axis in "xyz"])


OF_SIDE = {"L": " of the left side", "R": " of the right side", "": ""}


def check_geometry(axle: Axle, source: str) -> None:
    """InputError for a geometry that no car has: coincident points, wrong side, wheel in the ground."""
    structure = axle.topology.structure
    for name in structure.single_points:
        _check_near(axle, name, "", source)
    for side in "LR":
        for name in structure.points:
            _check_near(axle, name, side, source)
    for names, single, why in _distinct(structure):
        for side in structure.sides(single=single):
            _check_apart(axle, names, side, why, source)
    for side in "LR":
        for name in structure.design_points:
            if point(axle, name, side)[1] > NEAR_CENTRE_PLANE:
                raise InputError(
                    f"{source}: hardpoint {name}{OF_SIDE[side]} lies on the other side of the car; "
                    "expected y < 0 on the left (y to the right, in mm). Check its sign."
                )
        _check_wheel_centre(axle, side, source)
        for line, what in _upright(structure):
            if point(axle, line[1], side)[2] <= point(axle, line[0], side)[2]:
                raise InputError(
                    f"{source}: {line[1]}{OF_SIDE[side]} lies below {line[0]}; the {what} must point upwards."
                )


def _distinct(structure: Structure) -> Iterator[tuple[tuple[str, str], bool, str]]:
    """Hardpoints that must lie apart, whether they are single ones, and what would be wrong else."""
    for line in structure.cylindricals:
        yield (line.at_a, line.at_b), line.single, f"the {_words(line.name)} axis has no length"
    for line in (*structure.rods, *structure.springs):
        yield (line.at_a, line.at_b), line.single, f"the {_words(line.name)} has no length"
    if (damper := structure.damper) is not None:
        yield (damper.at_a, damper.at_b), damper.single, "the damper has no length"
    if (beam := structure.steer_arm) is not None:
        yield (beam.root, beam.at), False, "the steer arm has no length"
    for bush in structure.bushings:
        if bush.line is not None:
            yield bush.line, bush.single, f"the axes of {bush.name} have no direction"
    if (pin := structure.kingpin) is not None:
        yield (pin.lower, pin.upper), False, "the kingpin axis has no length"
    for body in (*structure.bodies, *structure.single_bodies):
        for single in (False, True):
            for pair in combinations(structure.joint_points(body, single=single), 2):
                yield pair, single, f"two joints of the {_words(body)} coincide"


def _upright(structure: Structure) -> Iterator[tuple[tuple[str, str], str]]:
    """Lines from a lower to an upper hardpoint, and what they are."""
    if (clamp := structure.strut) is not None:
        yield clamp.line, "strut"
        for bush in structure.bushings:
            if bush.line is not None and bush.line[0] == clamp.line[1]:
                yield bush.line, "top-mount axis"


def _words(name: str) -> str:
    return name.replace("_", " ").replace("subframe", "sub-frame")


def _check_near(axle: Axle, name: str, side: str, source: str) -> None:
    if np.abs(point(axle, name, side)).max() > FARTHEST:
        raise InputError(
            f"{source}: hardpoint {name}{OF_SIDE[side]} is more than {FARTHEST / 1000:g} m away; "
            "expected coordinates in mm. Check its unit."
        )


def _check_apart(axle: Axle, names: tuple[str, str], side: str, why: str, source: str) -> None:
    first, second = names
    gap = float(np.linalg.norm(point(axle, first, side) - point(axle, second, side)))
    if gap < MIN_DISTANCE:
        raise InputError(
            f"{source}: hardpoints {first} and {second}{OF_SIDE[side]} are {gap:.3g} mm apart, "
            f"so {why}; expected at least {MIN_DISTANCE:g} mm. Check their coordinates."
        )


def _check_wheel_centre(axle: Axle, side: str, source: str) -> None:
    if point(axle, "WLC", side)[1] > -MIN_DISTANCE:
        raise InputError(
            f"{source}: WLC{OF_SIDE[side]} lies in the middle of the car; expected y < 0, in mm."
        )
    if point(axle, "WLC", side)[2] <= 0:
        raise InputError(
            f"{source}: WLC.z{OF_SIDE[side]} is not above the ground (z = 0); expected mm, z upwards."
        )
