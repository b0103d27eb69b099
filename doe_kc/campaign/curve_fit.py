"""Curves as coefficients of polynomials, rebuilt to a stated accuracy: a tenth of what a rig resolves.

The polynomials are orthonormal on the n inputs of a load case (discrete Chebyshev or Gram polynomials), so
that coefficients are products with a matrix, and the highest degree gives every point back. Each curve has
the lowest degree of `DEGREES` that misses no point by half of its accuracy, and its coefficients are rounded
so that no point moves by the other half.
Source: W. Gautschi, Orthogonal Polynomials: Computation and Approximation (2004), 1.5.2.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from doe_kc.curves import RESPONSE_UNITS
from doe_kc.ground.typing import FloatArray

FIT_ACCURACY: Mapping[str, float] = {"deg": 3e-4, "mm": 2e-3, "N": 0.4}
"""Unit of a response -> largest deviation of a rebuilt point."""
DEGREES = (3, 5, 8, 12, 16, 24, 32, 48)
"""Numbers of coefficients that are tried, then all n."""
UNIFORM = 1e-9
"""Share of the spacing by which inputs of equal spacing may be off."""
IntArray = NDArray[np.int32]


@dataclass(frozen=True)
class CurveFit:
    """Of k curves on the same inputs. counts: (k,) coefficients of each. steps: (sum of counts,) coefficients
    of all, in units of `coefficient_step`."""

    counts: NDArray[np.uint16]
    steps: IntArray


def coefficient_step(response: str, n: int) -> float:
    """Spacing of the rounded coefficients of a curve of n points: no point moves by more than half of its
    accuracy, since the absolute values of a row of an orthonormal matrix add up to at most the root of n."""
    return float(FIT_ACCURACY[RESPONSE_UNITS[response]] / np.sqrt(n))


def fitted(inputs: FloatArray, curves: FloatArray, steps: FloatArray) -> CurveFit:
    """inputs: (n,). curves: (k, n). steps: (k,) of `coefficient_step`.

    OverflowError for curves beyond what the coefficients can count.
    """
    n = inputs.size
    basis = polynomials(inputs)
    coefficients = curves @ basis
    half = steps * np.sqrt(n) / 2.0
    counts = np.full(len(curves), n)
    places, left, before = np.arange(len(curves)), curves, 0
    for count in (c for c in DEGREES if c < n):
        left = left - coefficients[places, before:count] @ basis[:, before:count].T
        more = np.abs(left).max(axis=1) > half[places]
        counts[places[~more]] = count
        places, left, before = places[more], left[more], count
        if not places.size:
            break
    kept = np.arange(n) < counts[:, None]
    rounded = np.rint(coefficients / steps[:, None])[kept]
    if not (np.abs(rounded) <= np.iinfo(np.int32).max).all():
        raise OverflowError("a curve has values beyond any axle's")
    return CurveFit(counts.astype(np.uint16), rounded.astype(np.int32))


def rebuilt(inputs: FloatArray, fit: CurveFit, steps: FloatArray) -> FloatArray:
    """(k, n) curves of a fit; ValueError where the numbers are not whole."""
    n = inputs.size
    kept = np.arange(n) < fit.counts[:, None]
    if fit.steps.size != kept.sum():
        raise ValueError("fewer coefficients than curves need")
    coefficients = np.zeros(kept.shape)
    coefficients[kept] = fit.steps
    return np.asarray((coefficients * steps[:, None]) @ polynomials(inputs).T)


def polynomials(inputs: FloatArray) -> FloatArray:
    """(n, n) orthonormal polynomials, a column each, by rising degree, at n inputs of equal spacing.

    At others unit vectors, with which a fit is rounding alone.
    """
    return _polynomials(inputs.tobytes())


@lru_cache(maxsize=64)
def _polynomials(content: bytes) -> FloatArray:
    inputs = np.frombuffer(content)
    n = inputs.size
    even = np.linspace(inputs[0], inputs[-1], n)
    if n < 2 or np.abs(inputs - even).max() > UNIFORM * abs(inputs[-1] - inputs[0]):
        return np.eye(n)
    return gram_polynomials(n)


@lru_cache(maxsize=16)
def gram_polynomials(n: int) -> FloatArray:
    """(n, n) at 0, 1, ..., n - 1: eigenvectors of their Jacobi matrix, which are exact for all degrees where
    the recurrence is not."""
    from scipy.linalg import eigh_tridiagonal

    k = np.arange(1, n)
    beside = np.sqrt(k**2 * (float(n) ** 2 - k**2) / (4.0 * (4.0 * k**2 - 1.0)))
    vectors = eigh_tridiagonal(np.full(n, (n - 1) / 2.0), beside)[1]
    return np.ascontiguousarray((vectors * np.sign(vectors[0])).T)
