"""Derivatives of a residual in blocks: most of their columns are those of nuisances that all models share."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csc_array

from doe_kc.discovery.linear_nuisances import LinearNuisances
from doe_kc.ground.typing import FloatArray


@dataclass(frozen=True)
class Jacobian:
    """J (M, n): derivatives to parameters and calibrations, linear nuisances, then amplitudes."""

    own: FloatArray
    """(M, n - l) all columns but those of the linear nuisances."""
    start: int = 0
    """Place in z of the first linear nuisance."""
    nuisances: LinearNuisances | None = None
    """Linear nuisances, l of them; None without any."""
    weights: FloatArray | None = None
    """(l,) factor of each of their columns: 0 for the trace of an effect that is in the model."""
    normal: FloatArray | None = None
    """(n, n) J'J where it is known."""

    @property
    def dense(self) -> FloatArray:
        """(M, n) the whole matrix."""
        return self.rows(slice(None))

    @property
    def size(self) -> int:
        """n, the number of columns."""
        return int(self.own.shape[1]) + self._count

    @property
    def _count(self) -> int:
        return 0 if self.nuisances is None else self.nuisances.count

    @property
    def _linear(self) -> slice:
        return slice(self.start, self.start + self._count)

    @cached_property
    def _places(self) -> NDArray[np.int_]:
        """(n - l,) of the own columns in z."""
        return np.delete(np.arange(self.size), self._linear)

    @cached_property
    def gram(self) -> FloatArray:
        """(n, n) J'J."""
        if self.normal is not None:
            return self.normal
        if self.nuisances is None:
            return np.asarray(self.own.T @ self.own)
        assert self.weights is not None
        out = np.empty((self.size, self.size))
        mixed = (self.nuisances.columns.T @ self.own) * self.weights[:, None]
        out[np.ix_(self._places, self._places)] = self.own.T @ self.own
        out[self._linear, self._places] = mixed
        out[self._places, self._linear] = mixed.T
        out[self._linear, self._linear] = self.nuisances.gram * np.outer(self.weights, self.weights)
        return out

    @property
    def normal_only(self) -> Jacobian:
        """J'J alone, without the derivatives, which are most of the memory: none of its rows is there."""
        nuisances = None if self.nuisances is None else self.nuisances.names_only
        return replace(self, own=self.own[:0].copy(), nuisances=nuisances, normal=self.gram)

    def rows(self, places: slice | NDArray[np.int_] | NDArray[np.bool_]) -> FloatArray:
        """(k, n) some rows of the whole matrix."""
        if self.nuisances is None:
            return self.own[places]
        assert self.weights is not None
        before, after = self.own[places, : self.start], self.own[places, self.start :]
        return np.hstack([before, self.nuisances.columns[places] * self.weights, after])

    def pulled(self, rows: FloatArray | csc_array) -> FloatArray:
        """(n, ...) J' rows, of (M,) or (M, k), dense or sparse."""
        own = np.asarray((rows.T @ self.own).T)
        if self.nuisances is None:
            return own
        assert self.weights is not None
        out = np.empty((self.size, *own.shape[1:]))
        out[self._places] = own
        linear = np.asarray((rows.T @ self.nuisances.columns).T)
        out[self._linear] = linear * self.weights.reshape(-1, *[1] * (own.ndim - 1))
        return out

    def moved(self, step: FloatArray) -> FloatArray:
        """(M, ...) J step, of (n,) or (n, k)."""
        out = np.asarray(self.own @ step[self._places])
        if self.nuisances is None:
            return out
        assert self.weights is not None
        weights = self.weights.reshape(-1, *[1] * (step.ndim - 1))
        return np.asarray(out + self.nuisances.columns @ (weights * step[self._linear]))

    def ordered(self, order: NDArray[np.int_]) -> Jacobian:
        """The same with the amplitudes in another order. order: (n,) places of all columns."""
        places = np.delete(order, self._linear)
        own = np.where(places >= self._linear.stop, places - self._count, places)
        return replace(self, own=self.own[:, own], normal=self.gram[np.ix_(order, order)])

    def scaled(self, factors: FloatArray) -> Jacobian:
        """The own columns by factors (n,)."""
        return replace(self, own=self.own * factors[self._places], normal=None)

    def secant(self, missed: FloatArray, step: FloatArray) -> Jacobian:
        """The derivatives that say what a step did, changed along it alone (C. G. Broyden, Mathematics of
        Computation 19, 1965). Those to linear nuisances stay what they are.

        missed: (M,) what the residual changed beyond J step.
        """
        moved = step.copy()
        moved[self._linear] = 0.0
        square = float(moved @ moved)
        if square == 0.0:
            return self
        direction = moved / square
        half = np.outer(self.pulled(missed) + 0.5 * float(missed @ missed) * direction, direction)
        own = self.own + np.outer(missed, direction[self._places])
        return Jacobian(own, self.start, self.nuisances, self.weights, self.gram + half + half.T)
