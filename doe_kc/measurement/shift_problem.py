"""The linearised least-squares problem behind a ride-height estimate, and what production scatter adds."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from doe_kc.ground.typing import FloatArray
from doe_kc.measurement.shifted_curves import ShiftedCurves

KINEMATIC_SCATTER: Mapping[str, tuple[float, float, float]] = {
    "toe": (2.6e-3, 1.2e-6, 1.0e-8),
    "camber": (4.0e-4, 1.2e-6, 6.0e-9),
    "spin": (3.5e-4, 8.0e-7, 3.0e-9),
    "wc_x": (5.6e-3, 6.0e-6, 3.0e-8),
    "wc_y": (2.6e-3, 2.5e-6, 5.0e-9),
}
"""Response -> sd of the coefficients of z, z², z³ (deg or mm per mm, mm², mm³; z = wheel travel).

McPherson axle, hardpoints scattered by 1 mm per coordinate: a 350 mm lower arm tilts by 1/350 per mm,
which is the track slope; the others follow from solved variants of the reference axle.
"""

LOAD_OFFSET = 500.0
"""sd of the static tyre load, N: loading and preload differ from car to car and tell no ride height."""
RATE_SCATTER = 0.03
"""sd of the ride rate, fraction: springs, tyres, lever ratio."""
RATE_CURVATURE = 3e-3
"""sd of the coefficient of u² of the tyre load, N/mm²."""
STOP_SCATTER = 0.10
"""sd of a stop's force at given compression, fraction."""


def kinematic_modes(response: str, travel: FloatArray) -> FloatArray:
    """(n, 3) one-sigma changes of a kinematic curve over wheel travel (n,), zero at static."""
    powers: FloatArray = travel[:, None] ** np.arange(1, 4) * np.array(KINEMATIC_SCATTER[response])
    return powers


def load_modes(
    pad: FloatArray,
    rate: float,
    stops: FloatArray,
    stop_rate: FloatArray,
    *,
    bump: NDArray[np.bool_],
    stop_clearance_sd: float,
) -> FloatArray:
    """(n, 7) one-sigma changes of the tyre load over pad travel (n,), mm.

    Columns: static load, ride rate, its growth, force of bump and of rebound stop, their clearances.
    rate: N/mm at static. stops, stop_rate: (n,) force of the stops, N, and its slope, N/mm.
    bump: (n,) bool, on the bump side of the model's static state. stop_clearance_sd: mm at the wheel.
    """
    columns = [
        np.full(pad.size, LOAD_OFFSET),
        RATE_SCATTER * rate * pad,
        RATE_CURVATURE * pad**2,
        *(STOP_SCATTER * stops * side for side in (bump, ~bump)),
        *(stop_clearance_sd * stop_rate * side for side in (bump, ~bump)),
    ]
    return np.stack(columns, axis=1)


LOAD_CHANNEL = "tyre_load"
STEP = 0.5
"""mm, of difference quotients to h: wider than a kink is rounded, finer than any grid."""
FLOORS: Mapping[str, float] = {
    "toe": 5e-4,
    "camber": 5e-4,
    "spin": 5e-4,
    "wc_x": 5e-3,
    "wc_y": 5e-3,
    LOAD_CHANNEL: 2.0,
}
"""sd per point of what no noise model knows (deg, mm, N); keeps noise-free curves regular."""

Scatter = Mapping[str, FloatArray]
"""Response (and `wc_z`) -> (n, p) one-sigma changes of the model's left `vertical` curve by p causes."""


@dataclass(frozen=True)
class GaussNewtonStep:
    """step: mm towards the minimum. information: 1/mm². deviance: r' C^-1 r, -."""

    step: float
    information: float
    deviance: float


