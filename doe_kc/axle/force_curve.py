"""Slopes of the monotone cubic through the points of a force curve (PCHIP), as the axle's values.

Reference: F. N. Fritsch, J. Butland, A method for constructing local monotone piecewise cubic
interpolants, SIAM J. Sci. Stat. Comput. 5(2), 1984, as in `scipy.interpolate.PchipInterpolator`.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from doe_kc.ground.typing import FloatArray

STEEPEST_CURVE = 1e12
"""N/mm or Nm/deg between two points of a force curve: far above any part, far below what arithmetic holds."""


def curve_values(prefix: str, x: FloatArray, y: FloatArray) -> Mapping[str, float]:
    """Axle values that a symbolic curve reads: abscissas, ordinates and slopes at the points."""
    slopes = pchip_slopes(x, y)
    out: dict[str, float] = {}
    for i, (xi, yi, mi) in enumerate(zip(x, y, slopes, strict=True)):
        out |= {f"{prefix}.x{i}": float(xi), f"{prefix}.y{i}": float(yi), f"{prefix}.m{i}": float(mi)}
    return out


def pchip_slopes(x: FloatArray, y: FloatArray) -> FloatArray:
    """(n,) slopes of the monotone cubic at its n >= 2 points, bit for bit those of SciPy.

    Written out because every command reads an axle, and SciPy's interpolators take half a second to import.
    The slope at the last point is that of the last cubic at its end, as SciPy's `derivative` says it.
    """
    width = np.diff(x)
    chord = np.diff(y) / width
    if x.size == 2:
        slopes = np.array([chord[0], chord[0]])
    else:
        slopes = np.zeros_like(chord, shape=x.size)
        w1, w2 = 2.0 * width[1:] + width[:-1], width[1:] + 2.0 * width[:-1]
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            harmonic = 1.0 / ((w1 / chord[:-1] + w2 / chord[1:]) / (w1 + w2))
        extremum = (np.sign(chord[1:]) != np.sign(chord[:-1])) | (chord[1:] == 0.0) | (chord[:-1] == 0.0)
        slopes[1:-1] = np.where(extremum, 0.0, harmonic)
        slopes[0] = _end_slope(width[0], width[1], chord[0], chord[1])
        slopes[-1] = _end_slope(width[-1], width[-2], chord[-1], chord[-2])
    h, first, last = width[-1], slopes[-2], slopes[-1]
    bend = (first + last - 2.0 * chord[-1]) / h
    slopes[-1] = first + 2.0 * ((chord[-1] - first) / h - bend) * h + 3.0 * (bend / h) * (h * h)
    return slopes


def _end_slope(h0: float, h1: float, m0: float, m1: float) -> float:
    """Three-point estimate that keeps the shape: C. Moler, Numerical Computing with MATLAB, 2004, 3.6."""
    slope = ((2.0 * h0 + h1) * m0 - h0 * m1) / (h0 + h1)
    if np.sign(slope) != np.sign(m0):
        return 0.0
    if np.sign(m0) != np.sign(m1) and abs(slope) > 3.0 * abs(m0):
        return 3.0 * m0
    return float(slope)
