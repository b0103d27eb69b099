"""Bounded, regularized linear least squares: the step of every residual-aware method."""

from __future__ import annotations

import numpy as np
from scipy.linalg import cho_factor, cho_solve, cholesky
from scipy.optimize import lsq_linear

from doe_kc.typing import FloatArray


def bounded_step(
    hessian: FloatArray, gradient: FloatArray, lower: FloatArray, upper: FloatArray
) -> FloatArray:
    """(d,) s that minimizes 1/2 s'Hs + g's with lower <= s <= upper; H (d, d) positive definite.

    Unbounded first: most steps hit no bound.
    """
    free = -cho_solve(cho_factor(hessian), gradient)
    if np.all((free >= lower) & (free <= upper)):
        return np.asarray(free)
    root = cholesky(hessian)
    wish = np.linalg.solve(root.T, -gradient)
    width = np.maximum(upper - lower, 1e-12)
    found = lsq_linear(root, wish, (lower, lower + width), method="bvls", tol=1e-10)
    return np.asarray(np.clip(found.x, lower, upper))
