"""What the data say of each variable: standard deviations from the Jacobian, and what they cannot see."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import cho_factor, cho_solve
from scipy.special import ndtr, ndtri

from doe_kc.correlation.least_squares import normal_equations
from doe_kc.ground.typing import FloatArray

VISIBLE_SHARE = 0.5
"""A variable is visible when the measurement at least halves its prior standard deviation."""
ONE_SD = 0.6827
"""Probability within one standard deviation of a normal distribution."""
BOUND_SHARE = 0.005
"""Share of the range within which a variable counts as being at its bound: half a step of 101 levels."""


@dataclass(frozen=True)
class ParameterPosterior:
    """Linear Gaussian view at a design. All (d,), in places u.

    sd: sqrt(diag((J'J + P^-2)^-1)) times the misfit, J in standard deviations of the data, P the prior sd; no
    more than the prior allows. prior: P. correlation: (d, d). misfit: whitened RMS of the residuals, 1 at
    least: what the model does not explain makes its parameters as much less certain (Birge's ratio).
    at_bound: (d,) -1 lower, +1 upper, 0 between. inward: (d,) distance from that bound within which the value
    lies with a probability of 68 %, nan between the bounds: there a standard deviation means nothing.
    """

    sd: FloatArray
    prior: FloatArray
    correlation: FloatArray
    misfit: float
    at_bound: NDArray[np.int_]
    inward: FloatArray

    @property
    def visible(self) -> NDArray[np.bool_]:
        """(d,) whether the measurement at least halves the prior sd."""
        return np.asarray(self.sd <= VISIBLE_SHARE * self.prior)


def posterior(
    jacobian: FloatArray,
    prior: FloatArray,
    *,
    residual: FloatArray | None = None,
    point: FloatArray | None = None,
) -> ParameterPosterior:
    """Posterior of d variables from the whitened Jacobian (M, d) and the prior sd (d,).

    residual: (M,) whitened, by default noise. point: (d,) the design, by default between all bounds.
    """
    left = np.zeros(len(jacobian)) if residual is None else residual
    at = np.full(prior.size, 0.5) if point is None else point
    misfit = max(1.0, float(np.sqrt(np.mean(left**2)))) if left.size else 1.0
    weighted = jacobian / misfit
    hessian, slope = normal_equations(weighted, left / misfit, prior**-2.0, np.zeros(prior.size))
    covariance = np.asarray(cho_solve(cho_factor(hessian), np.eye(prior.size)))
    sd = np.sqrt(np.diag(covariance))
    at_bound = np.where(at <= BOUND_SHARE, -1, np.where(at >= 1.0 - BOUND_SHARE, 1, 0))
    pushed = zip(at_bound, slope, sd, strict=True)
    inward = np.array([_inward(-float(b * s), float(e)) if b else np.nan for b, s, e in pushed])
    return ParameterPosterior(sd, prior, covariance / np.outer(sd, sd), misfit, at_bound, inward)


def _inward(slope: float, sd: float) -> float:
    """The 68 % point of exp(-slope t - t^2 / (2 sd^2)), t >= 0: a normal distribution cut at the bound.

    slope: by which the data push against the bound; no less than none.
    """
    centre = -max(slope, 0.0) * sd**2
    outside = ndtr(-centre / sd)
    tail = (1.0 - outside) * (1.0 - ONE_SD)
    if tail < 1e-12:  # far in the tail the distribution is exponential
        return float(-np.log(1.0 - ONE_SD) / max(slope, 1e-300))
    return float(centre - sd * ndtri(tail))
