"""Targets and constraints that a study types, checked against each other and the records."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fnmatch import fnmatchcase

from doe_kc.characteristics import CHARACTERISTICS, Characteristic, reduce_one
from doe_kc.curves import CurveSet
from doe_kc.measurement import Manifest
from doe_kc.study import Study
from doe_kc.targets.build import first, last
from doe_kc.targets.comparison.interval import constraint_interval


@dataclass(frozen=True)
class StatedInterval:
    """A constraint of which the study types an end, the other end that of equations 5.1 and 5.2; nan where
    there is no target to take it from. aimed: whether the rating counts the distance to the target."""

    entry: Characteristic
    target: float
    low: float
    high: float
    aimed: bool

    @property
    def words(self) -> str:
        return f"[{self.low:g}, {self.high:g}] {self.entry.unit}"


def stated_intervals(study: Study, curves: CurveSet | None) -> Iterator[StatedInterval]:
    """About typed targets, else about those measured."""
    for ident, entry in CHARACTERISTICS.items():
        own = [o for o in study.characteristics if fnmatchcase(ident, o.match)]
        if last(own, "low") is None and last(own, "high") is None:
            continue
        target = last(own, "target")
        if target is None and curves is not None:
            target = reduce_one(entry, curves, window=study.windows.get(entry.load_case))
        implied = constraint_interval(first(target, math.nan))
        yield StatedInterval(
            entry,
            first(target, math.nan),
            first(last(own, "low"), implied[0]),
            first(last(own, "high"), implied[1]),
            first(last(own, "objective"), entry.objective) and first(last(own, "goal"), "target") == "target",
        )


def empty_intervals(study: Study, intervals: Sequence[StatedInterval]) -> Iterator[str]:
    """Intervals whose low is not below high."""
    for interval in intervals:
        if interval.low >= interval.high:
            yield (
                f"{study.source}: characteristics {interval.entry.id}: the interval {interval.words} is "
                "empty; low must be below high."
            )


def missed_targets(study: Study, intervals: Sequence[StatedInterval]) -> Iterator[str]:
    """Targets that their own interval excludes: a correlation ends between the two."""
    for interval in intervals:
        low, high, target = interval.low, interval.high, interval.target
        if interval.aimed and low < high and (target < low or target > high):
            yield (
                f"{study.source}: characteristics {interval.entry.id}: the interval {interval.words} does "
                f"not hold the target {target:g}, so that no design meets both; correct low and high, or "
                "give objective = false."
            )


def aimless_constraints(study: Study, manifest: Manifest | None) -> Iterator[str]:
    """Constraints of which nothing that they match is measured or typed."""
    cases = {"static", *(manifest.records if manifest is not None else ())}
    for option in study.characteristics:
        stated = option.constraint or option.low is not None or option.high is not None
        matched = [e for i, e in CHARACTERISTICS.items() if fnmatchcase(i, option.match)]
        typed = any(
            o.target is not None and any(fnmatchcase(e.id, o.match) for e in matched)
            for o in study.characteristics
        )
        if stated and not typed and not any(e.load_case in cases for e in matched):
            yield (
                f"{study.source}: characteristics: match = {option.match!r} states a constraint, but no "
                "record is of its load case and no target is given; add target = VALUE or the record, or "
                "drop the entry."
            )
