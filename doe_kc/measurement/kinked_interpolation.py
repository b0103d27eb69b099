"""Interpolation of a curve that has a kink between its points, such as a bump stop's contact."""

from __future__ import annotations

import numpy as np
from scipy.interpolate import PchipInterpolator

from doe_kc.typing import FloatArray

_STENCIL = 3


def interpolate_kinked(grid: FloatArray, values: FloatArray, at: FloatArray) -> FloatArray:
    """(m,) values at `at` (m,) of a curve known at `grid` (n,), n >= 6, smooth but for kinks.

    In each cell the parabolas through the three points on its left and the three on its right are
    extrapolated. Where they cross inside the cell the curve follows the left one up to the crossing and
    the right one from there, so the kink stays sharp; elsewhere PCHIP.
    Source: subcell resolution, Harten, J. Comput. Phys. 83 (1989) 148.
    """
    out: FloatArray = PchipInterpolator(grid, values)(at)
    cell = np.clip(np.searchsorted(grid, at, side="right") - 1, 0, grid.size - 2)
    inside = (cell >= _STENCIL - 1) & (cell + _STENCIL < grid.size)
    for i in np.unique(cell[inside]):
        here = cell == i
        kinked = _subcell(grid, values, int(i), at[here])
        if kinked is not None:
            out[here] = kinked
    return out


def _subcell(grid: FloatArray, values: FloatArray, i: int, at: FloatArray) -> FloatArray | None:
    """Values in cell i when its two extrapolations cross there, else None."""
    before = slice(i - _STENCIL + 1, i + 1)
    after = slice(i + 1, i + 1 + _STENCIL)
    gap_left = values[i] - _parabola(grid[after], values[after], grid[i : i + 1])[0]
    gap_right = _parabola(grid[before], values[before], grid[i + 1 : i + 2])[0] - values[i + 1]
    if gap_left * gap_right >= 0.0:
        return None
    left = _parabola(grid[before], values[before], at)
    right = _parabola(grid[after], values[after], at)
    return np.where(np.sign(left - right) == np.sign(gap_left), left, right)


def _parabola(x: FloatArray, y: FloatArray, at: FloatArray) -> FloatArray:
    """Lagrange parabola through three points."""
    a, b, c = (at - x[k] for k in range(_STENCIL))
    out: FloatArray = (
        y[0] * b * c / ((x[0] - x[1]) * (x[0] - x[2]))
        + y[1] * a * c / ((x[1] - x[0]) * (x[1] - x[2]))
        + y[2] * a * b / ((x[2] - x[0]) * (x[2] - x[1]))
    )
    return out
