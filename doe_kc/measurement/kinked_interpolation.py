"""Interpolation of a curve that has a kink between its points, such as a bump stop's contact."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from doe_kc.ground.typing import FloatArray

if TYPE_CHECKING:
    from scipy.interpolate import PchipInterpolator

_STENCIL = 3


@dataclass(frozen=True)
class KinkedCurve:
    """Curve known at `grid` (n,), strictly increasing, n >= 4, smooth but for kinks.

    In each cell the parabolas through the three points on its left and the three on its right are
    extrapolated. Where they cross inside the cell the curve follows the left one up to the crossing and
    the right one from there, so the kink stays sharp; elsewhere PCHIP.
    Source: subcell resolution, Harten, J. Comput. Phys. 83 (1989) 148.
    """

    grid: FloatArray
    values: FloatArray

    def __call__(self, at: FloatArray) -> FloatArray:
        """(m,) values at `at` (m,)."""
        out = self.smooth(at)
        cell = np.searchsorted(self.grid, at, side="right") - 1
        for i in self.kinked_cells:
            here = cell == i
            out[here] = self._subcell(i, at[here])
        return out

    def smooth(self, at: FloatArray) -> FloatArray:
        """(m,) PCHIP values, kinks rounded."""
        out: FloatArray = self._pchip(at)
        return out

    @cached_property
    def kinked_cells(self) -> tuple[int, ...]:
        """Cells [grid_i, grid_i+1] in which the extrapolations cross."""
        candidates = range(_STENCIL - 1, self.grid.size - _STENCIL)
        return tuple(i for i in candidates if self._gap_left(i) * self._gap_right(i) < 0.0)

    @cached_property
    def _pchip(self) -> PchipInterpolator:
        from scipy.interpolate import PchipInterpolator

        return PchipInterpolator(self.grid, self.values)

    def _gap_left(self, i: int) -> float:
        return float(self.values[i] - self._parabola(i + 1, self.grid[i : i + 1])[0])

    def _gap_right(self, i: int) -> float:
        first = i - _STENCIL + 1
        return float(self._parabola(first, self.grid[i + 1 : i + 2])[0] - self.values[i + 1])

    def _subcell(self, i: int, at: FloatArray) -> FloatArray:
        left, right = self._parabola(i - _STENCIL + 1, at), self._parabola(i + 1, at)
        return np.where(np.sign(left - right) == np.sign(self._gap_left(i)), left, right)

    def _parabola(self, first: int, at: FloatArray) -> FloatArray:
        """Lagrange parabola through the points first, first + 1, first + 2."""
        x, y = self.grid[first : first + _STENCIL], self.values[first : first + _STENCIL]
        a, b, c = (at - x[k] for k in range(_STENCIL))
        out: FloatArray = (
            y[0] * b * c / ((x[0] - x[1]) * (x[0] - x[2]))
            + y[1] * a * c / ((x[1] - x[0]) * (x[1] - x[2]))
            + y[2] * a * b / ((x[2] - x[0]) * (x[2] - x[1]))
        )
        return out
