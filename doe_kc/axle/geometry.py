"""Checks that an axle can exist before the solver meets it."""

from __future__ import annotations

import numpy as np

from doe_kc.axle.model import EXTRA_HARDPOINTS, HARDPOINTS, Axle
from doe_kc.axle.structure import Structure, of_side
from doe_kc.ground.errors import InputError
from doe_kc.ground.typing import FloatArray

MIN_DISTANCE = 1.0
"""mm; joints closer than this are the same point for every practical purpose."""

FARTHEST = 1e5
"""mm; no car is 100 m long: such a coordinate is in another unit."""

BAR_ENDS = (
    ("LWD", "UPB", "the strut axis has no length"),
    ("RIB", "ROB", "the tie rod has no length"),
    ("LWS", "UPS", "the spring has no length"),
    ("SAH", "ROB", "the steer arm has no length"),
    ("UPBBI", "UPB", "the top-mount axis has no direction"),
    ("LLF", "LLR", "the lower arm has no pivot axis"),
    ("LLF", "LWB", "the lower arm has no length"),
    ("LLR", "LWB", "the lower arm has no length"),
    ("SFF", "SFR", "the sub-frame mounts coincide"),
    ("LWB", "UPB", "the kingpin axis has no length"),
)


def point(axle: Axle, name: str, side: str = "L") -> FloatArray:
    """(3,) hardpoint of a side in left-hand coordinates, mm; side empty: of a single one, as it is."""
    return np.array([axle.values[of_side(f"{name}.{axis}", side)] for axis in "xyz"])


def check_geometry(axle: Axle, source: str) -> None:
    """InputError for a geometry that no car has: coincident points, wrong side, wheel in the ground."""
    structure = axle.topology.structure
    if structure is not None:
        check_structure_geometry(axle, structure, source)
        return
    for side, word in (("L", "left"), ("R", "right")):
        for name in (*HARDPOINTS, *EXTRA_HARDPOINTS):
            _check_near(axle, name, side, source)
        for first, second, why in BAR_ENDS:
            _check_apart(axle, (first, second), side, why, source)
        for name in HARDPOINTS:
            if point(axle, name, side)[1] >= 0:
                raise InputError(
                    f"{source}: hardpoint {name} of the {word} side lies on the other side of the car; "
                    "expected y < 0 on the left (y to the right, in mm). Check its sign."
                )
        _check_wheel_centre(axle, side, source)
        if point(axle, "UPB", side)[2] <= point(axle, "LWD", side)[2]:
            raise InputError(
                f"{source}: UPB of the {word} side lies below LWD; the strut must point upwards."
            )
        if point(axle, "UPBBI", side)[2] <= point(axle, "UPB", side)[2]:
            raise InputError(
                f"{source}: UPBBI of the {word} side lies below UPB; the top-mount axis must point upwards."
            )


OF_SIDE = {"L": " of the left side", "R": " of the right side", "": ""}


def check_structure_geometry(axle: Axle, structure: Structure, source: str) -> None:
    """InputError for a geometry that no car of the type has."""
    for name in structure.single_points:
        _check_near(axle, name, "", source)
    for side in "LR":
        for name in structure.points:
            _check_near(axle, name, side, source)
            if point(axle, name, side)[1] > 0:
                raise InputError(
                    f"{source}: hardpoint {name}{OF_SIDE[side]} lies on the other side of the car; "
                    "expected y <= 0 on the left (y to the right, in mm). Check its sign."
                )
        if point(axle, "WLC", side)[1] > -MIN_DISTANCE:
            raise InputError(
                f"{source}: WLC{OF_SIDE[side]} lies in the middle of the car; expected y < 0, in mm."
            )
        _check_wheel_centre(axle, side, source)
    for line in (*structure.rods, *structure.cylindricals, *structure.springs, structure.damper):
        for side in structure.sides(single=line.single) if line is not None else ():
            assert line is not None
            _check_apart(axle, (line.at_a, line.at_b), side, f"{line.name} has no length", source)
    for bush in structure.bushings:
        for side in structure.sides(single=bush.single) if bush.line is not None else ():
            assert bush.line is not None
            _check_apart(axle, bush.line, side, f"the axes of {bush.name} have no direction", source)
    if (pin := structure.kingpin) is not None:
        for side in "LR":
            _check_apart(axle, (pin.lower, pin.upper), side, "the kingpin axis has no length", source)


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
    if point(axle, "WLC", side)[2] <= 0:
        raise InputError(
            f"{source}: WLC.z{OF_SIDE[side]} is not above the ground (z = 0); expected mm, z upwards."
        )
