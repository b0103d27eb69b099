"""What bounds leave of a Gaussian: unknowns that they hold back, integrated along their half-lines."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.special import log_ndtr

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