@dataclass(frozen=True)
class ShiftProblem:
    """Measured vertical curves, both sides averaged, and everything that predicts them.

    pad, values, covariance: response -> pad travel (m,), measured curve (m,), its noise (m, m).
    travel: measured wheel travel at the kinematic responses' pad travel.
    """

    curves: ShiftedCurves
    pad: Mapping[str, FloatArray]
    travel: FloatArray
    values: Mapping[str, FloatArray]
    covariance: Mapping[str, FloatArray]
    stop_clearance_sd: float
    scatter: Scatter | None

    @property
    def responses(self) -> tuple[str, ...]:
        """All responses that are used."""
        return tuple(self.values)

    def step(self, responses: tuple[str, ...], h: float) -> GaussNewtonStep:
        """Step a'C^-1 r / a'C^-1 a at h for `responses`; a = d(prediction)/dh."""
        residual = np.concatenate([self.values[r] - self.predict(r, h) for r in responses])
        derivative = np.concatenate([self.derivative(r, h) for r in responses])
        from scipy.linalg import cho_factor, cho_solve

        factor = cho_factor(self.total_covariance(responses, h))
        solved = cho_solve(factor, np.stack([residual, derivative], axis=1))
        information = float(derivative @ solved[:, 1])
        step = float(derivative @ solved[:, 0]) / information
        return GaussNewtonStep(step, information, float(residual @ solved[:, 0]))

    def total_covariance(self, responses: tuple[str, ...], h: float) -> FloatArray:
        """Noise plus production scatter, stacked over `responses`."""
        modes = [self.modes(r, h) for r in responses]
        # A model's parameters move all responses together, the built-in scatter each by itself.
        from scipy.linalg import block_diag

        stacked = block_diag(*modes) if self.scatter is None else np.concatenate(modes)
        out: FloatArray = block_diag(*[self.noise(r, h) for r in responses]) + stacked @ stacked.T
        return out

    def predict(self, response: str, h: float) -> FloatArray:
        """(m,) model's curve with its pads raised by h."""
        if response == LOAD_CHANNEL:
            return self.curves.load(self.pad[LOAD_CHANNEL], h)
        return self.curves.kinematic(response, self.travel, h)

    def derivative(self, response: str, h: float) -> FloatArray:
        """(m,) d(prediction)/dh, central difference."""
        ahead, behind = self.predict(response, h + STEP), self.predict(response, h - STEP)
        out: FloatArray = (ahead - behind) / (2.0 * STEP)
        return out

    def noise(self, response: str, h: float) -> FloatArray:
        """(m, m) measurement noise, interpolation doubt and floor."""
        if response == LOAD_CHANNEL:
            doubt = self.curves.load_doubt(self.pad[LOAD_CHANNEL], h)
        else:
            doubt = self.curves.kinematic_doubt(response, self.travel, h)
        out: FloatArray = self.covariance[response] + np.diag(doubt**2 + FLOORS[response] ** 2)
        return out

    def modes(self, response: str, h: float) -> FloatArray:
        """(m, p) one-sigma production scatter at the measured points."""
        if self.scatter is not None:
            return self._given_modes(self.scatter, response, h)
        if response == LOAD_CHANNEL:
            return self._load_modes(h)
        return kinematic_modes(response, self.travel)

    def _load_modes(self, h: float) -> FloatArray:
        pad, curves = self.pad[LOAD_CHANNEL], self.curves
        ahead, behind = curves.stop_force(pad, h + STEP), curves.stop_force(pad, h - STEP)
        return load_modes(
            pad,
            curves.static_rate(),
            curves.stop_force(pad, h),
            (ahead - behind) / (2.0 * STEP),
            bump=pad + h > 0.0,
            stop_clearance_sd=self.stop_clearance_sd,
        )

    def _given_modes(self, scatter: Scatter, response: str, h: float) -> FloatArray:
        """The given changes at fixed pad travel, for kinematic curves turned into changes at fixed z.

        A last column leaves the static load free: loading and preload are no parameters of the model.
        """
        at = self.pad[response] + h
        own = _columns_at(at, self.curves.pad, scatter[response])
        if response == LOAD_CHANNEL:
            return np.column_stack([own, np.full(at.size, LOAD_OFFSET)])
        slope = np.gradient(self.predict(response, h), self.travel)
        moved = own - slope[:, None] * _columns_at(at, self.curves.pad, scatter["wc_z"])
        moved = moved - moved[np.argmin(np.abs(self.travel))]
        return np.column_stack([moved, np.zeros(at.size)])


def _columns_at(at: FloatArray, grid: FloatArray, columns: FloatArray) -> FloatArray:
    return np.stack([np.interp(at, grid, column) for column in columns.T], axis=1)
