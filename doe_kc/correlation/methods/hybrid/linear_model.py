"""A linear model of every output about one design, from the evaluations at hand.

Weighted ridge regression through the design: near evaluations count, and few of them suffice (the
interpolation of least norm), as in derivative-free Gauss-Newton methods (C. Cartis, L. Roberts, A
derivative-free Gauss-Newton method, Math. Program. Comput. 11, 2019).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

import numpy as np

from doe_kc.ground.typing import FloatArray
from doe_kc.surrogates.interface import Fitted, LeftOut

STEP_RIDGE = 1e-6
"""Share of the mean square of the steps: below what one level changes."""


@final
@dataclass(frozen=True)
class LinearModel(Fitted):
    """mean(x) = value + slope (x - centre); slope (m, d), value and variance (m,), residual (n, m)."""

    centre: FloatArray
    value: FloatArray
    slope: FloatArray
    spread: FloatArray
    residual: FloatArray

    @property
    def variables(self) -> int:
        """d."""
        return len(self.centre)

    @property
    def outputs(self) -> int:
        """m."""
        return len(self.value)

    def cross_validate(self) -> LeftOut:
        """Residuals of the fit itself: the model is no more than a guide for one step."""
        return LeftOut(self.residual, np.tile(self.spread, (len(self.residual), 1)))

    def _mean(self, x: FloatArray) -> FloatArray:
        return np.asarray(self.value + (x - self.centre) @ self.slope.T)

    def _variance(self, x: FloatArray) -> FloatArray:
        return np.tile(self.spread, (len(x), 1))

    def _gradient(self, x: FloatArray) -> FloatArray:
        return np.tile(self.slope, (len(x), 1, 1))

    def _variance_gradient(self, x: FloatArray) -> FloatArray:
        return np.zeros((len(x), self.outputs, self.variables))


def linear_model(centre: FloatArray, x: FloatArray, y: FloatArray) -> LinearModel:
    """centre: (d,), one of the designs x (n, d). y: (n, m) their outputs.

    A design at the distance of the d-th nearest has the weight exp(-1/2); the variance is that of the
    weighted residuals.
    """
    step = x - centre
    apart = np.linalg.norm(step, axis=1)
    value = y[int(np.argmin(apart))]
    width = np.sort(apart)[min(len(x) - 1, x.shape[1])]
    weight = np.exp(-0.5 * (apart / max(float(width), 1e-12)) ** 2)
    slope = weighted_slope(step, y - value, weight)
    residual = y - value - step @ slope.T
    return LinearModel(centre, value, slope, weight @ residual**2 / weight.sum(), residual)


def weighted_slope(step: FloatArray, change: FloatArray, weight: FloatArray) -> FloatArray:
    """(m, d) J of least sum of w |step J' - change|^2 + ridge |J|^2; step (n, d), change (n, m)."""
    normal = step.T @ (weight[:, None] * step)
    ridge = STEP_RIDGE * max(float(np.trace(normal)) / len(normal), 1e-12)
    right = step.T @ (weight[:, None] * change)
    return np.asarray(np.linalg.solve(normal + ridge * np.eye(len(normal)), right).T)
