"""The most probable step to first order, from records as data and the prior of the variables."""

from __future__ import annotations

import numpy as np

from doe_kc.correlation.least_squares import bounded_step
from doe_kc.ground.typing import FloatArray
from doe_kc.variables import Space


def most_probable_step(
    jacobian: FloatArray, residual: FloatArray, point: FloatArray, space: Space
) -> FloatArray:
    """(d,) minimizer of |r + J s|^2 + |(u + s - u0) / P|^2 within the bounds.

    residual r (M,) and Jacobian J (M, d) whitened, at point u (d,); u0 the start and P the prior sd.
    """
    weight = space.prior_sd**-2.0
    gradient = jacobian.T @ residual + weight * (point - space.start)
    hessian = jacobian.T @ jacobian + np.diag(weight)
    return bounded_step(hessian, gradient, -point, 1.0 - point)
