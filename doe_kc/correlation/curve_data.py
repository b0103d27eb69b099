"""The curves of the records as data with their errors: mean curves and half-widths of the loops."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Literal

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import NDArray
from scipy.linalg import cholesky, solve_triangular
from scipy.linalg.lapack import dtrtrs

from doe_kc.axle.model import Axle
from doe_kc.curves import TYRE_LOAD, CaseCurves, CurveSet
from doe_kc.ground.typing import FloatArray
from doe_kc.measurement import Measurement
from doe_kc.solver.curve_gradient import CurveGradients, interpolated
from doe_kc.targets.build import reached

SOLVER_FLOOR = 1e-3
"""Share of the white-noise variance added to every point: rounding of files and solver."""
CALIBRATION = 0.002
"""Share of a sensor's reading that its calibration leaves open: repeats cannot show it, as it is in all."""
RIG_HYSTERESIS = 0.3
"""Share of a sensor's white noise that the rig's own friction and backlash may open a loop by."""
MEDIAN_WINDOW = 7
"""Second differences of which the median is the curve's own."""

Branches = Literal["mean", "half_width"]
SystematicError = Literal["hysteresis", "calibration"]
"""Of the rig and of a sensor."""


@dataclass(frozen=True)
class CurveData:
    """One measured curve of one side: the mean of both branches of its loop, or their half-width.

    input, value: (n,). root: (n, n) lower Cholesky factor of its error covariance. systematic: (n,) errors
    that are the same in all repeats, parts of that covariance.
    """

    load_case: str
    response: str
    side: int
    input: FloatArray
    value: FloatArray
    root: FloatArray
    branches: Branches = "mean"
    systematic: Mapping[SystematicError, FloatArray] = field(default_factory=dict)

    @property
    def size(self) -> int:
        """Number of points."""
        return int(self.input.size)

    @property
    def level(self) -> FloatArray:
        """(n,) standard deviation of each point."""
        return np.asarray(np.linalg.norm(self.root, axis=1))

    def whitened(self, rows: FloatArray) -> FloatArray:
        """L^-1 rows for (n,) or (n, p)."""
        return np.asarray(solve_triangular(self.root, rows, lower=True, check_finite=False))


@dataclass(frozen=True)
class CurveGroup:
    """k consecutive curves of one load case at the same n inputs, whitened together."""

    curves: tuple[CurveData, ...]
    """(k,) mean curves, or half-width curves."""
    place: slice
    """Of their k n data in the residual."""

    @property
    def first(self) -> CurveData:
        """The first curve, whose load case, inputs and branches are those of all."""
        return self.curves[0]

    @property
    def places(self) -> list[slice]:
        """(k,) of each curve's data in the residual."""
        n, start = self.first.size, self.place.start
        return [slice(start + i * n, start + (i + 1) * n) for i in range(len(self.curves))]

    @cached_property
    def inverses(self) -> FloatArray:
        """(k, n, n) L^-1 of each curve, kept: curves are whitened hundreds of times.

        By LAPACK itself: what `solve_triangular` checks takes five times as long as such a small inverse.
        """
        eye = np.eye(self.first.size)
        return np.array([dtrtrs(c.root.T, eye, lower=0, trans=1)[0] for c in self.curves])

    @cached_property
    def values(self) -> FloatArray:
        """(k, n) what was measured."""
        return np.array([c.value for c in self.curves])

    def whitened(self, rows: FloatArray) -> FloatArray:
        """(k n, p) of rows (k, n, p)."""
        return np.asarray((self.inverses @ rows).reshape(-1, rows.shape[-1]))

    def model(self, curves: CurveSet) -> FloatArray:
        """(k, n) values of a model at the inputs."""
        case = curves.cases[self.first.load_case]
        branches = case.mean if self.first.branches == "mean" else case.half_width
        values = np.array([branches[c.response][c.side] for c in self.curves])
        return _interpolated_rows(self.first.input, case.input, values)

    def slopes(self, gradients: CurveGradients) -> FloatArray:
        """(k, n, p) derivatives of a model at the inputs; of loops nothing where no friction makes any."""
        case, n = self.first.load_case, self.first.size
        if self.first.branches == "half_width" and case not in gradients.half_width:
            return np.zeros((len(self.curves), n, len(gradients.paths)))
        every = gradients.cases if self.first.branches == "mean" else gradients.half_width
        rows = np.array([every[case][c.response][c.side] for c in self.curves])
        return interpolated(self.first.input, gradients.inputs[case], rows)


