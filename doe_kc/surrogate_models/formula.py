"""Means of fitted surrogates as one formula an output, which a few lines of any language evaluate.

mean(u) = level + slope'(u - centre) + sum over rows i of weight_i g_i(u), with z = u - centre, q = z'Vz,
g_i = exp(r_i - (q + q_i) / 2), r_i = z'Vz_i, and where value and slope at the centre are known ("pinned")
g_i = exp(r_i - (q + q_i) / 2) - exp(-(q + q_i) / 2) (1 + r_i). Of a Matérn kernel ("matern") it is
g_i = (1 + s + s² / 3) exp(-s), s = sqrt(5 (q + q_i - 2 r_i)).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from doe_kc.ground.errors import InputError
from doe_kc.ground.typing import FloatArray
from doe_kc.surrogate_models.calibration import Calibrated
from doe_kc.surrogate_models.interface import Fitted
from doe_kc.surrogate_models.kernel import matern
from doe_kc.surrogate_models.models.gp import FittedGaussianProcess
from doe_kc.surrogate_models.models.rbf import FittedRadialBasis
from doe_kc.surrogate_models.ordinary_kriging import OrdinaryKriging
from doe_kc.surrogate_models.ridge import FittedLinear
from doe_kc.surrogate_models.selection import Chosen
from doe_kc.surrogate_models.varying import Varying


@dataclass(frozen=True)
class MeanFormula:
    """One output over d variables in [0, 1]. slope, centre, curvature (diagonal of V): (d,). rows: (n, d)
    from the centre, weight: (n,), of the sum; n = 0 for a plane.
    """

    level: float
    slope: FloatArray
    centre: FloatArray
    curvature: FloatArray
    rows: FloatArray
    weight: FloatArray
    pinned: bool = False
    matern: bool = False

    def mean(self, u: FloatArray) -> FloatArray:
        """(p,) of points (p, d)."""
        z = u - self.centre
        inner = (z * self.curvature) @ self.rows.T
        half = -0.5 * (((z * z) @ self.curvature)[:, None] + (self.rows**2) @ self.curvature)
        terms = np.exp(half + inner)
        if self.matern:
            terms, _ = matern(np.maximum(-2.0 * (half + inner), 0.0))
        if self.pinned:
            terms = terms - np.exp(half) * (1.0 + inner)
        return np.asarray(self.level + z @ self.slope + terms @ self.weight)


def mean_formulas(fitted: Fitted) -> list[MeanFormula]:
    """Of every output; InputError for a kind of model that has no such formula (`quadratic`)."""
    kind = next((k for k in FORMULAS if isinstance(fitted, k)), None)
    if kind is None:
        raise InputError(
            "surrogates: the quadratic model has no formula to export; choose among linear, rbf, gp, gp_ard, "
            "gp_slopes, kpls, kriging with --models."
        )
    return FORMULAS[kind](fitted)


def _plane(level: float, slope: FloatArray, centre: FloatArray) -> MeanFormula:
    d = len(centre)
    return MeanFormula(float(level), slope, centre, np.zeros(d), np.zeros((0, d)), np.zeros(0))


def _linear(fitted: FittedLinear) -> list[MeanFormula]:
    return [_plane(a, b, fitted.centre) for a, b in zip(fitted.level, fitted.slope, strict=True)]


def _process(fitted: FittedGaussianProcess) -> list[MeanFormula]:
    p, scale, trend = fitted.posterior, fitted.scaling.scale, fitted.trend
    level = fitted.scaling.shift if trend is None else trend.value
    slope = np.zeros_like(p.slope) if trend is None else trend.slope
    constant = p.kernel.constant * p.alpha.sum(axis=1)
    return [
        MeanFormula(
            float(level[j] + scale[j] * constant[j]), slope[j] + scale[j] * p.slope[j], fitted.centre,
            p.kernel.curvature[j], p.z, scale[j] * p.kernel.bend[j] * p.alpha[j], p.kernel.pinned,
            p.kernel.matern,
        )
        for j in range(fitted.outputs)
    ]  # fmt: skip


def _radial(fitted: FittedRadialBasis) -> list[MeanFormula]:
    n, d = fitted.x.shape
    scale, zero = fitted.scaling, np.zeros(d)
    tail = fitted.fit.solution[n:] * scale.scale
    curvature = np.full(d, 2.0 / fitted.width**2)
    slope = tail[1:] if fitted.linear_tail else np.zeros((d, fitted.outputs))
    return [
        MeanFormula(
            float(scale.shift[j] + tail[0, j]), slope[:, j], zero, curvature, fitted.x,
            scale.scale[j] * fitted.fit.solution[:n, j],
        )
        for j in range(fitted.outputs)
    ]  # fmt: skip


def _kriging(fitted: OrdinaryKriging) -> list[MeanFormula]:
    zero = np.zeros(fitted.variables)
    return [
        MeanFormula(float(level), zero, zero, 2.0 * theta, fitted.x, weight)
        for level, theta, weight in zip(fitted.level, fitted.theta, fitted.weight, strict=True)
    ]


def _varying(fitted: Varying) -> list[MeanFormula]:
    own = mean_formulas(fitted.inner)[: fitted.places.size]
    inner = dict(zip(map(int, fitted.places), own, strict=True))
    zero = np.zeros(fitted.variables)
    return [inner.get(j, _plane(value, zero, zero)) for j, value in enumerate(fitted.constant)]


def _chosen(fitted: Chosen) -> list[MeanFormula]:
    parts = [iter(mean_formulas(part)) for part in fitted.parts]
    return [next(parts[int(k)]) for k in fitted.part]


def _calibrated(fitted: Calibrated) -> list[MeanFormula]:
    return mean_formulas(fitted.inner)


FORMULAS: dict[type[Any], Callable[[Any], list[MeanFormula]]] = {
    Calibrated: _calibrated,
    Chosen: _chosen,
    Varying: _varying,
    FittedLinear: _linear,
    FittedGaussianProcess: _process,
    FittedRadialBasis: _radial,
    OrdinaryKriging: _kriging,
}
