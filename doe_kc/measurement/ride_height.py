"""Ride-height difference between a measured axle and a model, from the common shift of their curves."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from doe_kc.curves import CaseCurves, CurveSet
from doe_kc.ground.errors import InputError
from doe_kc.ground.threads import one_thread
from doe_kc.ground.typing import FloatArray
from doe_kc.measurement.noise import CaseNoise
from doe_kc.measurement.shift_problem import KINEMATIC_SCATTER, LOAD_CHANNEL, Scatter, ShiftProblem
from doe_kc.measurement.shifted_curves import ShiftedCurves, both_sides

RIDE_HEIGHT_CASE = "vertical"
KINEMATIC_WINDOW = 20.0
"""Half-width in mm of pad travel over which kinematic curves count: free of the stops, where a shift
shows as a change of slope only; further out stop forces bend the curves and tell nothing more."""
LOAD_RANGE = (-40.0, 50.0)
"""Pad travel in mm over which the tyre load counts; holds the bump stop's contact."""
SEARCH = 25.0
"""Largest ride-height difference looked for, mm either way."""
_MARGIN = 2.0
"""mm that a sweep must go beyond what is compared: curves are interpolated, never
continued past their ends."""


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


@one_thread()
def infer_ride_height(
    measured: CurveSet,
    model: CurveSet,
    noise: CaseNoise | None = None,
    *,
    stop_clearance_sd: float = 1.0,
    scatter: Scatter | None = None,
) -> RideHeight:
    """Generalised least squares for h in y = f(z + z(h)) - f(z(h)) + M b + e, `vertical` curves.

    f: the model's curves (`ShiftedCurves`); M b, b ~ N(0, I): production scatter, which changes slopes
    and curvatures as a shift does, marginalised; e: measurement noise. Kinematic curves tell h by their
    slope (above all track, wc_y, as the thesis found, and camber), the tyre load by the bump stop's
    contact, which moves by h, while spring rate and preload differences do not move it.

    noise: of the measured `vertical` curves; None = noise-free curves.
    stop_clearance_sd: scatter of a stop's clearance at the wheel, mm; decides the weight of the contact.
    scatter: one-sigma changes by the model's own parameters, from the solver's sensitivities, in place
    of the built-in scatter of a McPherson axle with 1 mm on its hardpoints.
    Raises InputError when either set lacks `vertical` or its curves are too short.
    Source: Wendeberg (2013), sections 6.3.1 and 8; Birge, Phys. Rev. 40 (1932) 207.
    """
    problem = _problem(measured, model, noise, stop_clearance_sd, scatter)
    h = _solve(problem, _reach(problem))
    contributions = [_alone(problem, r, h) for r in problem.responses]
    chi2 = sum(((c.estimate - h) / c.sd) ** 2 for c in contributions) / (len(contributions) - 1)
    information = problem.step(problem.responses, h).information
    return RideHeight(
        estimate=h,
        sd=float(np.sqrt(max(1.0, chi2) / information)),
        consistency=float(chi2),
        contributions=(*contributions, _static_load(problem)),
    )


def _solve(problem: ShiftProblem, reach: float) -> float:
    """Best of a scan (the contact's kink makes the deviance multi-modal), then Gauss-Newton."""
    scan = np.linspace(-reach, reach, int(reach) + 1)
    deviance = [problem.step(problem.responses, float(h)).deviance for h in scan]
    h = float(scan[int(np.argmin(deviance))])
    for _ in range(40):
        step = float(np.clip(problem.step(problem.responses, h).step, -1.0, 1.0))
        h = float(np.clip(h + step, -reach, reach))
        if abs(step) < 1e-6:
            break
    return h


def _reach(problem: ShiftProblem) -> float:
    """Largest |h| for which the model's curves cover the measured points, at most SEARCH, mm."""
    used = max(float(np.abs(p).max()) for p in problem.pad.values())
    return min(SEARCH, float(np.abs(problem.curves.pad).max()) - used - _MARGIN / 2.0)


def _alone(problem: ShiftProblem, response: str, h: float) -> Contribution:
    """Estimate of one response, linearised at the common h."""
    own = problem.step((response,), h)
    return Contribution(response, h + own.step, own.information**-0.5, True)


def _static_load(problem: ShiftProblem) -> Contribution:
    """Difference of the static tyre loads divided by the ride rate."""
    rate = problem.curves.static_rate()
    measured = float(np.interp(0.0, problem.pad[LOAD_CHANNEL], problem.values[LOAD_CHANNEL]))
    difference = measured - float(problem.curves.load(np.zeros(1), 0.0)[0])
    at = int(np.argmin(np.abs(problem.pad[LOAD_CHANNEL])))
    sd = float(problem.noise(LOAD_CHANNEL, 0.0)[at, at]) ** 0.5
    return Contribution("static_load", difference / rate, sd / rate, False)


def _problem(
    measured: CurveSet,
    model: CurveSet,
    noise: CaseNoise | None,
    stop_clearance_sd: float,
    scatter: Scatter | None,
) -> ShiftProblem:
    case, reference = vertical_curves(measured), vertical_curves(model)
    near = np.abs(case.input) <= KINEMATIC_WINDOW * (1.0 + 1e-9)
    wide = (case.input >= LOAD_RANGE[0]) & (case.input <= LOAD_RANGE[1])
    masks = {r: near for r in KINEMATIC_SCATTER if r in case.mean} | {LOAD_CHANNEL: wide}
    return ShiftProblem(
        curves=ShiftedCurves.of(reference),
        pad={r: case.input[m] for r, m in masks.items()},
        travel=both_sides("wc_z", case.mean["wc_z"])[near],
        values={r: both_sides(r, case.mean[r])[m] for r, m in masks.items()},
        covariance={r: _covariance(noise, r, m) for r, m in masks.items()},
        stop_clearance_sd=stop_clearance_sd,
        scatter=scatter,
    )


def vertical_curves(curves: CurveSet) -> CaseCurves:
    """Those of vertical motion; InputError when there are none, or they are too short to tell ride height."""
    case = curves.cases.get(RIDE_HEIGHT_CASE)
    if case is None:
        raise InputError(
            f"{curves.source}: has no load case {RIDE_HEIGHT_CASE}, which tells the ride height; "
            "add its record or leave the ride height as it is."
        )
    covered = float(min(case.input.max(), -case.input.min()))
    if covered < LOAD_RANGE[1] + _MARGIN:
        raise InputError(
            f"{curves.source}: {RIDE_HEIGHT_CASE} covers ±{covered:g} mm, expected at least "
            f"±{LOAD_RANGE[1] + _MARGIN:g} mm to tell the ride height; use a larger sweep."
        )
    return case


def _covariance(noise: CaseNoise | None, response: str, mask: NDArray[np.bool_]) -> FloatArray:
    """(m, m) of the mean of both sides, taken as independent."""
    if noise is None:
        return np.zeros((int(mask.sum()), int(mask.sum())))
    model = noise[response]
    total = (model.covariance(side=0) + model.covariance(side=1)) / 4.0
    out: FloatArray = total[np.ix_(mask, mask)]
    return out
