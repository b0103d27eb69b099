"""Predicted variances made true: scaled per output until left-out residuals lie where they should.

Reference: split conformal prediction, J. Lei et al., J. Am. Stat. Assoc. 113(523), 2018.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

import numpy as np

from doe_kc.ground.typing import FloatArray
from doe_kc.surrogates.interface import Fitted, LeftOut
from doe_kc.surrogates.validation import NOMINAL, NOMINAL_WIDTH

LEAST_VARIANCE_RATIO = 1e-12
"""Variance ratio below which a residual of zero against a variance of zero counts as in order."""


def calibration_factors(left_out: LeftOut) -> FloatArray:
    """(m,) factors of the variance that put 95 % of the left-out rows inside their 95 % interval.

    The quantile is the ceil(0.95 (n + 1))-th smallest standardised residual, the largest for n < 39 rows.
    """
    ratio = _standardised(left_out)
    rank = min(len(ratio), int(np.ceil(NOMINAL * (len(ratio) + 1)))) - 1
    return np.asarray(np.maximum(np.sort(ratio, axis=0)[rank] / NOMINAL_WIDTH**2, LEAST_VARIANCE_RATIO))


def _standardised(left_out: LeftOut) -> FloatArray:
    """(n, m) squared residuals over their variances; 1 for an output that is known exactly."""
    with np.errstate(divide="ignore", invalid="ignore"):
        ratio = np.square(left_out.residual) / left_out.variance
    return np.where(np.isfinite(ratio), ratio, NOMINAL_WIDTH**2)


def scaled(left_out: LeftOut, factors: FloatArray) -> LeftOut:
    """The same residuals with variances times factors (m,)."""
    return LeftOut(left_out.residual, left_out.variance * factors)


def coverage_after(left_out: LeftOut, *, seed: int) -> FloatArray:
    """(m,) honest coverage after calibration: factors from one half of the rows, counted on the other."""
    order = np.random.default_rng(seed).permutation(len(left_out.residual))
    inside = np.zeros_like(left_out.residual)
    for part in (order[::2], order[1::2]):
        other = np.setdiff1d(order, part)
        factors = calibration_factors(LeftOut(left_out.residual[part], left_out.variance[part]))
        limit = NOMINAL_WIDTH * np.sqrt(left_out.variance[other] * factors)
        inside[other] = np.abs(left_out.residual[other]) <= limit
    return np.asarray(inside.mean(axis=0))


@final
@dataclass(frozen=True)
class Calibrated(Fitted):
    """A model whose variances are scaled. inner: the model. factors: (m,)."""

    inner: Fitted
    factors: FloatArray

    @property
    def variables(self) -> int:
        """d."""
        return self.inner.variables

    @property
    def outputs(self) -> int:
        """m."""
        return self.inner.outputs

    def cross_validate(self) -> LeftOut:
        """Of the inner model, variances scaled."""
        return scaled(self.inner.cross_validate(), self.factors)

    def _mean(self, x: FloatArray) -> FloatArray:
        return self.inner.predict(x)

    def _variance(self, x: FloatArray) -> FloatArray:
        return self.factors * self.inner.variance(x)

    def _gradient(self, x: FloatArray) -> FloatArray:
        return self.inner.gradient(x)

    def _variance_gradient(self, x: FloatArray) -> FloatArray:
        return np.asarray(self.factors[:, None] * self.inner.variance_gradient(x))
