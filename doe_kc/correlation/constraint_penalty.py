"""Constraint intervals in a least-squares fit: one-sided terms that cost nothing inside."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from doe_kc.ground.typing import FloatArray
from doe_kc.targets.target import Targets

WALL_STIFFNESS = 0.001
"""Of an interval's half-width: how far beyond the wall counts as one standard deviation."""
WALL_MARGIN = 0.01
"""Of the half-width: how far inside the interval the wall stands, so that what leans on it, ten standard
deviations hard, still meets the constraint."""


@dataclass(frozen=True)
class ConstraintPenalty:
    """rows: (c,) places of the constrained characteristics in the registry. low, high, sd: (c,)."""

    rows: np.ndarray
    low: FloatArray
    high: FloatArray
    sd: FloatArray

    @classmethod
    def of(cls, targets: Targets) -> ConstraintPenalty:
        """One for every constraint, and one for every limit."""
        pairs = list(zip(targets.rows, targets.characteristics, strict=True))
        limits = [(r, t.constraint.low, t.constraint.high) for r, t in pairs if t.constraint is not None]
        limits += [(r, t.value - t.limit, t.value + t.limit) for r, t in pairs if np.isfinite(t.limit)]
        rows, low, high = (np.array(column) for column in zip(*limits, strict=True)) if limits else [()] * 3
        lower, upper = np.array(low, dtype=float), np.array(high, dtype=float)
        half = (upper - lower) / 2.0
        inside = WALL_MARGIN * half
        return cls(np.array(rows, dtype=int), lower + inside, upper - inside, WALL_STIFFNESS * half)

    def excess(self, values: FloatArray) -> FloatArray:
        """(c,) how far the constrained values (c,) are beyond their wall, + above, - below, 0 inside."""
        above, below = np.maximum(values - self.high, 0.0), np.maximum(self.low - values, 0.0)
        return np.asarray((above - below) / self.sd)

    def sides(self, values: FloatArray) -> np.ndarray:
        """(c,) the wall that each value is beyond: +1 upper, -1 lower, 0 none."""
        return np.sign(self.excess(values)).astype(int)

    def distance(self, values: FloatArray, sides: np.ndarray) -> FloatArray:
        """(c,) from the wall named, whether beyond it or not; 0 where none is."""
        wall = np.where(sides > 0, self.high, self.low)
        return np.asarray(np.where(sides == 0, 0.0, (values - wall) / self.sd))
