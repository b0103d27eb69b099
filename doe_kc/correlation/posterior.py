"""What the data say of each variable: standard deviations from the Jacobian, and what they cannot see."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import cho_factor, cho_solve

from doe_kc.typing import FloatArray

VISIBLE = 0.5
"""A variable is visible when the measurement at least halves its prior standard deviation."""
AT_BOUND = 0.005
"""Share of the range within which a variable counts as being at its bound: half a step of 101 levels."""


@dataclass(frozen=True)
class Posterior:
    """Linear Gaussian view at a design. All (d,), in places u.

    sd: sqrt(diag((J'J + P^-2)^-1)), J in standard deviations of the data, P the prior sd.
    prior: P. correlation: (d, d).
    """

    sd: FloatArray
    prior: FloatArray
    correlation: FloatArray

    @property
    def visible(self) -> NDArray[np.bool_]:
        """(d,) whether the measurement at least halves the prior sd."""
        return np.asarray(self.sd <= VISIBLE * self.prior)


def posterior(jacobian: FloatArray, prior: FloatArray) -> Posterior:
    """Posterior of d variables from the whitened Jacobian (M, d) and the prior sd (d,)."""
    hessian = jacobian.T @ jacobian + np.diag(prior**-2.0)
    covariance = np.asarray(cho_solve(cho_factor(hessian), np.eye(prior.size)))
    sd = np.sqrt(np.diag(covariance))
    return Posterior(sd, prior, covariance / np.outer(sd, sd))
