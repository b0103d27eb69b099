"""What bounds leave of a Gaussian: unknowns that they hold back, integrated along their half-lines, and sizes
that cannot be negative."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.special import log_ndtr, ndtr, ndtri

from doe_kc.ground.typing import FloatArray


def log_kept(covariance: FloatArray, gradient: FloatArray, held: NDArray[np.bool_]) -> float:
    """ln of the share of the Gaussian that unknowns at a bound keep: each has a half-line, with a slope.

    The integral of exp(-g x - S x^2 / 2) over x >= 0, g the slope and S the curvature with all that is free
    following, over that of the whole Gaussian about the bound; between those held only the curvatures count,
    not what they do to each other. covariance: (d, d). gradient: (d,). held: (d,).
    """
    places = np.flatnonzero(held)
    if not places.size:
        return 0.0
    curvature = np.linalg.inv(covariance[np.ix_(places, places)])
    own = np.diag(curvature)
    slope = np.abs(gradient[places])
    tails = 0.5 * slope**2 / own + log_ndtr(-slope / np.sqrt(own)) - 0.5 * np.log(own)
    return float(np.sum(tails) + 0.5 * np.linalg.slogdet(curvature)[1])


def half_line_moments(centre: float, sd: float) -> tuple[float, float]:
    """Mean and standard deviation of what is >= 0 of a Gaussian; sd > 0.

    With a = centre / sd and the inverse Mills ratio m = phi(a) / Phi(a): centre + m sd, and
    sd sqrt(1 - a m - m^2) (N. L. Johnson, S. Kotz, N. Balakrishnan, Continuous Univariate Distributions 1,
    1994, 13.10.1). Of one that the data do not see, centre 0, 0.80 sd and 0.60 sd.
    """
    at = centre / sd
    mills = float(np.exp(-0.5 * at**2 - log_ndtr(at)) / np.sqrt(2.0 * np.pi))
    return centre + mills * sd, sd * float(np.sqrt(max(0.0, 1.0 - at * mills - mills**2)))


def half_line_limit(centre: float, sd: float, level: float) -> float:
    """What is >= 0 of a Gaussian stays below it with the probability Phi(level); sd > 0."""
    return centre + sd * float(ndtri(1.0 - ndtr(-level) * ndtr(centre / sd)))
