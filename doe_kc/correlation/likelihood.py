"""All data of a correlation with their errors: residuals in standard deviations, and their derivatives."""

from __future__ import annotations

import hashlib
from collections.abc import Collection, Iterator
from dataclasses import dataclass
from functools import cached_property
from itertools import groupby

import numpy as np

from doe_kc.axle.model import Axle
from doe_kc.characteristics import CHARACTERISTICS
from doe_kc.correlation.curve_data import (
    CALIBRATION,
    CurveData,
    CurveGroup,
    half_width_data,
    mean_curve_data,
)
from doe_kc.curves import CurveSet
from doe_kc.ground.fields_only import CommonArgument
from doe_kc.ground.typing import FloatArray
from doe_kc.measurement import Measurement
from doe_kc.measurement.reduction import static_sd
from doe_kc.solver.curve_gradient import CurveGradients
from doe_kc.targets.target import Targets

EXACT_SHARE = 0.05
"""Of Norm: standard deviation taken for a typed target that states none, a third of its interval."""


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
class Likelihood(CommonArgument):
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
        out = np.empty((self.size, len(gradients.paths)))
        for group in self.groups:
            slopes = group.slopes(gradients)
            np.matmul(group.inverses, slopes, out=out[group.place].reshape(slopes.shape))
        for row, figure in enumerate(self.figures, start=self.size - len(self.figures)):
            out[row] = _scalar_row(figure, gradients, characteristics) / figure.sd
        return out

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


class Rewhitening:
    """From units of one likelihood's errors to those of another of the same data: L'^-1 L of every curve."""

    def __init__(self, before: Likelihood, after: Likelihood) -> None:
        pairs = zip(before.groups, after.groups, strict=True) if before is not after else ()
        self._changes = [
            (old.place, new.inverses @ np.array([c.root for c in old.curves]))
            for old, new in pairs
            if any(a is not b for a, b in zip(old.curves, new.curves, strict=True))
        ]

    def __call__(self, rows: FloatArray) -> FloatArray:
        """(M, ...) of rows (M, ...); the same array where no error is another."""
        if not self._changes:
            return rows
        out = rows.copy()
        for place, change in self._changes:
            k, n, _ = change.shape
            out[place] = (change @ rows[place].reshape(k, n, -1)).reshape(k * n, *rows.shape[1:])
        return out


def record_likelihood(axle: Axle, measurement: Measurement) -> Likelihood:
    """All that the records say, within the sweeps of the model: both branches of every loop, and statics.

    Errors are those of the repeats and of the sensors' calibration.
    """
    curves = (*mean_curve_data(axle, measurement, CALIBRATION), *half_width_data(axle, measurement))
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
        for c in ([] if measurement is None else mean_curve_data(axle, measurement))
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


def _static(measurement: Measurement) -> Iterator[Figure]:
    sd = static_sd(measurement.manifest.alignment)
    for response, values in (measurement.curves.static or {}).items():
        for side, value in enumerate(values):
            if np.isfinite(value):
                yield Figure(f"static.{response}", response, side, -1, float(value), sd[response])


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
