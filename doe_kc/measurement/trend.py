"""Polynomial trend line through a loop: one value per input, degree chosen by cross-validation."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.polynomial import chebyshev

from doe_kc.ground.typing import FloatArray

MAX_DEGREE = 15
"""Beyond, a polynomial over the whole travel rings between the samples of a kink."""
SAMPLES_PER_DEGREE = 5
"""Fewer leave a fold of the cross-validation without a say in every coefficient."""
TREND_FOLDS = 10
"""Usual (Breiman, Spector, Int. Stat. Rev. 60, 1992)."""
BLOCKS = 40
"""Blocks of neighbouring inputs, dealt out to the folds in turn: neighbours share noise and a branch."""


@dataclass(frozen=True)
class PolynomialTrend:
    """y = sum c_k T_k(t), t = (u - centre) / scale in [-1, 1]; Chebyshev for conditioning.

    coefficients: (degree + 1,) in the response's unit. centre, scale: input unit.
    cv_rmse: cross-validated rms error; residual_rmse: of the final fit, both in the response's unit
    and with the loop's half-width in them.
    Source: the one-valued "polyfit" of Wendeberg (2013), section 4; 1-SE rule: Breiman et al. (1984).
    """

    coefficients: FloatArray
    centre: float
    scale: float
    degree: int
    cv_rmse: float
    residual_rmse: float

    def __call__(self, inputs: FloatArray) -> FloatArray:
        """Trend values at `inputs` (n,)."""
        position = (inputs - self.centre) / self.scale
        return np.asarray(chebyshev.chebval(position, self.coefficients), dtype=np.float64)


def fit_trends(inputs: FloatArray, values: FloatArray) -> tuple[PolynomialTrend, ...]:
    """A trend for each row of `values` (k, n) over `inputs` (n,), both branches and all runs together.

    The degree is the smallest whose blocked 10-fold cross-validation error is within one standard error
    of the smallest one, the standard error being that of the difference, fold by fold.
    Few samples limit the degree: `SAMPLES_PER_DEGREE` for each.
    """
    most = min(MAX_DEGREE, inputs.size // SAMPLES_PER_DEGREE)
    centre = float(inputs.max() + inputs.min()) / 2.0
    scale = float(np.ptp(inputs)) / 2.0
    position = (inputs - centre) / scale
    basis: FloatArray = chebyshev.chebvander(position, most).astype(np.float64)
    folds = _folds(position)
    errors = _fold_errors(basis, values, folds)
    return tuple(
        _trend(basis, row, errors[:, :, k], centre=centre, scale=scale) for k, row in enumerate(values)
    )


def _folds(position: FloatArray) -> FloatArray:
    """(n,) fold number of each sample."""
    block = np.minimum(((position + 1.0) / 2.0 * BLOCKS).astype(int), BLOCKS - 1)
    out: FloatArray = (block % TREND_FOLDS).astype(np.float64)
    return out


def _fold_errors(basis: FloatArray, values: FloatArray, folds: FloatArray) -> FloatArray:
    """(degrees, folds, k) mean squared error on each left-out fold."""
    out = np.empty((basis.shape[1], TREND_FOLDS, values.shape[0]))
    for fold in range(TREND_FOLDS):
        test = folds == fold
        train = basis[~test]
        gram, moment = train.T @ train, train.T @ values[:, ~test].T
        for degree in range(basis.shape[1]):
            n = degree + 1
            coefficients = np.linalg.solve(gram[:n, :n], moment[:n])
            residual = values[:, test].T - basis[test][:, :n] @ coefficients
            out[degree, fold] = np.mean(residual**2, axis=0)
    return out


def _trend(
    basis: FloatArray, row: FloatArray, errors: FloatArray, *, centre: float, scale: float
) -> PolynomialTrend:
    degree = _one_standard_error(errors)
    solution = np.linalg.lstsq(basis[:, : degree + 1], row, rcond=None)[0]
    coefficients = np.asarray(solution, dtype=np.float64)
    residual = row - basis[:, : degree + 1] @ coefficients
    return PolynomialTrend(
        coefficients=coefficients,
        centre=centre,
        scale=scale,
        degree=degree,
        cv_rmse=float(np.sqrt(errors[degree].mean())),
        residual_rmse=float(np.sqrt(np.mean(residual**2))),
    )


def _one_standard_error(errors: FloatArray) -> int:
    """Smallest degree within one standard error of the best; errors (degrees, folds).

    The folds' errors differ by where they lie more than by degree, hence the paired difference.
    """
    excess = errors - errors[int(np.argmin(errors.mean(axis=1)))]
    doubt = excess.std(axis=1, ddof=1) / np.sqrt(errors.shape[1])
    return int(np.flatnonzero(excess.mean(axis=1) <= doubt)[0])
