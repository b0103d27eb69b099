"""The measured curves as data with their errors: residuals in standard deviations, and their derivatives."""

from __future__ import annotations

import hashlib
from collections.abc import Collection, Iterator
from dataclasses import dataclass
from functools import cached_property
from itertools import groupby
from typing import Literal

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from scipy.linalg import cholesky, solve_triangular

from doe_kc.axle.model import Axle
from doe_kc.characteristics import CHARACTERISTICS
from doe_kc.curves import TYRE_LOAD, CurveSet
from doe_kc.ground.fields_only import FieldsOnly
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
        """(k, n, n) L^-1 of each curve, kept: curves are whitened hundreds of times."""
        eye = np.eye(self.first.size)
        return np.array([c.whitened(eye) for c in self.curves])

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
class Likelihood(FieldsOnly):
    """All data of a correlation. Residuals are (model - measured) in units of the errors, (M,)."""

    curves: tuple[CurveData, ...]
    figures: tuple[Figure, ...]

    @cached_property
    def size(self) -> int:
        """M, the number of data."""
        return sum(c.size for c in self.curves) + len(self.figures)

    @cached_property
    def digest(self) -> bytes:
        """SHA-256 of all data and their errors."""
        digest = hashlib.sha256(repr(self.figures).encode())
        for curve in self.curves:
            digest.update(f"{curve.load_case} {curve.response} {curve.side} {curve.branches}".encode())
            for array in (curve.input, curve.value, curve.root):
                digest.update(np.ascontiguousarray(array).tobytes())
        return digest.digest()

    def residual(self, curves: CurveSet | None, characteristics: FloatArray) -> FloatArray:
        """(M,) whitened residual of a model; KeyError for a load case that it lacks."""
        if curves is None and self.size > sum(f.row >= 0 for f in self.figures):
            raise ValueError("the model gives no curves to compare with the measured ones")
        out = np.empty(self.size)
        for group in self.groups if curves is not None else ():
            assert curves is not None
            out[group.place] = group.whitened((group.model(curves) - group.values)[..., None])[:, 0]
        scalars = [(_scalar(f, curves, characteristics) - f.value) / f.sd for f in self.figures]
        out[self.size - len(scalars) :] = scalars
        return out

    @cached_property
    def groups(self) -> tuple[CurveGroup, ...]:
        """All curves in their order, consecutive ones of the same inputs together."""
        out: list[CurveGroup] = []
        start = 0
        for _, same in groupby(self.curves, lambda c: (c.load_case, c.branches, c.input.tobytes())):
            members = tuple(same)
            end = start + sum(c.size for c in members)
            out.append(CurveGroup(members, slice(start, end)))
            start = end
        return tuple(out)

    def jacobian(self, gradients: CurveGradients, characteristics: FloatArray) -> FloatArray:
        """(M, p) derivative of the residual. characteristics: (all registered, p) their gradients."""
        parts = [group.whitened(group.slopes(gradients)) for group in self.groups]
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
    for old, new in zip(before.groups, after.groups, strict=True):
        if any(a is not b for a, b in zip(old.curves, new.curves, strict=True)):
            change = new.inverses @ np.array([c.root for c in old.curves])
            k, n, _ = change.shape
            out[old.place] = (change @ rows[old.place].reshape(k, n, -1)).reshape(k * n, *rows.shape[1:])
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


def _interpolated_rows(at: FloatArray, grid: FloatArray, rows: FloatArray) -> FloatArray:
    """(k, m) rows, (k, n) on a rising grid, at `at`, (m,): each as `np.interp`, to the last bit."""
    cell = np.clip(np.searchsorted(grid, at, side="right") - 1, 0, grid.size - 2)
    low = rows[:, cell]
    slope = (rows[:, cell + 1] - low) / (grid[cell + 1] - grid[cell])
    out = slope * (np.maximum(at, grid[0]) - grid[cell]) + low
    out[:, at >= grid[-1]] = rows[:, -1:]
    return np.asarray(out)


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
