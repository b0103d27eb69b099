"""Inner products of residuals and their changes once re-tuning has taken what it can absorb.

The priors of the parameters are respected.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import cholesky, solve_triangular
from scipy.sparse import csc_array

from doe_kc.discovery.jacobian import Jacobian
from doe_kc.discovery.thresholds import NULL_SHARE
from doe_kc.ground.typing import FloatArray


@dataclass(frozen=True)
class Changes:
    """k changes of a residual, or the residual itself, with their products with the derivatives."""

    rows: FloatArray
    """(M, k)."""
    pulled: FloatArray
    """(n, k) J' rows: all that a projection takes of the derivatives, whatever it holds."""
    is_residual: bool = False
    """Whether they are the residual itself, to which the prior's rows belong."""

    def columns(self, places: NDArray[np.int_] | slice) -> Changes:
        """Some of the changes."""
        return Changes(self.rows[:, places], self.pulled[:, places], self.is_residual)


def changes(jacobian: Jacobian, rows: FloatArray, *, is_residual: bool = False) -> Changes:
    """rows: (M,) or (M, k). is_residual: whether they are the residual itself."""
    own = rows.reshape(rows.shape[0], -1)
    return Changes(own, jacobian.pulled(own), is_residual)


@dataclass(frozen=True)
class Projection:
    """Orthogonal complement of all that a fitted model can do to first order, effects included.

    In the rows of the data, (M,), followed by those of the prior, (d,). Inner products of projected rows
    are those of C^-1, C = S + J P P J' the covariance of the data with the parameters marginalized. They
    follow from products with the derivatives, a'b - (J'a)' H^-1 (J'b), without the projected rows.
    """

    jacobian: Jacobian
    """(M, n) derivative to all unknowns, however few of them may move."""
    prior_sd: FloatArray
    """(d,) standard deviations of the prior of what can be moved."""
    offset: FloatArray
    """(d,) of the fitted point from the prior's mean, in its standard deviations."""
    free: NDArray[np.int_]
    """(d,) columns of what can be moved; parameters held at a bound still count as free."""
    gram: FloatArray
    """(d, d) H = J'J + P^-2."""

    @cached_property
    def _root(self) -> FloatArray:
        """(d, d) lower Cholesky factor L of H: [J; P^-1] L'^-1 is an orthonormal basis.

        The normal equations serve: the prior bounds their condition, and the factor takes a quarter of the
        time and none of the memory of a QR decomposition.
        """
        return np.asarray(cholesky(self.gram, lower=True))

    def inner(self, one: Changes, other: Changes) -> FloatArray:
        """(k, l) inner products of projected changes, or with the projected residual."""
        product = one.rows.T @ other.rows - self._coordinates(one).T @ self._coordinates(other)
        both = one.is_residual and other.is_residual
        return np.asarray(product + float(self.offset @ self.offset) if both else product)

    def gram_of(self, rows: Changes) -> FloatArray:
        """(k, k) inner products of projected changes with each other."""
        own = self._coordinates(rows)
        product = rows.rows.T @ rows.rows - own.T @ own
        return np.asarray(product + float(self.offset @ self.offset) if rows.is_residual else product)

    def squares(self, rows: Changes) -> FloatArray:
        """(k,) squared lengths of projected changes; of the projected residual the cost after re-tuning.

        0 where what is left is rounding.
        """
        before = np.sum(rows.rows**2, axis=0) + float(self.offset @ self.offset) * rows.is_residual
        left = before - np.sum(self._coordinates(rows) ** 2, axis=0)
        return np.asarray(np.where(left > NULL_SHARE * before, left, 0.0))

    def moves(self, rows: Changes) -> FloatArray:
        """(d, k) by which what can be moved follows changes, in standard deviations of its prior."""
        back = solve_triangular(self._root, self._coordinates(rows), lower=True, trans="T")
        return np.asarray(-back / self.prior_sd[:, None])

    def remaining(self, rows: Changes) -> FloatArray:
        """(M, k) what re-tuning leaves of changes in the rows of the data."""
        every = np.zeros((self.jacobian.size, rows.rows.shape[1]))
        every[self.free] = self.prior_sd[:, None] * self.moves(rows)
        return rows.rows + self.jacobian.moved(every)

    def products(self, rows: csc_array, residual: Changes) -> tuple[FloatArray, FloatArray]:
        """Inner products (k, k) of projected sparse changes (M, k), and (k,) of them with the residual."""
        absorbed = self._triangular(self.jacobian.pulled(rows)[self.free])
        gram = (rows.T @ rows).toarray() - absorbed.T @ absorbed
        along = rows.T @ residual.rows - absorbed.T @ self._coordinates(residual)
        return np.asarray(gram), np.asarray(along[:, 0])

    def _coordinates(self, rows: Changes) -> FloatArray:
        """(d, k) in the orthonormal basis."""
        pulled = rows.pulled[self.free]
        return self._triangular(
            pulled + (self.offset / self.prior_sd)[:, None] if rows.is_residual else pulled
        )

    def _triangular(self, pulled: FloatArray) -> FloatArray:
        return np.asarray(solve_triangular(self._root, pulled, lower=True, check_finite=False))
