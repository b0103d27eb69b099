"""Checks that an axle can exist before the solver meets it."""

from __future__ import annotations

import numpy as np

from doe_kc.axle.model import EXTRA_HARDPOINTS, HARDPOINTS, Axle
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
    """(3,) hardpoint of a side in left-hand coordinates, mm."""
    return np.array([axle.values[f"{name}.{axis}@{side}"] for axis in "xyz"])


def check_geometry(axle: Axle, source: str) -> None:
    """InputError for a geometry that no car has: coincident points, wrong side, wheel in the ground."""
    for side, word in (("L", "left"), ("R", "right")):
        for name in (*HARDPOINTS, *EXTRA_HARDPOINTS):
            if np.abs(point(axle, name, side)).max() > FARTHEST:
                raise InputError(
                    f"{source}: hardpoint {name} of the {word} side is more than {FARTHEST / 1000:g} m away; "
                    "expected coordinates in mm. Check its unit."
                )
        for first, second, why in BAR_ENDS:
            gap = float(np.linalg.norm(point(axle, first, side) - point(axle, second, side)))
            if gap < MIN_DISTANCE:
                raise InputError(
                    f"{source}: hardpoints {first} and {second} of the {word} side are {gap:.3g} mm apart, "
                    f"so {why}; expected at least {MIN_DISTANCE:g} mm. Check their coordinates."
                )
        for name in HARDPOINTS:
            if point(axle, name, side)[1] >= 0:
                raise InputError(
                    f"{source}: hardpoint {name} of the {word} side lies on the other side of the car; "
                    "expected y < 0 on the left (y to the right, in mm). Check its sign."
                )
        if point(axle, "WLC", side)[2] <= 0:
            raise InputError(
                f"{source}: WLC.z of the {word} side is not above the ground (z = 0); expected mm, z upwards."
            )
        if point(axle, "UPB", side)[2] <= point(axle, "LWD", side)[2]:
            raise InputError(
                f"{source}: UPB of the {word} side lies below LWD; the strut must point upwards."
            )
        if point(axle, "UPBBI", side)[2] <= point(axle, "UPB", side)[2]:
            raise InputError(
                f"{source}: UPBBI of the {word} side lies below UPB; the top-mount axis must point upwards."
            )
