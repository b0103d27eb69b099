"""The curves that an axle shows when its pads are raised, predicted from those at nominal height."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from doe_kc.curves import CaseCurves
from doe_kc.ground.typing import FloatArray

if TYPE_CHECKING:
    from scipy.interpolate import CubicSpline, PchipInterpolator

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


SIDE_SIGN: Mapping[str, float] = {"wc_y": -1.0}
"""Factor that maps the right wheel's curve on the left's."""

_RATE_ZONE = 10.0
"""Half-width in mm of pad travel around static in which no stop is expected to act."""


def both_sides(response: str, curve: FloatArray) -> FloatArray:
    """(n,) mean of left and mirrored right curve (2, n)."""
    out: FloatArray = (curve[0] + SIDE_SIGN.get(response, 1.0) * curve[1]) / 2.0
    return out


@dataclass(frozen=True)
class ShiftedCurves:
    """Vertical motion of a model with the pads raised by h before the sweep.

    The equilibria are the same, their datum moves: with pad travel u, wheel travel z(u) and a response
    f as a function of z, the raised axle shows f(z + z(h)) - f(z(h)) for changes from static and
    F(u + h) for the tyre load. Exact for pads that carry both wheels alike.
    pad: (n,) mm. curves: response -> (n,), left wheel.
    """

    pad: FloatArray
    curves: Mapping[str, FloatArray]

    @classmethod
    def of(cls, case: CaseCurves) -> ShiftedCurves:
        """From the `vertical` curves of a model, both sides averaged."""
        return cls(case.input, {r: both_sides(r, c) for r, c in case.mean.items()})

    def travel(self, h: float) -> float:
        """Wheel travel z(h), mm."""
        return float(self._travel(h))

    def kinematic(self, response: str, travel: FloatArray, h: float) -> FloatArray:
        """(m,) change of `response` from the raised static state at wheel travel (m,) from there."""
        curve = self._over_travel[response]
        datum = self.travel(h)
        out: FloatArray = curve(travel + datum) - curve(datum)
        return out

    def kinematic_doubt(self, response: str, travel: FloatArray, h: float) -> FloatArray:
        """(m,) sd of the interpolation: half the difference of two interpolants."""
        at = travel + self.travel(h)
        difference = self._over_travel[response](at) - self._over_travel_pchip[response](at)
        out: FloatArray = np.abs(difference) / 2.0
        return out

    def load(self, pad: FloatArray, h: float) -> FloatArray:
        """(m,) tyre load in N at pad travel (m,) from the raised static state."""
        return self._load(pad + h)

    def load_doubt(self, pad: FloatArray, h: float) -> FloatArray:
        """(m,) sd of the interpolation, N: half the difference of sharp and rounded kink."""
        out: FloatArray = np.abs(self._load(pad + h) - self._load.smooth(pad + h)) / 2.0
        return out

    def stop_force(self, pad: FloatArray, h: float) -> FloatArray:
        """(m,) part of that load (N) beyond the smooth ride rate: what the stops add.

        The rate without stops is taken as linear in travel, fitted within ±10 mm of the model's static.
        """
        out: FloatArray = self._load(pad + h) - self._without_stops(pad + h)
        return out

    def static_rate(self) -> float:
        """Ride rate at static, N/mm."""
        return float(self._without_stops.deriv()(0.0))

    @cached_property
    def _travel(self) -> PchipInterpolator:
        from scipy.interpolate import PchipInterpolator

        return PchipInterpolator(self.pad, self.curves["wc_z"])

    @cached_property
    def _load(self) -> KinkedCurve:
        return KinkedCurve(self.pad, self.curves["tyre_load"])

    @cached_property
    def _without_stops(self) -> np.polynomial.Polynomial:
        near = np.linspace(-_RATE_ZONE, _RATE_ZONE, 21)
        return np.polynomial.Polynomial.fit(near, self._load(near), 2)

    @cached_property
    def _over_travel(self) -> dict[str, CubicSpline]:
        from scipy.interpolate import CubicSpline

        return {r: CubicSpline(self.curves["wc_z"], c) for r, c in self.curves.items()}

    @cached_property
    def _over_travel_pchip(self) -> dict[str, PchipInterpolator]:
        from scipy.interpolate import PchipInterpolator

        return {r: PchipInterpolator(self.curves["wc_z"], c) for r, c in self.curves.items()}
