"""The slopes near rest that tell what a channel is."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from doe_kc.curves import RIG_RESPONSES, TYRE_LOAD, CurveSet
from doe_kc.ground.typing import FloatArray
from doe_kc.load_cases import CASE_ORDER, LOAD_CASES
from doe_kc.measurement.branches import RunCurves, static_index
from doe_kc.measurement.checks._base import RigTest
from doe_kc.measurement.checks.repeats import odd_runs

MIRRORED = ("vertical", "lateral_opposite", "drive", "brake")
"""Load cases that are their own mirror image; in the others left at +u is right at -u."""
_ROW = {case: i for i, case in enumerate(CASE_ORDER)}
_COLUMN = {response: i for i, response in enumerate(RIG_RESPONSES)}
COUNTER_PHASE_DEG = 13.8
"""Pad travel in mm of a counter-phase roll that rolls the wheels like 1 deg of the body, half track 790
mm."""


@dataclass(frozen=True)
class SlopeTable:
    """slope: (8, 7, 2) by `CASE_ORDER`, `RIG_RESPONSES`, left and right; response per input unit, nan where
    there is no record. rest: (8, 2) tyre load at rest, N. noise: (8, 7, 2) white noise of the channel.
    """

    slope: FloatArray
    rest: FloatArray
    noise: FloatArray

    def batch(self) -> SlopeTable:
        """With a leading axis of one."""
        return SlopeTable(self.slope[None], self.rest[None], self.noise[None])

    def member(self, index: int) -> SlopeTable:
        """Of a batch."""
        return SlopeTable(self.slope[index], self.rest[index], self.noise[index])


def row(case: str) -> int:
    """Of a load case."""
    return _ROW[case]


def column(response: str) -> int:
    """Of a response."""
    return _COLUMN[response]


def mirror_signs() -> FloatArray:
    """(8, 7) p with right slope = p * left slope on an axle with equal sides."""
    out = np.array([[1.0 if case in MIRRORED else -1.0] * len(RIG_RESPONSES) for case in CASE_ORDER])
    out[:, column("wc_y")] *= -1.0
    return out


@lru_cache(maxsize=2)
def measured_slopes(test: RigTest) -> SlopeTable:
    """Medians over the runs that agree with each other."""
    shape = (len(CASE_ORDER), len(RIG_RESPONSES), 2)
    slope, noise, rest = np.full(shape, np.nan), np.full(shape, np.nan), np.full((shape[0], 2), np.nan)
    for case, runs in test.runs.items():
        odd = odd_runs(test, case)
        kept = [run for k, run in enumerate(runs) if k not in odd] or list(runs)
        for response in kept[0].record.channels:
            at = row(case), column(response)
            slope[at] = _run_slopes(kept, response)
            levels = np.array([run.record.white[response] for run in kept])
            noise[at] = np.sqrt(np.mean(levels**2, axis=0))
        if TYRE_LOAD in kept[0].record.channels:
            loads = [run.mean(TYRE_LOAD)[:, static_index(run.input)] for run in kept]
            rest[row(case)] = np.median(loads, axis=0)
    return SlopeTable(slope, rest, noise)


def model_slopes(curves: CurveSet | None) -> FloatArray:
    """(8, 7, 2) by `CASE_ORDER`, `RIG_RESPONSES`, left and right; nan where the model has no such curve."""
    out = np.full((len(CASE_ORDER), len(RIG_RESPONSES), 2), np.nan)
    for case in [] if curves is None else curves.cases.values():
        factor = COUNTER_PHASE_DEG if case.load_case == "roll" and case.input_unit == "mm" else 1.0
        near = np.abs(case.input) <= LOAD_CASES[case.load_case].window * factor * 1.001
        for response in RIG_RESPONSES:
            if response in case.mean and near.sum() > 1:
                line = _line_slope(case.input[near], case.mean[response][:, near])
                out[row(case.load_case), column(response)] = line * factor
    return out


def _run_slopes(runs: Sequence[RunCurves], response: str) -> FloatArray:
    grid = runs[0].input
    case = runs[0].record.case
    near = np.abs(grid) <= case.window * 1.001
    factor = COUNTER_PHASE_DEG if case.id == "roll" and case.unit == "mm" else 1.0
    if near.sum() < 2:
        return np.full(2, np.nan)
    slopes = [_line_slope(grid[near], run.mean(response)[:, near]) for run in runs]
    return np.asarray(factor * np.median(slopes, axis=0))


def _line_slope(x: FloatArray, y: FloatArray) -> FloatArray:
    """(k,) slopes of the lines through the rows of y (k, n) over x (n,)."""
    dx = x - x.mean()
    return np.asarray(y @ dx / (dx @ dx))
