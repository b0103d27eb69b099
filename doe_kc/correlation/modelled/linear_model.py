"""A linear model of all outputs about one design."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

import numpy as np

from doe_kc.ground.typing import FloatArray
from doe_kc.surrogate_models.interface import Fitted, LeftOut


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

    def of(self, outputs: np.ndarray) -> LinearModel:
        """See `Fitted.of`."""
        own = (self.value[outputs], self.slope[outputs], self.spread[outputs], self.residual[:, outputs])
        return LinearModel(self.centre, *own)

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

    @classmethod
    def expansion(cls, centre: FloatArray, value: FloatArray, slope: FloatArray) -> LinearModel:
        """Exact value (m,) and slope (m, d) at a point (d,), taken at their word: variance 0, no row."""
        return cls(centre, value, slope, np.zeros_like(value), np.zeros((0, value.size)))