def mean_curve_data(axle: Axle, measurement: Measurement, calibration: float = 0.0) -> Iterator[CurveData]:
    """Mean curves of either side, (n,) in the responses' units, within the sweeps of the model.

    At input 0 only the tyre load is a datum: the others are changes from there. Errors are those of the
    repeats, of rounding and of corners. calibration: share of the readings that the sensors' calibration
    leaves open. KeyError for a curve without noise.
    """
    for case in measurement.curves.cases.values():
        inside = reached(axle, case)
        for response in case.mean:
            keep = inside if response == TYRE_LOAD else inside & (np.abs(case.input) > 1e-9)
            if not keep.any():
                continue
            noise = measurement.noise[case.load_case][response]
            for side in (0, 1):
                value = case.mean[response][side]
                extra = SOLVER_FLOOR * noise.white**2 + corner_error(value, noise.point_sd(side)) ** 2
                covariance = noise.covariance(side=side) + np.diag(np.broadcast_to(extra, value.shape))
                systematic: dict[SystematicError, FloatArray] = {}
                if calibration:
                    systematic["calibration"] = calibration * noise.signal[side]
                yield _curve_data(case, response, side, value, keep, covariance, "mean", systematic)


def half_width_data(axle: Axle, measurement: Measurement) -> Iterator[CurveData]:
    """Half-widths of the loops of either side, (n,) in the responses' units, within the sweeps of the model.

    Of the inside of the loops, not of their ends, where both branches meet; none of a record of one branch.
    Errors are those of the repeats, of rounding and of corners, of the sensors' calibration and of the rig's
    own hysteresis. KeyError for a curve without noise.
    """
    for case in measurement.curves.cases.values():
        keep = reached(axle, case)
        keep[np.flatnonzero(keep)[:1]] = keep[np.flatnonzero(keep)[-1:]] = False
        if not keep.any():
            continue
        for response in case.mean:
            noise = measurement.noise[case.load_case][response]
            floor = SOLVER_FLOOR * noise.white**2
            for side in (0, 1):
                value = np.asarray(case.half_width[response][side])
                if not np.isfinite(value).all():  # a record of one branch: its loop is unknown
                    continue
                gain = noise.components.gain / np.sqrt(noise.runs) * value
                covariance = noise.half_width_covariance(side=side) + np.outer(gain, gain)
                covariance += np.diag(corner_error(value, noise.point_sd(side)) ** 2 + floor)
                parabola = 1.0 - (case.input / np.abs(case.input).max()) ** 2
                hysteresis = RIG_HYSTERESIS * noise.white * parabola
                systematic: dict[SystematicError, FloatArray] = {
                    "calibration": CALIBRATION * value,
                    "hysteresis": hysteresis,
                }
                yield _curve_data(case, response, side, value, keep, covariance, "half_width", systematic)


def _curve_data(
    case: CaseCurves,
    response: str,
    side: int,
    value: FloatArray,
    keep: NDArray[np.bool_],
    covariance: FloatArray,
    branches: Branches,
    systematic: Mapping[SystematicError, FloatArray],
) -> CurveData:
    """keep: (n,) the points that are data. covariance: (n, n) of the errors that repeats show."""
    parts = {kind: error[keep] for kind, error in systematic.items()}
    total = covariance[np.ix_(keep, keep)] + sum(np.outer(error, error) for error in parts.values())
    root = cholesky(total, lower=True)
    return CurveData(case.load_case, response, side, case.input[keep], value[keep], root, branches, parts)


def corner_error(curve: FloatArray, sd: FloatArray) -> FloatArray:
    """(n,) error of a reduced curve next to a corner, as where a stop touches or free play is taken up.

    The kernel of the reduction rounds a bend of slope change c by up to c h / 8, h the spacing, and a jump by
    about half of itself. c h is the second difference beyond that of the curve around it, taken where it
    exceeds four times its noise; a jump is two of opposite sign next to each other. Their error is granted
    to the neighbours too. sd: (n,) of the curve's white noise.
    """
    if curve.size < 3:
        return np.zeros(curve.size)
    second = np.diff(curve, 2)
    bend = np.zeros(curve.size)
    around = np.pad(second, MEDIAN_WINDOW // 2, mode="reflect")
    bend[1:-1] = second - np.median(sliding_window_view(around, MEDIAN_WINDOW), axis=1)
    bend[np.abs(bend) < 4.0 * np.sqrt(6.0) * sd] = 0.0
    size = np.abs(bend)
    jump = np.where(bend[:-1] * bend[1:] < 0.0, np.minimum(size[:-1], size[1:]), 0.0)
    beside = np.maximum(np.append(jump, 0.0), np.append(0.0, jump))
    own = size / 8.0 + beside / 2.0
    return np.asarray(sliding_window_view(np.pad(own, 1), 3).max(axis=1))


def _interpolated_rows(at: FloatArray, grid: FloatArray, rows: FloatArray) -> FloatArray:
    """(k, m) rows, (k, n) on a rising grid, at `at`, (m,): each as `np.interp`, to the last bit."""
    cell = np.clip(np.searchsorted(grid, at, side="right") - 1, 0, grid.size - 2)
    low = rows[:, cell]
    slope = (rows[:, cell + 1] - low) / (grid[cell + 1] - grid[cell])
    out = slope * (np.maximum(at, grid[0]) - grid[cell]) + low
    out[:, at >= grid[-1]] = rows[:, -1:]
    return np.asarray(out)
