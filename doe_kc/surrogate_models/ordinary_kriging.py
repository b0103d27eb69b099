"""Kriging with an unknown constant mean and given rates, many outputs at once.

y = beta + Gaussian process of correlation R = exp(-sum theta_k dx_k²); beta and the variance by maximum
likelihood. References: J. Sacks et al., Statistical Science 4(4), 1989; O. Dubrule, Mathematical Geology
15(6), 1983 (left-out rows).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

import numpy as np

from doe_kc.ground.errors import RunError
from doe_kc.ground.typing import FloatArray
from doe_kc.surrogate_models.cholesky import INDISTINCT, inverse_roots
from doe_kc.surrogate_models.interface import Fitted, LeftOut

NUGGETS = (1e-10, 1e-8)
"""Tried in turn until the correlation can be factorised."""


@final
@dataclass(frozen=True)
class OrdinaryKriging(Fitted):
    """x: (n, d) rows. theta: (m, d). root: (m, n, n) inverse of R's lower Cholesky factor. level, variance0:
    (m,) beta and process variance. weight: (m, n) inverse R times (y - beta). ones: (m, n) inverse R times 1.
    """

    x: FloatArray
    theta: FloatArray
    root: FloatArray
    level: FloatArray
    variance0: FloatArray
    weight: FloatArray
    ones: FloatArray

    @property
    def variables(self) -> int:
        """d."""
        return int(self.x.shape[1])

    @property
    def outputs(self) -> int:
        """m."""
        return len(self.level)

    @property
    def chunk(self) -> int:
        """As many points as make arrays of some 30 MB."""
        return 4_000_000 // self.weight.size

    def of(self, outputs: np.ndarray) -> OrdinaryKriging:
        """See `Fitted.of`."""
        own = (self.theta, self.root, self.level, self.variance0, self.weight, self.ones)
        return OrdinaryKriging(self.x, *(array[outputs] for array in own))

    def cross_validate(self) -> LeftOut:
        """Leave-one-out with the rates held, the mean estimated anew without the row."""
        total = self.ones.sum(axis=1)
        diagonal = (self.root**2).sum(axis=1) - self.ones**2 / total[:, None]
        return LeftOut((self.weight / diagonal).T, (self.variance0[:, None] / diagonal).T)

    def _correlation(self, x: FloatArray) -> FloatArray:
        return correlation(self.theta, x, self.x)

    def _mean(self, x: FloatArray) -> FloatArray:
        return self.level + (self._correlation(x) @ self.weight[:, :, None])[:, :, 0].T

    def _gradient(self, x: FloatArray) -> FloatArray:
        return self._pull(x, self._correlation(x) * self.weight[:, None]).transpose(1, 0, 2)

    def _variance(self, x: FloatArray) -> FloatArray:
        r = self._correlation(x)
        missing = 1.0 - (r @ self.ones[:, :, None])[:, :, 0]
        whitened = r @ self.root.transpose(0, 2, 1)
        known = (whitened**2).sum(axis=2) - missing**2 / self.ones.sum(axis=1)[:, None]
        return np.asarray(np.maximum(self.variance0[:, None] * (1.0 - known), 0.0).T)

    def _variance_gradient(self, x: FloatArray) -> FloatArray:
        r = self._correlation(x)
        missing = (1.0 - (r @ self.ones[:, :, None])[:, :, 0]) / self.ones.sum(axis=1)[:, None]
        by = (r @ self.root.transpose(0, 2, 1)) @ self.root + missing[:, :, None] * self.ones[:, None]
        pull = self._pull(x, r * by)
        return np.asarray((-2.0 * self.variance0[:, None, None] * pull).transpose(1, 0, 2))

    def _pull(self, x: FloatArray, by: FloatArray) -> FloatArray:
        """(m, p, d) derivative of the sum over rows of the correlations times `by` (m, p, n), over r."""
        return np.asarray(-2.0 * self.theta[:, None] * (by.sum(axis=2)[:, :, None] * x[None] - by @ self.x))


def correlation(theta: FloatArray, x: FloatArray, other: FloatArray) -> FloatArray:
    """(m, p, n) of points (p, d) and (n, d), theta (m, d)."""
    middle = other.mean(axis=0)
    a, b = x - middle, other - middle
    square = (theta @ (a * a).T)[:, :, None] + (theta @ (b * b).T)[:, None]
    return np.asarray(np.exp(-np.maximum(square - 2.0 * (a[None] * theta[:, None]) @ b.T, 0.0)))


def ordinary_kriging(x: FloatArray, y: FloatArray, theta: FloatArray) -> OrdinaryKriging:
    """Of rows x (n, d), y (n, m) and rates (m, d); RunError when rows are too alike to be told apart."""
    root = _inverse_roots(correlation(theta, x, x))
    white_ones, white = root.sum(axis=2), (root @ y.T[:, :, None])[:, :, 0]
    level = (white_ones * white).sum(axis=1) / (white_ones**2).sum(axis=1)
    rest = white - level[:, None] * white_ones
    back = root.transpose(0, 2, 1)
    weight, ones = (back @ rest[:, :, None])[:, :, 0], (back @ white_ones[:, :, None])[:, :, 0]
    return OrdinaryKriging(x, theta, root, level, (rest**2).mean(axis=1), weight, ones)


def _inverse_roots(matrices: FloatArray) -> FloatArray:
    return np.concatenate([_inverse_root(matrix[None]) for matrix in matrices])


def _inverse_root(matrix: FloatArray) -> FloatArray:
    for nugget in NUGGETS:
        try:
            return inverse_roots(matrix + nugget * np.eye(matrix.shape[1]))
        except RunError:
            continue
    raise RunError(INDISTINCT)
