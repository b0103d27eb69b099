"""Whether several measured cars went through one test: only then have they a mean."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations
from pathlib import Path

import numpy as np

from doe_kc.ground.errors import InputError
from doe_kc.measurement.branches import RunCurves
from doe_kc.measurement.manifest import Alignment, Manifest, SideAlignment

SAME_LOAD = 0.05
"""Share by which the wheel loads of cars of one design and loading may differ: fuel, equipment."""
SAME_SETTING = 1e-3
"""Share by which a setting of the rig may differ: rounding."""


@dataclass(frozen=True)
class TestedCar:
    """path: of its `test.toml`. runs: load case -> reduced runs, main run first."""

    path: Path
    manifest: Manifest
    runs: Mapping[str, tuple[RunCurves, ...]]


def refuse_unlike(cars: Sequence[TestedCar]) -> None:
    """InputError for the first car whose test is not that of the first car, or that is the same car again."""
    for one, other in combinations(cars, 2):
        _refuse_same(one, other)
    for other in cars[1:]:
        _check_conditions(cars[0], other)
        _check_alignment(cars[0], other)
        for case, runs in cars[0].runs.items():
            _check_record(runs[0], other.runs[case][0])


def _refuse_same(one: TestedCar, other: TestedCar) -> None:
    """A car named twice would pass for cars without scatter."""
    if one.path.resolve() == other.path.resolve():
        raise InputError(f"{other.path}: is named twice as a measured car; name each car once.")
    for case in one.runs.keys() & other.runs.keys():
        a, b = one.runs[case][0].record, other.runs[case][0].record
        same = a.input.shape == b.input.shape and np.array_equal(a.input, b.input)
        if same and all(np.array_equal(a.channels[r], b.channels[r]) for r in a.channels.keys() & b.channels):
            raise InputError(
                f"{b.label}: holds the same samples as {a.label}; expected records of another car, name each "
                "car once."
            )


def _check_conditions(first: TestedCar, other: TestedCar) -> None:
    ours, theirs = set(first.manifest.records), set(other.manifest.records)
    if ours != theirs:
        more = other.path if theirs - ours else first.path
        raise InputError(
            f"{other.path}: [records] holds {', '.join(other.manifest.records)}, that of {first.path} "
            f"{', '.join(first.manifest.records)}; expected the same load cases of every car: take "
            f"{', '.join(sorted((theirs - ours) or (ours - theirs)))} out of {more}, or record it."
        )
    if first.manifest.state.arb != other.manifest.state.arb:
        raise InputError(
            f"{other.path}: the anti-roll bar was {other.manifest.state.arb}, in {first.path} it was "
            f"{first.manifest.state.arb}; expected one state of all cars, leave one of them out."
        )
    one, two = first.manifest.setup, other.manifest.setup
    for key, share in (
        ("lateral_offset_mm", SAME_SETTING),
        ("rack_mm_per_rev", SAME_SETTING),
        ("reference_wheel_load_N", SAME_LOAD),
    ):
        a, b = getattr(one, key), getattr(two, key)
        if a is not None and b is not None and abs(a - b) > share * max(abs(a), abs(b)):
            raise InputError(
                f"{other.path}: setup.{key} is {b:g}, that of {first.path} {a:g}; expected one test of all "
                "cars, correct the entry or leave one of them out."
            )


def _check_alignment(first: TestedCar, other: TestedCar) -> None:
    ours, theirs = known_angles(first.manifest.alignment), known_angles(other.manifest.alignment)
    if ours != theirs:
        raise InputError(
            f"{other.path}: [alignment] holds {_list(theirs)}, that of {first.path} {_list(ours)}; expected "
            "the same angles of every car, add the missing ones or drop them from all."
        )


def known_angles(alignment: Alignment | None) -> tuple[str, ...]:
    """Keys as `left.toe_deg` of the angles that the bench gave."""
    if alignment is None:
        return ()
    sides: dict[str, SideAlignment | None] = {"left": alignment.left, "right": alignment.right}
    return tuple(
        f"{side}.{key}"
        for side, angles in sides.items()
        if angles is not None
        for key in SideAlignment.model_fields
        if getattr(angles, key) is not None
    )


def _list(names: Sequence[str]) -> str:
    return ", ".join(names) or "nothing"


def _check_record(one: RunCurves, other: RunCurves) -> None:
    a, b = one.record, other.record
    if type(a.case) is not type(b.case):
        raise InputError(
            f"{b.label}: its input is {b.case.channel}, that of {a.label} {a.case.channel}; expected one "
            "test of all cars, leave one of them out."
        )
    if a.channels.keys() != b.channels.keys():
        unlike = sorted(a.channels.keys() ^ b.channels.keys())
        raise InputError(
            f"{b.label}: does not have the channels of {a.label}: {', '.join(unlike)} is in one of them "
            "only; expected the same of every car, export the missing ones or name them in `absent` of all."
        )
    if set(a.mirrored) != set(b.mirrored):
        raise InputError(
            f"{b.label}: holds {_wheels(b.mirrored)}, {a.label} {_wheels(a.mirrored)}; expected the same "
            "wheels of every car, name the others in `absent` of all."
        )
    if one.one_branch != other.one_branch:
        words = {True: "one branch only", False: "a whole loop"}
        raise InputError(
            f"{b.label}: holds {words[other.one_branch]}, {a.label} {words[one.one_branch]}; expected the "
            "same of every car, record the loop again or leave one of them out."
        )


def _wheels(mirrored: Sequence[str]) -> str:
    return f"no {', '.join(sorted(mirrored))}" if mirrored else "both wheels"
