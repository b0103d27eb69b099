"""Ride-height difference between a measured axle and a model, from the common shift of their curves."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from scipy.linalg import block_diag, cho_factor, cho_solve

from doe_kc.curves import CaseCurves, CurveSet
from doe_kc.errors import InputError
from doe_kc.measurement.noise import CaseNoise
from doe_kc.measurement.production_scatter import (
    KINEMATIC_SCATTER,
    kinematic_modes,
    load_modes,
)
from doe_kc.measurement.shifted_curves import ShiftedCurves, both_sides
from doe_kc.typing import FloatArray

CASE = "vertical"
LOAD = "tyre_load"
KINEMATIC_WINDOW = 20.0
"""Half-width in mm of pad travel over which kinematic curves count: free of the stops, where a shift
shows as a change of slope only; further out stop forces bend the curves and tell nothing more."""
LOAD_RANGE = (-40.0, 50.0)
"""Pad travel in mm over which the tyre load counts; holds the bump stop's contact."""
SEARCH = 25.0
"""Largest ride-height difference looked for, mm either way."""
STEP = 0.5
"""mm, of difference quotients to h: wider than a kink is rounded, finer than any grid."""
FLOORS: Mapping[str, float] = {LOAD: 2.0, "wc_x": 5e-3, "wc_y": 5e-3} | dict.fromkeys(
    ("toe", "camber", "spin"), 5e-4
)
"""sd per point of what no noise model knows (unit of the response); keeps noise-free curves regular."""

Scatter = Mapping[str, FloatArray]
"""Response (and `wc_z`) -> (n, p) one-sigma changes of the model's left `vertical` curve by p parameters."""


@dataclass(frozen=True)
class Contribution:
    """What one response alone says, mm, with its standard deviation."""

    response: str
    estimate: float
    sd: float
    used: bool


@dataclass(frozen=True)
class RideHeight:
    """Ride-height difference, mm: + = body lower, wheels higher in the body, pads raised.

    sd: standard deviation, includes production scatter and, when the responses contradict each other,
    their spread (Birge ratio > 1). consistency: chi² of the contributions per degree of freedom.
    contributions: each response alone; `static_load` is not used, since a car's loading and preload
    move it too: it is what the load would say if the springs had the model's preload.
    """

    estimate: float
    sd: float
    consistency: float
    contributions: tuple[Contribution, ...]


def infer_ride_height(
    measured: CurveSet,
    model: CurveSet,
    noise: CaseNoise | None = None,
    *,
    stop_clearance_sd: float = 1.0,
    scatter: Scatter | None = None,
) -> RideHeight:
    """Generalised least squares for h in y = f(z + z(h)) - f(z(h)) + M b + e, per response of `vertical`.

    f: the model's curves (`ShiftedCurves`); M b, b ~ N(0, I): production scatter, which changes slopes
    and curvatures as a shift does, marginalised; e: measurement noise. Kinematic curves tell h by their
    slope (above all track, wc_y, as the thesis found, and camber), the tyre load by the bump stop's
    contact, which moves by h, while spring rate and preload differences do not move it.

    noise: of the measured `vertical` curves; None = noise-free curves.
    stop_clearance_sd: scatter of a stop's clearance at the wheel, mm; decides the weight of the contact.
    scatter: one-sigma changes by the model's own parameters, from the solver's sensitivities, in place of
    the built-in scatter of a McPherson axle with 1 mm on its hardpoints.
    Raises InputError when either set lacks `vertical` or its curves are too short.
    Source: Wendeberg (2013), sections 6.3.1 and 8; Birge, Phys. Rev. 40 (1932) 207.
    """
    problem = _problem(measured, model, noise, stop_clearance_sd, scatter)
    h = problem.solve()
    estimates = [problem.alone(r, h) for r in problem.responses]
    information = problem.information(h)
    chi2 = sum(((c.estimate - h) / c.sd) ** 2 for c in estimates) / max(len(estimates) - 1, 1)
    return RideHeight(
        estimate=h,
        sd=float(np.sqrt(max(1.0, chi2) / information)),
        consistency=float(chi2),
        contributions=(*estimates, problem.static_load()),
    )


