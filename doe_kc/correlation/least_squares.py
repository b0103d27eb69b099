"""Normal equations with a prior, and their minimizer within bounds: the step of every fit to residuals."""

from __future__ import annotations

import numpy as np
from scipy.linalg import cho_factor, cho_solve

from doe_kc.ground.typing import FloatArray
from doe_kc.variables import Space

LEAST_SQUARES_ITERATIONS = 500
HALVINGS = 30
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
