"""What the data say of each variable: standard deviations from the Jacobian, and what they cannot see."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import cho_factor, cho_solve
from scipy.special import ndtr, ndtri

from doe_kc.correlation.least_squares import bounded_step, normal_equations
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

    sd: sqrt(diag((J'J / m^2 + P^-2)^-1)), J in standard deviations of the data, P the prior sd, m the misfit;
    no more than the prior allows. offset: most probable place between the bounds less the design's. prior: P.
    correlation: (d, d). misfit: m, whitened RMS of the residuals, 1 at least: what the model does not explain
    makes its parameters as much less certain (Birge's ratio). at_bound: -1 lower, +1 upper, 0 between.
    inward: distance from that bound within which the value lies with a probability of 68 %, nan between the
    bounds: there a standard deviation means nothing.
    """

    sd: FloatArray
    offset: FloatArray
    prior: FloatArray
    correlation: FloatArray
    misfit: float
    at_bound: NDArray[np.int_]
    inward: FloatArray

    @property
    def rms_error(self) -> FloatArray:
        """(d,) root mean square of the car's value less the design's: sqrt(sd^2 + offset^2).

        A rating has many designs that are nearly as good, and its best one need not be the most probable.
        """
        return np.hypot(self.sd, self.offset)

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
    start: FloatArray | None = None,
    nuisance: FloatArray | None = None,
) -> ParameterPosterior:
    """Posterior of d variables from the whitened Jacobian (M, d) and the prior sd (d,).

    residual: (M,) whitened, by default noise. point: (d,) the design, by default between all bounds. start:
    (d,) centre of the prior, by default the design. nuisance: (M, q) derivatives of the residual to numbers
    that nobody asks for and that are not known either, in prior standard deviations of each.
    """
    count = prior.size
    left = np.zeros(len(jacobian)) if residual is None else residual
    at = np.full(count, 0.5) if point is None else point
    others = np.zeros((len(jacobian), 0)) if nuisance is None else nuisance
    misfit = max(1.0, float(np.sqrt(np.mean(left**2)))) if left.size else 1.0
    weighted = np.hstack([jacobian, others]) / misfit
    moved = np.concatenate([at - (at if start is None else start), np.zeros(others.shape[1])])
    weight = np.concatenate([prior**-2.0, np.ones(others.shape[1])])
    hessian, gradient = normal_equations(weighted, left / misfit, weight, moved)
    covariance = np.asarray(cho_solve(cho_factor(hessian), np.eye(weight.size)))[:count, :count]
    sd = np.sqrt(np.diag(covariance))
    free = np.full(others.shape[1], np.inf)
    step = bounded_step(hessian, gradient, np.append(-at, -free), np.append(1.0 - at, free))
    slope = (gradient + hessian @ step)[:count]
    offset = step[:count]
    at_bound = np.where(at <= BOUND_SHARE, -1, np.where(at >= 1.0 - BOUND_SHARE, 1, 0))
    inside = -at_bound * (offset - slope * sd**2)
    inward = np.array([_inward(c, e) if b else np.nan for b, c, e in zip(at_bound, inside, sd, strict=True)])
    correlation = covariance / np.outer(sd, sd)
    return ParameterPosterior(sd, offset, prior, correlation, misfit, at_bound, inward)


def _inward(centre: float, sd: float) -> float:
    """The 68 % point of exp(-(t - centre)^2 / (2 sd^2)), t >= 0: a normal distribution cut at the bound.

    centre: of the distribution before it is cut, < 0 where the data push against the bound.
    """
    outside = ndtr(-centre / sd)
    tail = (1.0 - outside) * (1.0 - ONE_SD)
    if tail < 1e-12:  # far in the tail the distribution is exponential
        return float(-np.log(1.0 - ONE_SD) * sd**2 / -centre)
    return float(centre - sd * ndtri(tail))
