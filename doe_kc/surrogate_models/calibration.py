"""Predicted variances made true: scaled per output until left-out residuals are as large as they say."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

import numpy as np
from scipy.special import ndtr

from doe_kc.ground.typing import FloatArray
from doe_kc.surrogate_models.interface import Fitted, LeftOut
from doe_kc.surrogate_models.validation import NOMINAL_WIDTH

LEAST_VARIANCE_RATIO = 1e-12
"""Variance ratio below which a residual of zero against a variance of zero counts as in order."""
DEPENDENCE = 1.86
"""Standard errors of the factor over what n independent errors would have, as left-out errors share most of
their designs."""
MODEL_ERROR = 0.135
"""Standard error of an interval's logarithm that no number of left-out errors lessens: they are of other
models than the one in use. Both from `gp_ard`, 36 sets of designs of three axle types: 0.23, 0.19 and
0.165 at 50, 100 and 200 designs, where n independent errors would have 0.10, 0.07 and 0.05."""


def calibration_factors(left_out: LeftOut, folds: int) -> FloatArray:
    """(m,) factors of the variance: mean of the squared residuals over their variances, as widened.

    The likelihood's estimate for Gaussian errors, which errors over designs are (their root mean square is
    0.51 of their 95 % quantile). folds: of the cross-validation, the number of rows where single ones were
    left out.
    """
    ratio = _standardised(left_out, folds)
    return np.asarray(np.maximum(ratio.mean(axis=0) * widening(len(ratio)) ** 2, LEAST_VARIANCE_RATIO))


def widening(rows: int) -> float:
    """Factor of an interval so that it covers 95 % in the mean over many, though the scale of each is only as
    certain as `rows` left-out errors make it.

    For an error of its logarithm of standard deviation s, to second order: exp((z² - 1) s² / 2).
    """
    return float(np.exp(0.5 * (NOMINAL_WIDTH**2 - 1.0) * (MODEL_ERROR**2 + 0.5 * DEPENDENCE**2 / rows)))


def _standardised(left_out: LeftOut, folds: int) -> FloatArray:
    """(n, m) squared residuals over their variances; 1 for an output that is known exactly.

    The model in use has all rows, that of a fold a share 1 - 1 / folds of them. The error falls with the
    number of rows, and the variances of single rows left out are larger than elsewhere: together, its square
    by that share.
    """
    with np.errstate(divide="ignore", invalid="ignore"):
        ratio = (1.0 - 1.0 / folds) * np.square(left_out.residual) / left_out.variance
    return np.where(np.isfinite(ratio), ratio, 1.0)


def scaled(left_out: LeftOut, factors: FloatArray) -> LeftOut:
    """The same residuals with variances times factors (m,)."""
    return LeftOut(left_out.residual, left_out.variance * factors)


def coverage_after(left_out: LeftOut, folds: int) -> FloatArray:
    """(m,) share of the rows inside their interval, the factor taken from all other rows."""
    ratio = _standardised(left_out, folds)
    n = len(ratio)
    others = (ratio.sum(axis=0) - ratio) / (n - 1)
    return np.asarray((ratio <= (NOMINAL_WIDTH * widening(n - 1)) ** 2 * others).mean(axis=0))


def coverage_interval(left_out: LeftOut, folds: int) -> tuple[FloatArray, FloatArray]:
    """(m,) lower and upper 95 % limit of the coverage on new designs.

    An interval that is exp(t) too wide covers 2 Phi(z exp(t)) - 1. t is normal, with the standard error of
    half the logarithm of a mean of n ratios, `DEPENDENCE` times, and `MODEL_ERROR`.
    """
    ratio = _standardised(left_out, folds)
    relative = ratio.std(axis=0) / np.maximum(ratio.mean(axis=0), LEAST_VARIANCE_RATIO)
    error = np.hypot(MODEL_ERROR, 0.5 * DEPENDENCE * relative / np.sqrt(len(ratio)))
    width = NOMINAL_WIDTH * widening(len(ratio))
    low, high = (2.0 * ndtr(width * np.exp(k * NOMINAL_WIDTH * error)) - 1.0 for k in (-1.0, 1.0))
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

    def of(self, outputs: np.ndarray) -> Calibrated:
        """See `Fitted.of`."""
        return Calibrated(self.inner.of(outputs), self.factors[outputs])

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
