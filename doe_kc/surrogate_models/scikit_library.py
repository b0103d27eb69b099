"""What scikit-learn lends: the lasso's path; typed and silent."""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from importlib import import_module
from typing import Any

import numpy as np

from doe_kc.ground.typing import FloatArray


def _library(part: str) -> Any:
    """Imported when needed: it takes a second, and ships no types."""
    return import_module(f"sklearn.{part}")


@dataclass(frozen=True)
class PenaltyPath:
    """penalties: (k,) decreasing. coefficients: (p, k) at them; between two they are straight lines."""

    penalties: FloatArray
    coefficients: FloatArray

    def at(self, penalty: float) -> FloatArray:
        """(p,) coefficients at a penalty; the path's end below its last."""
        k = int(np.searchsorted(-self.penalties, -penalty))
        if k == 0 or k >= len(self.penalties):
            return self.coefficients[:, min(k, len(self.penalties) - 1)]
        high, low = self.penalties[k - 1], self.penalties[k]
        share = (high - penalty) / (high - low)
        return np.asarray((1.0 - share) * self.coefficients[:, k - 1] + share * self.coefficients[:, k])


def lasso_path(features: FloatArray, y: FloatArray, *, least: float, steps: int) -> PenaltyPath:
    """Lasso path by least-angle regression of y (n,) on features (n, p), both centred here.

    least: penalty to stop at. Reference: B. Efron et al., Annals of Statistics 32(2), 2004.
    """
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # early stops of a degenerate path: what it has is used
        penalties, _, coefficients = _library("linear_model").lars_path(
            features - features.mean(axis=0), y - y.mean(), method="lasso", alpha_min=least, max_iter=steps,
            copy_X=False,
        )  # fmt: skip
    return PenaltyPath(np.asarray(penalties), np.asarray(coefficients))
