"""The measured curves as data with their errors: residuals in standard deviations, and their derivatives."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Literal

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from scipy.linalg import cholesky, solve_triangular

from doe_kc.axle.model import Axle
from doe_kc.characteristics import CHARACTERISTICS
from doe_kc.curves import TYRE_LOAD, CurveSet
from doe_kc.ground.typing import FloatArray
from doe_kc.measurement import Measurement
from doe_kc.measurement.reduction import static_sd
from doe_kc.solver.curve_gradient import CurveGradients, interpolated
from doe_kc.targets.build import reached
from doe_kc.targets.target import Targets

SOLVER_FLOOR = 1e-3
"""Share of the white-noise variance added to every point: rounding of files and solver."""
CALIBRATION = 0.002
"""Share of a sensor's reading that its calibration leaves open: repeats cannot show it, as it is in all."""
RIG_HYSTERESIS = 0.3
"""Share of a sensor's white noise that the rig's own friction and backlash may open a loop by."""
MEDIAN_WINDOW = 7
"""Second differences of which the median is the curve's own."""
EXACT_SHARE = 0.05
"""Of Norm: standard deviation taken for a typed target that states none, a third of its interval."""


Branches = Literal["mean", "half_width"]


@dataclass(frozen=True)
class CurveData:
    """One measured curve of one side: the mean of both branches of its loop, or their half-width.

    input, value: (n,). root: (n, n) lower Cholesky factor of its error covariance.
    """

    load_case: str
    response: str
    side: int
    input: FloatArray
    value: FloatArray
    root: FloatArray
    branches: Branches = "mean"

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
        return np.asarray(self._inverse @ rows)

    @cached_property
    def _inverse(self) -> FloatArray:
        """L^-1, kept: curves are whitened hundreds of times."""
        return np.asarray(solve_triangular(self.root, np.eye(self.size), lower=True, check_finite=False))


@dataclass(frozen=True)
class Figure:
    """One scalar datum: a static angle of one side, or a typed target.

    row: the characteristic's place in the registry, -1 for a static angle.
    """

    name: str
    response: str
    side: int
    row: int
    value: float
    sd: float


@dataclass(frozen=True)
class Likelihood:
    """All data of a correlation. Residuals are (model - measured) in units of the errors, (M,)."""

    curves: tuple[CurveData, ...]
    figures: tuple[Figure, ...]

    @cached_property
    def size(self) -> int:
        """M, the number of data."""
        return sum(c.size for c in self.curves) + len(self.figures)

    def residual(self, curves: CurveSet | None, characteristics: FloatArray) -> FloatArray:
        """(M,) whitened residual of a model; KeyError for a load case that it lacks."""
        if curves is None and self.size > sum(f.row >= 0 for f in self.figures):
            raise ValueError("the model gives no curves to compare with the measured ones")
        models = self._models(curves) if curves is not None else []
        parts = [c.whitened(model - c.value) for c, model in zip(self.curves, models, strict=False)]
        scalars = [(_scalar(f, curves, characteristics) - f.value) / f.sd for f in self.figures]
        return np.concatenate([*parts, np.array(scalars)])

    def _models(self, curves: CurveSet) -> list[FloatArray]:
        """The model's values of each curve, (n,), interpolated for all curves of the same inputs at once."""
        out: list[FloatArray] = [np.zeros(0)] * len(self.curves)
        for places in self._same_inputs:
            data = [self.curves[i] for i in places]
            case = curves.cases[data[0].load_case]
            values = np.array([_branch_curves(c, curves)[c.response][c.side] for c in data])
            for i, model in zip(places, _interpolated_rows(data[0].input, case.input, values), strict=True):
                out[i] = model
        return out

    @cached_property
    def _same_inputs(self) -> list[list[int]]:
        """Places of the curves, those of a load case with the same inputs together."""
        places: dict[tuple[str, bytes], list[int]] = {}
        for i, curve in enumerate(self.curves):
            places.setdefault((curve.load_case, curve.input.tobytes()), []).append(i)
        return list(places.values())

    def jacobian(self, gradients: CurveGradients, characteristics: FloatArray) -> FloatArray:
        """(M, p) derivative of the residual. characteristics: (all registered, p) their gradients."""
        parts = [c.whitened(_rows(c, gradients)) for c in self.curves]
        scalars = [_scalar_row(f, gradients, characteristics) / f.sd for f in self.figures]
        tail = np.array(scalars).reshape(len(scalars), len(gradients.paths))
        return np.vstack([*parts, tail])

    def without(self, places: Collection[tuple[str, str]]) -> Likelihood:
        """The data but those of some (load case, response)."""
        kept = tuple(c for c in self.curves if (c.load_case, c.response) not in places)
        figures = tuple(f for f in self.figures if ("static", f.response) not in places or f.row >= 0)
        return Likelihood(kept, figures)

    def slices(self) -> Iterator[tuple[CurveData, slice]]:
        """Each curve with its place in the residual."""
        start = 0
        for curve in self.curves:
            yield curve, slice(start, start + curve.size)
            start += curve.size


def rewhitened(rows: FloatArray, before: Likelihood, after: Likelihood) -> FloatArray:
    """(M, ...) of the same data, from units of one likelihood's errors to those of another."""
    if before is after:
        return rows
    out = rows.copy()
    for (old, place), new in zip(before.slices(), after.curves, strict=True):
        out[place] = new.whitened(old.root @ rows[place])
    return out


def record_likelihood(axle: Axle, measurement: Measurement) -> Likelihood:
    """All that the records say, within the sweeps of the model: both branches of every loop, and statics.

    Errors are those of the repeats and of the sensors' calibration.
    """
    curves = (*_measured(axle, measurement, CALIBRATION), *_half_widths(axle, measurement))
    return Likelihood(curves, tuple(_static(measurement)))


