"""Second-order polynomials that are orthonormal for uniform variables of the unit cube.

With t = 2 x - 1: linear sqrt(3) t, pure sqrt(5) (3 t² - 1) / 2, interaction 3 t t'. Each has mean 0 and
variance 1, and any two are uncorrelated: the lasso judges them alike.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from doe_kc.ground.typing import FloatArray

NONE = -1


@dataclass(frozen=True)
class Terms:
    """p terms: `first` (p,) variable, `second` (p,) the other, the same for a pure square, -1 for linear."""

    first: np.ndarray
    second: np.ndarray

    def __len__(self) -> int:
        return len(self.first)

    def chosen(self, which: np.ndarray) -> Terms:
        """Those at the places or marks `which`."""
        return Terms(self.first[which], self.second[which])


def all_terms(variables: int) -> Terms:
    """d linear, d pure and d (d - 1) / 2 interaction terms."""
    single = np.arange(variables)
    first, second = np.triu_indices(variables)
    return Terms(np.concatenate([single, first]), np.concatenate([np.full(variables, NONE), second]))


def features(terms: Terms, x: FloatArray) -> FloatArray:
    """(n, p) values of the terms at x (n, d)."""
    t = 2.0 * x - 1.0
    a, b = t[:, terms.first], t[:, terms.second]
    linear, pure = terms.second == NONE, terms.second == terms.first
    square = np.sqrt(5.0) * (1.5 * a**2 - 0.5)
    return np.where(linear, np.sqrt(3.0) * a, np.where(pure, square, 3.0 * a * b))


def feature_slopes(terms: Terms, x: FloatArray, coefficients: FloatArray) -> FloatArray:
    """(n, d) gradient of the polynomial with coefficients (p,)."""
    return np.asarray((jacobian(terms, x) * coefficients[:, None]).sum(axis=1))


def jacobian(terms: Terms, x: FloatArray) -> FloatArray:
    """(n, p, d) derivatives of the terms."""
    t = 2.0 * x - 1.0
    linear, pure = terms.second == NONE, terms.second == terms.first
    a, b = t[:, terms.first], t[:, terms.second]
    by_first = np.where(linear, 2.0 * np.sqrt(3.0), np.where(pure, 6.0 * np.sqrt(5.0) * a, 6.0 * b))
    out = np.zeros((len(x), len(terms), x.shape[1]))
    out[:, np.arange(len(terms)), terms.first] = by_first
    mixed = np.flatnonzero(~linear & ~pure)
    out[:, mixed, terms.second[mixed]] = 6.0 * a[:, mixed]
    return out
