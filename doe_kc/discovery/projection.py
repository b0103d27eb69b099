"""Removes from residuals and columns what re-tuning can absorb, the priors of the parameters respected."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import cholesky, solve_triangular
from scipy.sparse import csc_array

from doe_kc.ground.typing import FloatArray


@dataclass(frozen=True)
class Projection:
    """Orthogonal complement of all that a fitted model can do to first order, effects included.

    In the rows of the data, (M,), followed by those of the prior, (d,). Inner products of projected rows
    are those of C^-1, C = S + J P P J' the covariance of the data with the parameters marginalized.
    """

    jacobian: FloatArray
    """(M, n) derivative to all unknowns; not copied, however few of them may move."""
    prior_sd: FloatArray
    """(d,) standard deviations of the prior of what can be moved."""
    offset: FloatArray
    """(d,) of the fitted point from the prior's mean, in its standard deviations."""
    free: NDArray[np.int_]
    """(d,) columns of what can be moved; parameters held at a bound still count as free."""
    gram: FloatArray | None = None
    """(d, d) J'J + P^-2 where it is known."""

    @cached_property
    def _root(self) -> FloatArray:
        """(d, d) lower Cholesky factor L of J'J + P^-2: [J; P^-1] L'^-1 is an orthonormal basis.

        The normal equations serve: the prior bounds their condition, and the factor takes a quarter of the
        time and none of the memory of a QR decomposition.
        """
        gram = self.gram
        if gram is None:
            own = self.jacobian[:, self.free]
            gram = own.T @ own + np.diag(self.prior_sd**-2.0)
        return np.asarray(cholesky(gram, lower=True))

    def __call__(self, rows: FloatArray) -> FloatArray:
        """(M + d, ...) of changes of the residual (M,) or (M, k)."""
        return self._complement(rows, np.zeros((self.offset.size, *rows.shape[1:])))

    def residual(self, rows: FloatArray) -> FloatArray:
        """(M + d,) of a residual (M,) itself; its square is the cost after re-tuning."""
        return self._complement(rows, self.offset)

    def products(self, rows: csc_array, residual: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Inner products (k, k) of projected sparse changes (M, k), and (k,) of them with a residual (M,).

        Without the projected rows, which are dense.
        """
        absorbed = self._coordinates((rows.T @ self.jacobian).T[self.free])
        slope = self._coordinates(self._pulled(residual) + self.offset / self.prior_sd)
        gram = (rows.T @ rows).toarray() - absorbed.T @ absorbed
        return np.asarray(gram), np.asarray(rows.T @ residual - absorbed.T @ slope)

    def _pulled(self, rows: FloatArray) -> FloatArray:
        """(d, ...) J' rows, of what can be moved."""
        return np.asarray((self.jacobian.T @ rows)[self.free])

    def _coordinates(self, pulled: FloatArray) -> FloatArray:
        """(d, ...) in the orthonormal basis, of [J; P^-1]' times rows."""
        return np.asarray(solve_triangular(self._root, pulled, lower=True))

    def _complement(self, rows: FloatArray, prior: FloatArray) -> FloatArray:
        weight = (1.0 / self.prior_sd).reshape(-1, *[1] * (rows.ndim - 1))
        coordinates = self._coordinates(self._pulled(rows) + weight * prior)
        move = solve_triangular(self._root, coordinates, lower=True, trans="T")
        every = np.zeros((self.jacobian.shape[1], *rows.shape[1:]))
        every[self.free] = move
        return np.concatenate([rows - self.jacobian @ every, prior - weight * move])
