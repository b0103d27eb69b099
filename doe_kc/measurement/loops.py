"""Split a steady loop into its falling-input and rising-input branch."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from doe_kc.ground.errors import InputError
from doe_kc.ground.typing import FloatArray
from doe_kc.measurement.white_noise import white_sd

IndexArray = NDArray[np.intp]

REVERSAL = 0.05
"""Largest reversal inside a branch, fraction of the input's range; more is a turning point."""
BRANCH_GAP = 0.05
"""Fraction of the range that a branch may miss; three steps on coarse loops (end short by one)."""
RIGHT_WAY = 0.95
"""Fraction of steps that must go the branch's way."""
STEPS_PER_BRANCH = 64
"""Steps are counted at this resolution at least, so that noise on slow loops is no reversal."""
NOISE_STEP = 0.01
"""Backward steps within the sensor's noise are none, if that is below this fraction of the range."""


@dataclass(frozen=True)
class Loop:
    """Sample indices of one cycle: `unload` with the input falling, `load` with it rising."""

    unload: IndexArray
    load: IndexArray


def single_branch(values: FloatArray) -> IndexArray | None:
    """Samples of a record that runs through the range once, in one way; None for any other."""
    span = float(np.ptp(values))
    points = turning_points(values, REVERSAL * span)
    ends = [min(points), max(points)] if len(points) == 2 else []
    if not ends or abs(values[ends[1]] - values[ends[0]]) < (1.0 - BRANCH_GAP) * span:
        return None
    return np.arange(ends[0], ends[1] + 1)


def split_loop(values: FloatArray, *, label: str) -> Loop:
    """Branches of the last full cycle of an input (n,), in any phase; InputError when there is none.

    A single cycle may start anywhere: it is closed by its periodicity. label: file for the message.
    """
    span = float(np.ptp(values))
    branches = _one_cycle(values, span) or _last_cycle(values, span)
    if branches is None:
        raise InputError(_why_not(values, span, label))
    _check_monotone(values, branches, label)
    return branches


def turning_points(values: FloatArray, threshold: float) -> list[int]:
    """Indices of alternating extremes that are left by more than `threshold`; the last extreme too."""
    points: list[int] = []
    high = low = 0
    way = 0
    for i, value in enumerate(values):
        high = i if value > values[high] else high
        low = i if value < values[low] else low
        if way >= 0 and values[high] - value > threshold:
            points.append(high)
            way, low = -1, i
        elif way <= 0 and value - values[low] > threshold:
            points.append(low)
            way, high = 1, i
    return [*points, high if way > 0 else low]


def _one_cycle(values: FloatArray, span: float) -> Loop | None:
    """Branches of a record that is one period, begun at its largest input and closed by it."""
    if not _closes(values, span):
        return None
    order = np.roll(np.arange(values.size), -int(np.argmax(values)))
    order = np.append(order, order[0])
    points = turning_points(values[order], REVERSAL * span)
    if len(points) != 3:
        return None
    return Loop(order[: points[1] + 1], order[points[1] :])


def _last_cycle(values: FloatArray, span: float) -> Loop | None:
    """The last two neighbouring segments that each cover the range."""
    points = turning_points(values, REVERSAL * span)
    segments = list(pairwise(points))
    enough = (1.0 - max(BRANCH_GAP, 6.0 / values.size)) * span
    full = [abs(values[b] - values[a]) >= enough for a, b in segments]
    for i in range(len(segments) - 2, -1, -1):
        if full[i] and full[i + 1]:
            first, second = (np.arange(a, b + 1) for a, b in segments[i : i + 2])
            falling = values[first[-1]] < values[first[0]]
            return Loop(first, second) if falling else Loop(second, first)
    return None


def _closes(values: FloatArray, span: float) -> bool:
    """Whether the record is one whole period: the step from last to first sample is like the others."""
    step = 2.0 * span / values.size
    return bool(abs(values[0] - values[-1]) <= 3.0 * step + 0.01 * span)


def _why_not(values: FloatArray, span: float, label: str) -> str:
    points = turning_points(values, REVERSAL * span)
    low, high = values.min() + 0.1 * span, values.max() - 0.1 * span
    inner = [i for i in points[1:-1] if low < values[i] < high]
    if inner:
        return (
            f"{label}: the input turns back at sample {inner[0] + 1} (value {values[inner[0]]:g}), so "
            "its branch is not monotone; expected +A -> -A -> +A without reversal, record it again."
        )
    return (
        f"{label}: the input makes no loop, it runs from {values[0]:g} to {values[-1]:g} with "
        f"{max(len(points) - 2, 0)} turning points; expected +A -> -A -> +A, export the whole cycle."
    )


def _check_monotone(values: FloatArray, loop: Loop, label: str) -> None:
    noise = min(4.0 * white_sd(values), NOISE_STEP * float(np.ptp(values)))
    for branch, way, name in ((loop.unload, -1.0, "falling"), (loop.load, 1.0, "rising")):
        stride = max(1, branch.size // STEPS_PER_BRANCH)
        sampled = branch[::stride]
        wrong = way * np.diff(values[sampled]) <= -noise
        if wrong.mean() > 1.0 - RIGHT_WAY:
            at = int(sampled[int(np.flatnonzero(wrong)[0]) + 1])
            raise InputError(
                f"{label}: the {name} branch is not monotone, {100 * wrong.mean():.0f} % of its steps "
                f"go the other way, first at sample {at + 1}; expected at most "
                f"{100 * (1 - RIGHT_WAY):.0f} %, "
                "filter the input channel or record the loop again."
            )
