"""Predicted variances made true: scaled per output until left-out residuals are as large as they say."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

import numpy as np
from scipy.special import stdtr, stdtrit

from doe_kc.ground.typing import FloatArray
from doe_kc.surrogate_models.interface import Fitted, LeftOut
from doe_kc.surrogate_models.validation import NOMINAL, NOMINAL_WIDTH

LEAST_VARIANCE_RATIO = 1e-12
"""Variance ratio below which a residual of zero against a variance of zero counts as in order."""
DEPENDENCE = 2.0
"""Standard errors of the factor's logarithm that were found on 500 separate designs, over what n independent
errors would have: left-out errors share most of their designs, and the model in use is another one than those
of the folds (0.55, 0.3 and 0.2 at 50, 100 and 200 designs instead of 0.25, 0.18 and 0.12)."""


def calibration_factors(left_out: LeftOut) -> FloatArray:
    """(m,) factors of the variance: mean of the squared residuals over their variances.

    The likelihood's estimate for Gaussian errors, times (t / 1.96)² of Student's t for as many degrees of
    freedom as half the rows have: errors over designs have tails, and a variance from n of them is uncertain.
    """
    ratio = _standardised(left_out)
    width = student_width(len(ratio))
    return np.asarray(np.maximum(ratio.mean(axis=0) * (width / NOMINAL_WIDTH) ** 2, LEAST_VARIANCE_RATIO))


def student_width(rows: int) -> float:
    """Standard deviations to either side of a 95 % interval whose variance was estimated from `rows` rows."""
    return float(stdtrit(max(rows / 2.0, 1.0), 0.5 + NOMINAL / 2.0))


def _standardised(left_out: LeftOut) -> FloatArray:
    """(n, m) squared residuals over their variances; 1 for an output that is known exactly."""
    with np.errstate(divide="ignore", invalid="ignore"):
        ratio = np.square(left_out.residual) / left_out.variance
    return np.where(np.isfinite(ratio), ratio, 1.0)


def scaled(left_out: LeftOut, factors: FloatArray) -> LeftOut:
    """The same residuals with variances times factors (m,)."""
    return LeftOut(left_out.residual, left_out.variance * factors)


def coverage_after(left_out: LeftOut) -> FloatArray:
    """(m,) share of the rows inside their interval, the factor taken from all other rows."""
    ratio = _standardised(left_out)
    n = len(ratio)
    others = (ratio.sum(axis=0) - ratio) / (n - 1)
    return np.asarray((ratio <= student_width(n - 1) ** 2 * others).mean(axis=0))


def coverage_interval(left_out: LeftOut) -> tuple[FloatArray, FloatArray]:
    """(m,) lower and upper 95 % limit of the coverage on new designs.

    The factor is a mean of n ratios; its logarithm has the standard error s = sd / (mean sqrt(n)), taken
    `DEPENDENCE` times, and an interval that is exp(+-z s / 2) too wide covers Student's t within so much of
    its width.
    """
    ratio = _standardised(left_out)
    rows = len(ratio)
    error = DEPENDENCE * ratio.std(axis=0) / np.maximum(ratio.mean(axis=0), LEAST_VARIANCE_RATIO)
    off = np.exp(0.5 * NOMINAL_WIDTH * error / np.sqrt(rows))
    width, freedom = student_width(rows), max(rows / 2.0, 1.0)
    low, high = (2.0 * stdtr(freedom, width * factor) - 1.0 for factor in (1.0 / off, off))
    return np.asarray(low), np.asarray(high)


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
