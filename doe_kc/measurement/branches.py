"""From loops to curves: the branches of a steady loop, smoothed, on the load case's own input grid."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from doe_kc.curves import TYRE_LOAD, CaseCurves
from doe_kc.ground.errors import InputError
from doe_kc.ground.typing import FloatArray
from doe_kc.load_cases import LoadCase
from doe_kc.measurement.noise import white_sd
from doe_kc.measurement.records import RigRecord

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
    samples = values.tolist()  # one by one, numbers of Python are faster than those of an array
    for i, value in enumerate(samples):
        high = i if value > samples[high] else high
        low = i if value < samples[low] else low
        if way >= 0 and samples[high] - value > threshold:
            points.append(high)
            way, low = -1, i
        elif way <= 0 and value - samples[low] > threshold:
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


DEGREE = 2
"""Of the local polynomial: a line would flatten the curvature at a bump stop's contact, a cubic lets more
noise through for a bias that is small already."""
MIN_NEIGHBOURS = 7
"""Samples under the kernel at least: two for each unknown of the quadratic, and one."""


def local_weights(samples: FloatArray, grid: FloatArray, half_width: float) -> FloatArray:
    """(n, m) matrix S with S y = local quadratic fit to the samples (x, y), read at the n grid inputs.

    samples: (m,) inputs x in any order; grid: (n,); half_width: support of the tricube kernel, input
    unit, widened where it holds fewer than 7 samples. Exact on quadratics, for interior points on cubics
    too: no bias up to third order, and kinks are rounded over one half-width only.
    A rank-deficient neighbourhood takes the pseudo-inverse.
    Source: Cleveland, JASA 74 (1979) 829; Fan & Gijbels, Local Polynomial Modelling (1996).
    """
    distance = samples[None, :] - grid[:, None]
    nearest = np.sort(np.abs(distance), axis=1)[:, min(MIN_NEIGHBOURS, samples.size) - 1]
    width = np.maximum(half_width, 1.05 * nearest)[:, None]
    scaled = distance / width
    size = np.minimum(np.abs(scaled), 1.0)
    inside = 1.0 - size * size * size
    weighted = [inside * inside * inside]
    while len(weighted) <= 2 * DEGREE:
        weighted.append(weighted[-1] * scaled)
    sums = np.array([w.sum(axis=1) for w in weighted])
    order = np.arange(DEGREE + 1)
    moments = sums[order[:, None] + order].transpose(2, 0, 1)
    first = np.linalg.pinv(moments, hermitian=True)[:, 0, :]
    return np.asarray(sum(first[:, i, None] * weighted[i] for i in order))


AMPLITUDE_SHARE = 0.99
"""The grid is kept whole when the rig reaches this fraction of its amplitude on both sides."""
KERNEL_STEPS = 1.5
"""Half-width of the smoothing kernel in steps of the grid: no detail coarser than the grid is lost."""


@dataclass(frozen=True)
class RunCurves:
    """One run on the grid. A record of one branch has it as both: its loop is unknown, its half-width nan.

    input: (n,) grid. unload, load: response -> (2, n), input falling and rising, as recorded.
    gram: (n, n), covariance of the run's mean curve per unit variance of a sample's white noise.
    """

    record: RigRecord
    loop: Loop
    input: FloatArray
    unload: Mapping[str, FloatArray]
    load: Mapping[str, FloatArray]
    gram: FloatArray

    def mean(self, response: str) -> FloatArray:
        """(2, n) mean of the two branches, as recorded (not yet a change from static)."""
        return (self.unload[response] + self.load[response]) / 2.0

    def half_width(self, response: str) -> FloatArray:
        """(2, n) (falling - rising) / 2."""
        if self.one_branch:
            return np.full_like(self.load[response], np.nan)
        return (self.unload[response] - self.load[response]) / 2.0

    @property
    def one_branch(self) -> bool:
        """Whether the record runs through its range once only."""
        return self.loop.unload is self.loop.load


def input_grid(case: LoadCase, records: Sequence[RigRecord]) -> FloatArray:
    """(n,) inputs of the load case that every run reaches; all of them from 99 % of the amplitude on."""
    high = min(float(r.input.max()) for r in records)
    low = max(float(r.input.min()) for r in records)
    grid = case.inputs()
    if min(high, -low) >= AMPLITUDE_SHARE * case.amplitude:
        return grid
    slack = 1e-3 * case.amplitude
    kept: FloatArray = grid[(grid <= high + slack) & (grid >= low - slack)]
    return kept


def reduce_run(record: RigRecord, grid: FloatArray) -> RunCurves:
    """Branches of one record on `grid` by local quadratic regression (see `smoothing`).

    Raises InputError when the record holds neither a full loop nor one branch of it.
    """
    branch = single_branch(record.input)
    loop = split_loop(record.input, label=record.label) if branch is None else Loop(branch, branch)
    width = KERNEL_STEPS * float(np.diff(grid).max())
    falling = local_weights(record.input[loop.unload], grid, width)
    rising = local_weights(record.input[loop.load], grid, width)
    return RunCurves(
        record=record,
        loop=loop,
        input=grid,
        unload={r: c[:, loop.unload] @ falling.T for r, c in record.channels.items()},
        load={r: c[:, loop.load] @ rising.T for r, c in record.channels.items()},
        gram=falling @ falling.T if branch is not None else (falling @ falling.T + rising @ rising.T) / 4.0,
    )


def reduce_case(records: Sequence[RigRecord]) -> tuple[RunCurves, ...]:
    """All runs of one load case on their common grid, main run first."""
    grid = input_grid(records[0].case, records)
    return tuple(reduce_run(record, grid) for record in records)


def static_index(grid: FloatArray) -> int:
    """Index of the static state, input 0."""
    return int(np.argmin(np.abs(grid)))


def changes(response: str, curve: FloatArray, grid: FloatArray) -> FloatArray:
    """(2, n) change from the curve's own value at input 0; tyre load is left absolute."""
    if response == TYRE_LOAD:
        return curve
    at = static_index(grid)
    return curve - curve[:, at : at + 1]


def case_curves(load_case: str, runs: Sequence[RunCurves]) -> CaseCurves:
    """Mean and half-width curves averaged over main run and repeats."""
    grid = runs[0].input
    measured = runs[0].record.channels
    mean = {r: np.mean([run.mean(r) for run in runs], axis=0) for r in measured}
    half = {r: np.mean([run.half_width(r) for run in runs], axis=0) for r in measured}
    return CaseCurves(
        load_case=load_case,
        input_unit=runs[0].record.case.unit,
        input=grid,
        mean={r: changes(r, c, grid) for r, c in mean.items()},
        half_width=half,
    )
