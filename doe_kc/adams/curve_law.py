"""Which law the points of a force curve follow: a line, a line with a cubic part, or none that is simpler."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from doe_kc.adams.property_files import ForceTable
from doe_kc.axle.force_curve import pchip_slopes
from doe_kc.ground.typing import FloatArray

AGREEMENT = 1e-7
"""Largest difference of a point from a law, relative to the largest force: what files are rounded to."""
LAW_ROUNDING = 1e-14
"""Of floating-point arithmetic, relative to the largest force."""


@dataclass(frozen=True)
class CurveLaw:
    """F = stiffness (d + cubic d^3), or the points themselves where they follow neither.

    stiffness: N/mm or Nm/deg. cubic: 1/mm^2. points: (n, 2), None for a law. gap: largest difference between
    points, in the curve's unit, of an Akima spline from the monotone cubic taken here; 0 for a law.
    """

    stiffness: float = 0.0
    cubic: float = 0.0
    points: FloatArray | None = None
    gap: float = 0.0


def curve_law(curve: ForceTable, *, turn: bool) -> CurveLaw:
    """The simplest law within `AGREEMENT` of all points. turn: about an axis, without a cubic part."""
    x, y = curve.x, curve.y
    size = float(np.abs(y).max())
    stiffness = float(x @ y / (x @ x))
    if size > 0.0 and stiffness > 0.0 and _apart(x, y, stiffness, 0.0) <= AGREEMENT * size:
        close = _close(_apart(x, y, stiffness, 0.0), size)
        return CurveLaw(_shortest(stiffness, lambda k: _apart(x, y, k, 0.0) <= close))
    if not turn and x.size > 4 and size > 0.0:
        (slope, bend), *_ = np.linalg.lstsq(np.column_stack([x, x**3]), y, rcond=None)
        if slope > 0.0 and bend >= 0.0 and _apart(x, y, slope, bend / slope) <= AGREEMENT * size:
            close = _close(_apart(x, y, slope, bend / slope), size)
            k = _shortest(float(slope), lambda k: _apart(x, y, k, bend / k) <= close)
            close = _close(_apart(x, y, k, bend / k), size)
            return CurveLaw(k, _shortest(float(bend / k), lambda c: _apart(x, y, k, c) <= close))
    return CurveLaw(points=np.column_stack([x, y]), gap=_akima_gap(x, y))


def _apart(x: FloatArray, y: FloatArray, stiffness: float, cubic: float) -> float:
    """Largest distance of a point from the law."""
    return float(np.abs(y - stiffness * (x + cubic * x**3)).max())


def _close(residual: float, size: float) -> float:
    """Distance within which a shorter number says the same: that of the points themselves, and rounding."""
    return 1.5 * residual + LAW_ROUNDING * size


def _shortest(value: float, agrees: Callable[[float], bool]) -> float:
    """The number with the fewest significant digits that agrees; the value itself where none does."""
    rounded = (float(f"{value:.{digits}g}") for digits in range(1, 17))
    return next((v for v in rounded if agrees(v)), value)


def _akima_gap(x: FloatArray, y: FloatArray) -> float:
    from scipy.interpolate import Akima1DInterpolator, CubicHermiteSpline

    if x.size < 3:
        return 0.0
    fine = np.linspace(x[0], x[-1], 40 * x.size)
    monotone = CubicHermiteSpline(x, y, pchip_slopes(x, y))(fine)
    return float(np.abs(Akima1DInterpolator(x, y)(fine) - monotone).max())
