"""Fits to residuals: normal equations with a prior and one-sided constraint terms, within bounds."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.linalg import cho_factor, cho_solve

from doe_kc.ground.typing import FloatArray
from doe_kc.targets.target import Targets
from doe_kc.variables import Space

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


LEAST_SQUARES_ITERATIONS = 500
"""A guard: random problems of 12 to 140 variables, up to all of them at a bound, settled in 10 at most."""
HALVINGS = 30
"""A billionth of the move: what gains less is rounding."""
SUFFICIENT = 1e-4
"""Share of the slope's promise that a step must keep (Armijo)."""


# lsq_linear wants a root of H, has no early end, and takes 2 (12 variables) to 14 times (140) as long for the
# same minimizer (to 1e-14).
def bounded_step(
    hessian: FloatArray,
    gradient: FloatArray,
    lower: FloatArray,
    upper: FloatArray,
    *,
    iterations: int = LEAST_SQUARES_ITERATIONS,
) -> FloatArray:
    """(d,) s that minimizes 1/2 s'Hs + g's with lower <= s <= upper; H (d, d) positive definite.

    Newton steps on the free variables, projected onto the box (D. P. Bertsekas, Projected Newton methods,
    SIAM J. Control Optim. 20(2), 1982). iterations: fewer leave a step that is good but not the best.
    """
    step = np.clip(np.zeros_like(gradient), lower, upper)
    for _ in range(iterations):
        slope = hessian @ step + gradient
        held = ((step <= lower) & (slope > 0)) | ((step >= upper) & (slope < 0))
        free = ~held
        if not free.any():
            return step
        move = np.zeros_like(step)
        move[free] = -cho_solve(cho_factor(hessian[np.ix_(free, free)]), slope[free])
        if -slope @ move <= 1e-14 * max(1.0, float(abs(gradient @ step))):
            return step
        following = _projected(hessian, slope, step, move, lower, upper)
        if following is None:
            return step
        step = following
    return step


def _projected(
    hessian: FloatArray,
    slope: FloatArray,
    step: FloatArray,
    move: FloatArray,
    lower: FloatArray,
    upper: FloatArray,
) -> FloatArray | None:
    """The longest halved move along the projected arc that gains enough; None when none does."""
    for halving in range(HALVINGS):
        new = np.clip(step + 0.5**halving * move, lower, upper)
        change = new - step
        promised = slope @ change
        if promised < 0 and promised + 0.5 * change @ hessian @ change <= SUFFICIENT * promised:
            return np.asarray(new)
    return None


def with_prior(
    hessian: FloatArray, gradient: FloatArray, weight: FloatArray, moved: FloatArray, *, flat: float = 0.0
) -> tuple[FloatArray, FloatArray]:
    """H + diag(w + flat) and g + w m: a quadratic of d variables, with the cost of having moved.

    weight: (d,) w of the prior 1/2 w m^2. moved: (d,) m, from the prior's centre. flat: curvature that keeps
    a direction without data from being followed.
    """
    return hessian + np.diag(weight + flat), gradient + weight * moved


def normal_equations(
    jacobian: FloatArray, residual: FloatArray, weight: FloatArray, moved: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Matrix (d, d) and gradient (d,) of 1/2 |r + J s|^2 + 1/2 w (m + s)^2 at s = 0.

    residual r (M,) and Jacobian J (M, d) whitened; weight, moved: as in `with_prior`.
    """
    return with_prior(jacobian.T @ jacobian, jacobian.T @ residual, weight, moved)


def most_probable_step(
    jacobian: FloatArray, residual: FloatArray, point: FloatArray, space: Space
) -> FloatArray:
    """(d,) minimizer of |r + J s|^2 + |(u + s - u0) / P|^2 within the bounds.

    residual r (M,) and Jacobian J (M, d) whitened, at point u (d,); u0 the start and P the prior sd.
    """
    hessian, gradient = normal_equations(jacobian, residual, space.prior_sd**-2.0, point - space.start)
    return bounded_step(hessian, gradient, -point, 1.0 - point)
