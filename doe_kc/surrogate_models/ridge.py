"""Ridge regression of many outputs, its penalty chosen per output by leave-one-out in closed form.

References: A. E. Hoerl, R. W. Kennard, Technometrics 12(1), 1970; D. M. Allen, Technometrics 16(1), 1974.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import final

import numpy as np

from doe_kc.ground.typing import FloatArray
from doe_kc.surrogate_models.interface import Fitted, LeftOut

RIDGE_PENALTIES = np.logspace(-6.0, 2.0, 33)


# RidgeCV(alpha_per_target=True) gives the same penalties and slopes (to 1e-14) in two to three times the
# time, but not the singular vectors that the variance needs.
def fit_ridge(x: FloatArray, y: FloatArray, penalties: FloatArray = RIDGE_PENALTIES) -> FittedLinear:
    """y = a + b x of x (n, d), y (n, m) with penalty |b|² times the best of `penalties`; a is free."""
    centre, level = x.mean(axis=0), y.mean(axis=0)
    u, s, vt = np.linalg.svd(x - centre, full_matrices=False)
    leverages = [_leverage(u, s, float(p)) for p in penalties]
    residuals = [_left_out(u, s, y - level, float(p), h) for p, h in zip(penalties, leverages, strict=True)]
    best = np.argmin([(r**2).sum(axis=0) for r in residuals], axis=0)
    left_out = np.stack([residuals[k][:, j] for j, k in enumerate(best)], axis=1)
    leverage = np.stack([leverages[k] for k in best], axis=1)
    penalty = penalties[best]
    slope = (vt.T @ (s[:, None] / (s[:, None] ** 2 + penalty) * (u.T @ (y - level)))).T
    return FittedLinear(centre, level, slope, penalty, vt, s, left_out, leverage)


def _leverage(u: FloatArray, s: FloatArray, penalty: float) -> FloatArray:
    """(n,) diagonal of H = 11' / n + U s² / (s² + penalty) U', below 1."""
    diagonal = 1.0 / len(u) + (u**2) @ (s**2 / (s**2 + penalty))
    return np.asarray(np.minimum(diagonal, 1.0 - 1e-12))


def _left_out(
    u: FloatArray, s: FloatArray, rest: FloatArray, penalty: float, leverage: FloatArray
) -> FloatArray:
    """(n, m) residuals y - Hy over 1 - diag H."""
    filtered = u * (s**2 / (s**2 + penalty))
    return np.asarray((rest - filtered @ (u.T @ rest)) / (1.0 - leverage)[:, None])


@final
@dataclass(frozen=True)
class FittedLinear(Fitted):
    """centre: (d,). level: (m,) there. slope: (m, d). penalty: (m,). directions (k, d), singular (k,):
    of the centred rows. left_out: (n, m) residuals. leverage: (n, m) of the rows.
    """

    centre: FloatArray
    level: FloatArray
    slope: FloatArray
    penalty: FloatArray
    directions: FloatArray
    singular: FloatArray
    left_out: FloatArray
    leverage: FloatArray

    @property
    def variables(self) -> int:
        """d."""
        return len(self.centre)

    @property
    def outputs(self) -> int:
        """m."""
        return len(self.level)

    @property
    def noise(self) -> FloatArray:
        """(m,) variance of a single row: a left-out residual has this over 1 - leverage."""
        return np.asarray((self.left_out**2 * (1.0 - self.leverage)).mean(axis=0))

    def of(self, outputs: np.ndarray) -> FittedLinear:
        """See `Fitted.of`."""
        rows = {n: getattr(self, n)[outputs] for n in ("level", "slope", "penalty")}
        columns = {n: getattr(self, n)[:, outputs] for n in ("left_out", "leverage")}
        return replace(self, **rows, **columns)

    def cross_validate(self) -> LeftOut:
        """Leave-one-out with the penalties held, closed form, with the variance that `variance` predicts."""
        return LeftOut(self.left_out.copy(), self.noise / (1.0 - self.leverage))

    def _mean(self, x: FloatArray) -> FloatArray:
        return self.level + (x - self.centre) @ self.slope.T

    def _gradient(self, x: FloatArray) -> FloatArray:
        return np.tile(self.slope, (len(x), 1, 1))

    def _variance(self, x: FloatArray) -> FloatArray:
        along = (x - self.centre) @ self.directions.T
        return self.noise * (1.0 + 1.0 / len(self.left_out) + along**2 @ self._certainty())

    def _variance_gradient(self, x: FloatArray) -> FloatArray:
        along = (x - self.centre) @ self.directions.T
        slope = np.einsum("pk,km,kd->pmd", 2.0 * along, self._certainty(), self.directions, optimize=True)
        return np.asarray(self.noise[:, None] * slope)

    def _certainty(self) -> FloatArray:
        """(k, m) inverse of the penalised squares."""
        return np.asarray(1.0 / (self.singular[:, None] ** 2 + self.penalty))
