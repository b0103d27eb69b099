"""Whole curves as a few scores: principal components of curves over the designs, and back.

Reference: I. T. Jolliffe, Principal Component Analysis, 2nd ed., Springer 2002.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from doe_kc.errors import InputError
from doe_kc.typing import FloatArray

ROUND_OFF = 1e-13
"""Of the largest value: smaller differences of curves are none."""


@dataclass(frozen=True)
class Components:
    """mean: (N,) curve. basis: (q, N) orthonormal shapes, the strongest first. spread: (q,) standard
    deviation of each score over the designs. rest: (N,) mean square of what the basis leaves at each point.
    """

    mean: FloatArray
    basis: FloatArray
    spread: FloatArray
    rest: FloatArray

    def scores(self, curves: FloatArray) -> FloatArray:
        """(n, q) of curves (n, N)."""
        return np.asarray((curves - self.mean) @ self.basis.T)

    def curves(self, scores: FloatArray) -> FloatArray:
        """(n, N) of scores (n, q), unit of the curves."""
        return np.asarray(self.mean + scores @ self.basis)

    def curve_variance(self, variance: FloatArray) -> FloatArray:
        """(n, N) variance of the curves from that of independent scores (n, q), and what the basis leaves."""
        return np.asarray(variance @ self.basis**2 + self.rest)


def principal_components(curves: FloatArray, *, error: float, most: int | None = None) -> Components:
    """Fewest components that rebuild each of the curves (n, N) to `error`, root mean square over its points.

    error: unit of the curves, >= 0. most: never more components than this. Curves that are all alike give
    none. InputError for fewer than two curves or values that are not finite.
    """
    values = np.array(curves, dtype=float)
    if values.ndim != 2 or len(values) < 2 or not np.isfinite(values).all():
        raise InputError("curves: expected two or more rows of finite values; leave failed designs out.")
    mean = values.mean(axis=0)
    left, size, shapes = np.linalg.svd(values - mean, full_matrices=False)
    least = ROUND_OFF * float(np.abs(values).max())
    count = _fewest(left * size, values.shape[1], max(error, least))
    count = min(count, len(size) if most is None else most)
    rest = ((left[:, count:] * size[count:]) @ shapes[count:]) ** 2
    spread = size[:count] / np.sqrt(len(values))
    return Components(mean, shapes[:count], spread, rest.mean(axis=0))


def _fewest(scores: FloatArray, points: int, error: float) -> int:
    """Components after which the worst curve is within the error."""
    square = np.zeros((len(scores), scores.shape[1] + 1))
    square[:, :-1] = np.cumsum(scores[:, ::-1] ** 2, axis=1)[:, ::-1]
    worst = np.sqrt(square.max(axis=0) / points)
    return int(np.argmax(worst <= error))
