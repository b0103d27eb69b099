"""The curves that an axle shows when its pads are raised, predicted from its curves at nominal height."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from scipy.interpolate import CubicSpline, PchipInterpolator

from doe_kc.curves import CaseCurves
from doe_kc.measurement.kinked_interpolation import interpolate_kinked
from doe_kc.typing import FloatArray

SIDE_SIGN: Mapping[str, float] = {"wc_y": -1.0}
"""Factor that maps the right wheel's curve on the left's."""

_SLOPE_ZONE = 10.0


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
        return float(PchipInterpolator(self.pad, self.curves["wc_z"])(h))

    def kinematic(self, response: str, travel: FloatArray, h: float) -> FloatArray:
        """(m,) change of `response` from the raised static state at wheel travel (m,) from there."""
        curve = self._over_travel(response)
        datum = self.travel(h)
        out: FloatArray = curve(travel + datum) - curve(datum)
        return out

    def load(self, pad: FloatArray, h: float) -> FloatArray:
        """(m,) tyre load in N at pad travel (m,) from the raised static state."""
        return interpolate_kinked(self.pad, self.curves["tyre_load"], pad + h)

    def static_rate(self) -> float:
        """Ride rate at static, N/mm."""
        ahead, behind = self.load(np.array([1.0, -1.0]), 0.0)
        return float(ahead - behind) / 2.0

    def stop_force(self, pad: FloatArray, h: float) -> FloatArray:
        """(m,) part of that load (N) beyond the smooth ride rate: what the stops add, from the curve alone.

        The rate without stops is taken as linear in travel, fitted within ±10 mm of the model's static.
        """
        near = np.linspace(-_SLOPE_ZONE, _SLOPE_ZONE, 21)
        smooth = np.polynomial.Polynomial.fit(near, self.load(near, 0.0), 2)
        out: FloatArray = self.load(pad, h) - smooth(pad + h)
        return out

    def interpolation_sd(self, response: str, travel: FloatArray, h: float) -> FloatArray:
        """(m,) doubt about the curve between its points: half the difference of two interpolants."""
        if response == "tyre_load":
            other = PchipInterpolator(self.pad, self.curves[response])(travel + h)
            rough: FloatArray = np.abs(other - self.load(travel, h)) / 2.0
            return rough
        at = travel + self.travel(h)
        other = PchipInterpolator(self.curves["wc_z"], self.curves[response])(at)
        out: FloatArray = np.abs(self._over_travel(response)(at) - other) / 2.0
        return out

    def _over_travel(self, response: str) -> CubicSpline:
        return CubicSpline(self.curves["wc_z"], self.curves[response])
