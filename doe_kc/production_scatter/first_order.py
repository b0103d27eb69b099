"""First order: the scatter of characteristics by their slopes alone.

With slopes G (k, m) and the covariance C of the deviations, the characteristics have the covariance G C G'.
Deviation i takes part in the variance of one by g_i (C g)_i: these shares add up to 1 whatever the
correlations (Cov(y, g_i x_i) / Var(y); G. Li et al., J. Phys. Chem. A 114(19), 2010), and one is negative
where the deviation makes up for others.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from doe_kc.ground.typing import FloatArray


@dataclass(frozen=True)
class FirstOrderScatter:
    """slopes: (k, m) of the characteristics to the deviations, in their units. covariance: (m, m). source:
    how the slopes are known, in words."""

    slopes: FloatArray
    covariance: FloatArray
    source: str

    @property
    def sd(self) -> FloatArray:
        """(k,) standard deviations."""
        return np.asarray(np.sqrt(np.maximum(self._parts.sum(axis=1), 0.0)))

    @property
    def _parts(self) -> FloatArray:
        """(k, m) of the variances."""
        return np.asarray(self.slopes * (self.slopes @ self.covariance))

    @property
    def shares(self) -> FloatArray:
        """(k, m) of each variance; 0 where nothing moves it."""
        parts = self._parts
        total = parts.sum(axis=1, keepdims=True)
        return np.asarray(np.divide(parts, total, out=np.zeros_like(parts), where=total > 0.0))

    def changes(self, deviations: FloatArray) -> FloatArray:
        """(n, k) of the characteristics of cars with deviations (n, m)."""
        return np.asarray(deviations @ self.slopes.T)


def regression_slopes(deviations: FloatArray, values: FloatArray) -> FloatArray:
    """(k, m) slopes of values (n, k) by ridge regression, where a solver gives none."""
    from doe_kc.surrogate_models.ridge import fit_ridge

    scale = deviations.std(axis=0)
    return np.asarray(fit_ridge(deviations / scale, values).slope / scale)
