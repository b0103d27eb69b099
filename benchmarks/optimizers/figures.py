"""Figures of runs: evaluations to a level, medians and worst over seeds."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence

import numpy as np
from optimizers.running import Result

from doe_kc.ground.typing import FloatArray

LEVELS = (0.1, 0.01, 0.001)
OURS = {
    "ego": "`ego` as shipped, which also sees the exact slopes of the solver",
    "ego_values": "`ego` with `gradients = false`, which sees what its peers see",
}
"""Rows that the peers are held against, with what to know of them."""


def best_so_far(result: Result) -> FloatArray:
    """(n,) smallest deviation so far over the start's."""
    return np.minimum.accumulate(result.deviation) / result.deviation[0]


def first(flags: Iterable[bool]) -> float:
    """Number of evaluations until the first true flag, inf without one."""
    return next((float(i) for i, flag in enumerate(flags, 1) if flag), math.inf)


def to_level(level: float) -> Callable[[Result], float]:
    """Evaluations until the deviation has fallen to this share of the start's."""
    return lambda result: first(x <= level for x in best_so_far(result))


def to_feasible(result: Result) -> float:
    """Evaluations until all constraints are met."""
    return first(result.feasible)


def to_rating(wanted: float) -> Callable[[Result], float]:
    """Evaluations until a rating as good as this."""
    return lambda result: first(x >= wanted for x in result.rating)


def median(runs: Sequence[Result], figure: Callable[[Result], float]) -> float:
    """Over the seeds; of an even number the upper one, so that a run without success counts as worst."""
    return sorted(figure(r) for r in runs)[len(runs) // 2]


def worst(runs: Sequence[Result], figure: Callable[[Result], float]) -> float:
    """Over the seeds."""
    return max(figure(r) for r in runs)


def used(runs: Sequence[Result]) -> int:
    """Most evaluations of a run."""
    return max(len(r.rating) for r in runs)


def best_rating(runs: Sequence[Result], within: int) -> float:
    """Median over the seeds of the best rating within so many evaluations."""
    return float(np.median([max(r.rating[:within]) for r in runs]))