def build_likelihood(
    axle: Axle, measurement: Measurement | None, targets: Targets, *, only_targets: bool = False
) -> Likelihood:
    """Data of the records, within the sweeps of the model, and the targets that were typed in.

    The mean curves of the loops, but those that the study drops. only_targets: curves that are objectives
    only. A typed target replaces the curve that its characteristic is read off.
    """
    measured = {} if measurement is None else measurement.characteristics
    typed = [
        t
        for t in targets.characteristics
        if t.entry.id not in measured or t.value != measured[t.entry.id].value
    ]
    left_out = {(t.entry.load_case, t.entry.response) for t in typed} | targets.dropped
    wanted = {(c.load_case, c.response) for c in targets.curves}
    curves = [
        c
        for c in ([] if measurement is None else _measured(axle, measurement))
        if (c.load_case, c.response) not in left_out
        and (not only_targets or (c.load_case, c.response) in wanted)
    ]
    order = list(CHARACTERISTICS)
    figures = [
        Figure(t.entry.id, t.entry.response, 0, order.index(t.entry.id), t.value, t.sd or _exact_sd(t.value))
        for t in typed
        if t.active
    ]
    static = [] if measurement is None else list(_static(measurement))
    statics = [f for f in static if ("static", f.response) not in left_out]
    return Likelihood(tuple(curves), (*statics, *figures))


def _exact_sd(value: float) -> float:
    return EXACT_SHARE * float(np.sqrt(value**2 + 0.005))


def _measured(axle: Axle, measurement: Measurement, calibration: float = 0.0) -> Iterator[CurveData]:
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
                covariance = noise.covariance(side=side)
                if calibration:
                    signal = calibration * noise.signal[side]
                    covariance = covariance + np.outer(signal, signal)
                covariance += np.diag(np.broadcast_to(extra, value.shape))
                root = cholesky(covariance[np.ix_(keep, keep)], lower=True)
                yield CurveData(
                    case.load_case, response, side, case.input[keep], np.asarray(value[keep]), root
                )


def _half_widths(axle: Axle, measurement: Measurement) -> Iterator[CurveData]:
    """Inside the ends of the loops, where both branches meet."""
    for case in measurement.curves.cases.values():
        keep = reached(axle, case)
        keep[np.flatnonzero(keep)[:1]] = keep[np.flatnonzero(keep)[-1:]] = False
        if not keep.any():
            continue
        for response in case.mean:
            noise = measurement.noise[case.load_case][response]
            floor = SOLVER_FLOOR * noise.white**2 * np.eye(int(keep.sum()))
            for side in (0, 1):
                value = np.asarray(case.half_width[response][side])
                if not np.isfinite(value).all():  # a record of one branch: its loop is unknown
                    continue
                gain = np.hypot(CALIBRATION, noise.components.gain / np.sqrt(noise.runs)) * value
                covariance = noise.half_width_covariance(side=side) + np.outer(gain, gain)
                covariance += np.diag(corner_error(value, noise.point_sd(side)) ** 2)
                own = RIG_HYSTERESIS * noise.white * (1.0 - (case.input / np.abs(case.input).max()) ** 2)
                covariance += np.outer(own, own)
                root = cholesky(covariance[np.ix_(keep, keep)] + floor, lower=True)
                value = value[keep]
                yield CurveData(case.load_case, response, side, case.input[keep], value, root, "half_width")


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


def _static(measurement: Measurement) -> Iterator[Figure]:
    sd = static_sd(measurement.manifest.alignment)
    for response, values in (measurement.curves.static or {}).items():
        for side, value in enumerate(values):
            if np.isfinite(value):
                yield Figure(f"static.{response}", response, side, -1, float(value), sd[response])


def _branch_curves(data: CurveData, curves: CurveSet) -> Mapping[str, FloatArray]:
    case = curves.cases[data.load_case]
    return case.mean if data.branches == "mean" else case.half_width


def _interpolated_rows(at: FloatArray, grid: FloatArray, rows: FloatArray) -> FloatArray:
    """(k, m) rows, (k, n) on a rising grid, at `at`, (m,): each as `np.interp`, to the last bit."""
    cell = np.clip(np.searchsorted(grid, at, side="right") - 1, 0, grid.size - 2)
    low = rows[:, cell]
    slope = (rows[:, cell + 1] - low) / (grid[cell + 1] - grid[cell])
    out = slope * (np.maximum(at, grid[0]) - grid[cell]) + low
    out[:, at >= grid[-1]] = rows[:, -1:]
    return np.asarray(out)


def _rows(data: CurveData, gradients: CurveGradients) -> FloatArray:
    if data.branches == "half_width" and data.load_case not in gradients.half_width:
        return np.zeros((data.size, len(gradients.paths)))
    slopes = gradients.cases if data.branches == "mean" else gradients.half_width
    values = slopes[data.load_case][data.response][data.side]
    return interpolated(data.input, gradients.inputs[data.load_case], values)


def _scalar(figure: Figure, curves: CurveSet | None, characteristics: FloatArray) -> float:
    if figure.row >= 0:
        return float(characteristics[figure.row])
    if curves is None or curves.static is None:
        raise KeyError("the model gives no static angles")
    return float(curves.static[figure.response][figure.side])


def _scalar_row(figure: Figure, gradients: CurveGradients, characteristics: FloatArray) -> FloatArray:
    if figure.row >= 0:
        return np.asarray(characteristics[figure.row])
    return np.asarray(gradients.static[figure.response][figure.side])