@dataclass(frozen=True)
class _Problem:
    """Measured curves, both sides averaged, and everything that predicts them.

    pad, values, covariance: response -> inputs (m,), measured curve (m,), its noise (m, m).
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
        return tuple(self.values)

    def predict(self, response: str, h: float) -> FloatArray:
        if response == LOAD:
            return self.curves.load(self.pad[LOAD], h)
        return self.curves.kinematic(response, self.travel, h)

    def derivative(self, response: str, h: float) -> FloatArray:
        """d(prediction)/dh, central difference."""
        ahead, behind = self.predict(response, h + STEP), self.predict(response, h - STEP)
        out: FloatArray = (ahead - behind) / (2.0 * STEP)
        return out

    def modes(self, response: str, h: float) -> FloatArray:
        """(m, p) one-sigma production scatter at the measured points."""
        if self.scatter is not None:
            return self._given_modes(response, h)
        if response != LOAD:
            return kinematic_modes(response, self.travel)
        pad, curves = self.pad[LOAD], self.curves
        return load_modes(
            pad,
            curves.static_rate(),
            curves.stop_force(pad, h),
            (curves.stop_force(pad, h + STEP) - curves.stop_force(pad, h - STEP)) / (2.0 * STEP),
            bump=pad + h > 0.0,
            stop_clearance_sd=self.stop_clearance_sd,
        )

    def _given_modes(self, response: str, h: float) -> FloatArray:
        assert self.scatter is not None
        at = self.pad[response] + h
        grid = self.curves.pad
        own = _columns_at(at, grid, self.scatter[response])
        if response == LOAD:
            # Loading and preload of a car are no parameter of the model.
            return own + 0.0
        slope = np.gradient(self.predict(response, h), self.travel)
        moved = own - slope[:, None] * _columns_at(at, grid, self.scatter["wc_z"])
        static = np.argmin(np.abs(self.travel))
        out: FloatArray = moved - moved[static]
        return out

    def noise(self, response: str, h: float) -> FloatArray:
        """(m, m) measurement noise, interpolation doubt and floor."""
        at = self.pad[LOAD] if response == LOAD else self.travel
        doubt = self.curves.interpolation_sd(response, at, h) ** 2 + FLOORS[response] ** 2
        free = np.full((at.size, at.size), 1e6) if response == LOAD and self.scatter is not None else 0.0
        out: FloatArray = self.covariance[response] + np.diag(doubt) + free
        return out

    def system(self, responses: tuple[str, ...], h: float) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Residual, derivative to h, covariance, stacked over `responses`."""
        residual = np.concatenate([self.values[r] - self.predict(r, h) for r in responses])
        derivative = np.concatenate([self.derivative(r, h) for r in responses])
        modes = [self.modes(r, h) for r in responses]
        # Parameters of a model move all responses together, the built-in scatter each by itself.
        stacked = block_diag(*modes) if self.scatter is None else np.concatenate(modes)
        noise = block_diag(*[self.noise(r, h) for r in responses])
        return residual, derivative, noise + stacked @ stacked.T

    def step(self, responses: tuple[str, ...], h: float) -> tuple[float, float, float]:
        """Gauss-Newton step, information and deviance at h."""
        residual, derivative, covariance = self.system(responses, h)
        solved = cho_solve(cho_factor(covariance), np.stack([residual, derivative], axis=1))
        information = float(derivative @ solved[:, 1])
        return (
            float(derivative @ solved[:, 0]) / information,
            information,
            float(residual @ solved[:, 0]),
        )

    def information(self, h: float) -> float:
        return self.step(self.responses, h)[1]

    def alone(self, response: str, h: float) -> Contribution:
        step, information, _ = self.step((response,), h)
        return Contribution(response, h + step, float(information**-0.5), True)

    def solve(self) -> float:
        """Best of a 1 mm scan (the contact's kink makes the deviance multi-modal), then Gauss-Newton."""
        reach = self.reach()
        scan = np.arange(-reach, reach + 0.5)
        deviance = [self.step(self.responses, float(h))[2] for h in scan]
        h = float(scan[int(np.argmin(deviance))])
        for _ in range(40):
            step = float(np.clip(self.step(self.responses, h)[0], -1.0, 1.0))
            h = float(np.clip(h + step, -reach, reach))
            if abs(step) < 1e-7:
                break
        return h

    def reach(self) -> float:
        """Largest |h| for which the model's curves cover the measured points, at most SEARCH."""
        limit = float(np.abs(self.curves.pad).max()) - max(
            float(np.abs(p).max()) for p in self.pad.values()
        )
        return float(np.floor(min(SEARCH, limit - 1.0)))

    def static_load(self) -> Contribution:
        rate = self.curves.static_rate()
        measured = float(np.interp(0.0, self.pad[LOAD], self.values[LOAD]))
        difference = measured - float(self.curves.load(np.zeros(1), 0.0)[0])
        at = int(np.argmin(np.abs(self.pad[LOAD])))
        sd = float(self.covariance[LOAD][at, at] + FLOORS[LOAD] ** 2) ** 0.5
        return Contribution("static_load", difference / rate, sd / rate, False)


def _columns_at(at: FloatArray, grid: FloatArray, columns: FloatArray) -> FloatArray:
    return np.stack([np.interp(at, grid, column) for column in columns.T], axis=1)


def _problem(
    measured: CurveSet,
    model: CurveSet,
    noise: CaseNoise | None,
    stop_clearance_sd: float,
    scatter: Scatter | None,
) -> _Problem:
    case, reference = _vertical(measured), _vertical(model)
    near = np.abs(case.input) <= KINEMATIC_WINDOW * (1.0 + 1e-9)
    wide = (case.input >= LOAD_RANGE[0]) & (case.input <= LOAD_RANGE[1])
    masks = dict.fromkeys(KINEMATIC_SCATTER, near) | {LOAD: wide}
    return _Problem(
        curves=ShiftedCurves.of(reference),
        pad={r: case.input[m] for r, m in masks.items()},
        travel=both_sides("wc_z", case.mean["wc_z"])[near],
        values={r: both_sides(r, case.mean[r])[m] for r, m in masks.items()},
        covariance={r: _covariance(noise, r, m) for r, m in masks.items()},
        stop_clearance_sd=stop_clearance_sd,
        scatter=scatter,
    )


def _vertical(curves: CurveSet) -> CaseCurves:
    case = curves.cases.get(CASE)
    if case is None:
        raise InputError(
            f"{curves.source}: has no load case {CASE}, which tells the ride height; "
            "add its record or leave the ride height as it is."
        )
    if np.abs(case.input).max() < LOAD_RANGE[1] + 2.0:
        raise InputError(
            f"{curves.source}: {CASE} covers ±{np.abs(case.input).max():g} mm, expected at least "
            f"±{LOAD_RANGE[1] + 2.0:g} mm to tell the ride height; record or simulate a larger sweep."
        )
    return case


def _covariance(noise: CaseNoise | None, response: str, mask: FloatArray) -> FloatArray:
    """(m, m) of the mean of both sides, taken as independent."""
    if noise is None:
        return np.zeros((int(mask.sum()), int(mask.sum())))
    model = noise[response]
    total = (model.covariance(side=0) + model.covariance(side=1)) / 4.0
    out: FloatArray = total[np.ix_(np.flatnonzero(mask), np.flatnonzero(mask))]
    return out
