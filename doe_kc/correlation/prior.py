"""What moving a variable costs, so that those which the data do not see stay where they are."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from doe_kc.ground.typing import FloatArray

PRIOR_RIDGE = 1e-3
"""Rating per squared prior standard deviation: far below what any target is worth."""
RIDGE_MEASURED = 0.02
"""The same for a search on everything measured, where a deviation that is removed is worth 1: seventy
variables at one standard deviation cost as much as 70 % of one characteristic's deviation."""


@dataclass(frozen=True)
class Prior:
    """A weak Gaussian prior. centre: (d,) the start. weight: (d,) rating per squared place."""

    centre: FloatArray
    weight: FloatArray

    @classmethod
    def of(cls, start: FloatArray, prior_sd: FloatArray, ridge: float = PRIOR_RIDGE) -> Prior:
        """`ridge` per squared prior sd (d,) about the start (d,)."""
        return cls(start, ridge * prior_sd**-2.0)

    def cost(self, points: FloatArray) -> FloatArray:
        """(...,) rating given away at points (..., d)."""
        return np.asarray(0.5 * (points - self.centre) ** 2 @ self.weight)
