"""From loops to curves on the load case's own input grid: branches, mean, half-width."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from doe_kc.curves import TYRE_LOAD, CaseCurves
from doe_kc.ground.typing import FloatArray
from doe_kc.load_cases import LoadCase
from doe_kc.measurement.loops import Loop, single_branch, split_loop
from doe_kc.measurement.records import RigRecord
from doe_kc.measurement.smoothing import local_weights

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
