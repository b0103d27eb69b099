"""Which parts, measured on a test bench, would show an effect that re-tuning absorbs.

With parameter i known to a standard deviation of e_i instead of p_i, the information on the effect's sizes
grows by m m' / (1 / (e_i^-2 - p_i^-2) + H^-1_ii), m the i-th row of H^-1 J' S: how the parameter follows the
effect (Sherman and Morrison; M. A. Woodbury, Inverting modified matrices, Princeton 1950).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.linalg import cho_factor, cho_solve

from doe_kc.discovery.fit import Fit
from doe_kc.discovery.jacobian import Jacobian
from doe_kc.discovery.screening.screen import Screened
from doe_kc.discovery.thresholds import (
    BENCH_ACCURACY,
    BENCH_ANGLE,
    BENCH_POSITION,
    BENCH_RADIUS,
    DETECTION_LEVEL,
    NULL_SHARE,
    PARTS_MOST,
)
from doe_kc.effects import EFFECTS
from doe_kc.ground.typing import FloatArray
from doe_kc.variables.variable import Variable


@dataclass(frozen=True)
class ComponentTest:
    """Parts to measure on a test bench, so that an effect shows that re-tuning absorbs."""

    parts: tuple[str, ...]
    """Paths of the parameters to measure, those that bring most first."""
    separation: float
    """Standard deviations that the effect would then make at its typical size; of several sizes, the one that
    shows least."""


def accuracy(variable: Variable, value: float) -> float:
    """Standard deviation to which a bench knows a parameter of some value, in the parameter's unit."""
    scale = abs(value)
    if variable.parameter.quantity == "radius":
        return BENCH_RADIUS * scale
    if variable.logarithmic:
        return BENCH_ACCURACY * scale
    return BENCH_ANGLE if variable.parameter.quantity == "angle" else BENCH_POSITION


def component_tests(fit: Fit, screened: Sequence[Screened], least: float) -> list[ComponentTest | None]:
    """For each hypothesis the parts to measure; None where PARTS_MOST parts do not show it.

    least: standard deviations from which it shows.
    """
    tuning = _Tuning.of(fit)
    return [_chosen(tuning, s, least) for s in screened]


@dataclass(frozen=True)
class _Tuning:
    """What re-tuning may do."""

    paths: tuple[str, ...]
    """(p,) paths of the parameters."""
    covariance: FloatArray
    """(d, d) of parameters and nuisances after the fit."""
    precision: FloatArray
    """(p,) that a bench adds to each parameter."""
    jacobian: Jacobian
    """(M, d + m), parameters and nuisances first."""

    @staticmethod
    def of(fit: Fit) -> _Tuning:
        model, count = fit.model, fit.model.traces.start
        hessian = fit.hessian[:count, :count]
        covariance = np.asarray(cho_solve(cho_factor(hessian), np.eye(count)))
        known = np.array([_known(v, float(u)) for v, u in zip(model.space.variables, fit.z, strict=False)])
        precision = np.maximum(known**-2.0 - model.prior_sd[: model.parameters] ** -2.0, 0.0)
        return _Tuning(model.space.paths, covariance, precision, fit.jacobian)


def _known(variable: Variable, u: float) -> float:
    """Standard deviation of the place between the bounds once the part is measured."""
    return accuracy(variable, variable.value(u)) / variable.slope(u)


def _chosen(tuning: _Tuning, screened: Screened, least: float) -> ComponentTest | None:
    columns = _columns(screened)
    if screened.failed or EFFECTS[screened.hypothesis.effect].on_rig or not columns.size:
        return None
    pulled = tuning.jacobian.pulled(columns)[: tuning.covariance.shape[0]]
    moves = tuning.covariance @ pulled
    information = columns.T @ columns - pulled.T @ moves
    covariance, precision = tuning.covariance, tuning.precision
    parts: list[int] = []
    while (shown := _shown(information)) < DETECTION_LEVEL and len(parts) < PARTS_MOST:
        gains = [
            _shown(information + np.outer(moves[i], moves[i]) * _weight(covariance, precision, i))
            if i not in parts
            else 0.0
            for i in range(precision.size)
        ]
        i = int(np.argmax(gains))
        if gains[i] <= shown:
            break
        weight = _weight(covariance, precision, i)
        information = information + weight * np.outer(moves[i], moves[i])
        row = covariance[i]
        moves = moves - weight * np.outer(row, moves[i])
        covariance = covariance - weight * np.outer(row, row)
        parts.append(i)
    if shown < least or not parts:
        return None
    return ComponentTest(tuple(tuning.paths[i] for i in parts), shown)


def _weight(covariance: FloatArray, precision: FloatArray, i: int) -> float:
    return float(precision[i] / (1.0 + precision[i] * covariance[i, i]))


def _columns(screened: Screened) -> FloatArray:
    """(M, k) of the data by each size that says how much, at its typical value."""
    amounts = [i for i, s in enumerate(screened.hypothesis.sizes) if not s.shape]
    return screened.columns[:, amounts] if len(amounts) > 1 else screened.change[:, None]


def _shown(information: FloatArray) -> float:
    """Standard deviations of the size that shows least, whatever the others are; 0 if none does anything."""
    total = float(np.trace(information))
    if total <= 0.0:
        return 0.0
    floor = NULL_SHARE * total * np.eye(information.shape[0])
    return float(1.0 / np.sqrt(np.diag(np.linalg.inv(information + floor)).max()))
