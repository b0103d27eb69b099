"""Removes from residuals and columns what re-tuning can absorb, the priors of the parameters respected."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.linalg import qr

from doe_kc.discovery.fit import Fit
from doe_kc.typing import FloatArray


@dataclass(frozen=True)
class Projection:
    """Orthogonal complement of all that a fitted model can do to first order, effects included.

    In the rows of the data, (M,), followed by those of the prior, (d,). Inner products of projected rows
    are those of C^-1, C = S + J P P J' the covariance of the data with the parameters marginalized.
    basis: (M + d, d) orthonormal. offset: (d,) of the fitted point from the prior's mean, in its sd.
    """

    basis: FloatArray
    offset: FloatArray

    def __call__(self, rows: FloatArray) -> FloatArray:
        """(M + d, ...) of changes of the residual (M,) or (M, k)."""
        return self._complement(np.concatenate([rows, np.zeros((self.offset.size, *rows.shape[1:]))]))

    def residual(self, rows: FloatArray) -> FloatArray:
        """(M + d,) of a residual (M,) itself; its square is the cost after re-tuning."""
        return self._complement(np.concatenate([rows, self.offset]))

    def _complement(self, padded: FloatArray) -> FloatArray:
        return np.asarray(padded - self.basis @ (self.basis.T @ padded))


def projection(fit: Fit, *, effects: bool = True) -> Projection:
    """About a fitted model; parameters held at a bound still count as free.

    effects: whether the sizes of its effects are free too, or only the tunable parameters.
    """
    count = fit.z.size if effects else fit.model.dimension
    prior = fit.model.prior_sd[:count]
    stacked = np.vstack([fit.jacobian[:, :count], np.diag(1.0 / prior)])
    basis, _ = qr(stacked, mode="economic")
    return Projection(np.asarray(basis), (fit.z[:count] - fit.model.centre[:count]) / prior)
