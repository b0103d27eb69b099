"""Curves as coefficients of polynomials, rebuilt to a stated accuracy: a tenth of what a rig resolves.

The polynomials are orthonormal on the n inputs of a load case (evenly spaced: Gram polynomials),
so that coefficients are products with a matrix, and the highest degree gives every point back. Each curve has
as few coefficients, by `COEFFICIENTS`, as miss no point by half of its accuracy, and these are rounded so
that no point moves by the other half.
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
COEFFICIENTS = (3, 5, 8, 12, 16, 24, 32, 48)
"""Numbers of coefficients that are tried, then all n."""
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
    for count in (c for c in COEFFICIENTS if c < n):
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
    """(n, n) orthonormal polynomials at n distinct inputs, a column each, by rising degree."""
    return _polynomials(inputs.tobytes())


@lru_cache(maxsize=64)
def _polynomials(content: bytes) -> FloatArray:
    """Each is the one before times the input, less its parts along all before: Lanczos' method, whose result
    does not depend on the machine once it is made orthogonal twice (to 1e-14 for 201 inputs)."""
    inputs = np.frombuffer(content)
    n = inputs.size
    place = (2.0 * inputs - inputs[0] - inputs[-1]) / ((inputs[-1] - inputs[0]) or 1.0)
    out = np.zeros((n, n))
    out[:, 0] = 1.0 / np.sqrt(n)
    for k in range(1, n):
        column = place * out[:, k - 1]
        for _ in range(2):
            column = column - out[:, :k] @ (out[:, :k].T @ column)
        out[:, k] = column / np.linalg.norm(column)
    return out
