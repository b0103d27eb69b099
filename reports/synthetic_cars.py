"""Cars of the product's own making: the nominal axle with production scatter, and its rig records.

The records keep the grid, the set-up and the noise model of a measured car; noise is drawn from that model or
left out.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from correlation_runs import measured, nominal

from doe_kc.axle.design_parameters import Parameter, design_parameters
from doe_kc.axle.parameters import with_values
from doe_kc.curves import RIG_RESPONSES, CaseCurves, CurveSet
from doe_kc.ground.typing import FloatArray
from doe_kc.measurement import Measurement, NoiseModel
from doe_kc.measurement.gradients import characteristic_estimates
from doe_kc.measurement.reduction import static_sd
from doe_kc.solver.curve_set import curve_set
from doe_kc.solver.suite import solve
from doe_kc.variables import Space

NOISE_OF = "car_b"
CLEARANCE_SD = 1.0
"""mm, of the stops."""
RIDE_HEIGHT_SD = 1.0
"""mm."""
INSIDE = 0.02
"""Share of the bounds that a drawn value keeps clear of them."""


def sigma(parameter: Parameter) -> float:
    """Production scatter in the parameter's unit: 1 mm, 20 % (bushings), 3 % (rates), 0.1 deg."""
    if parameter.path == "ride_height":
        return RIDE_HEIGHT_SD
    if parameter.path == "arb.radius":  # 3 % of its rate, which goes with the fourth power
        return parameter.production_sd / 4.0
    return CLEARANCE_SD if parameter.quantity == "clearance" else parameter.production_sd


def scattered(space: Space, seed: int, *, times: float = 1.0) -> dict[str, float]:
    """Path -> absolute value of a car drawn about nominal with `times` the scatter, inside the bounds.

    Factors are drawn in their logarithm, so that half and double are equally far.
    """
    rng = np.random.default_rng([7, seed])
    known = {p.path: p for p in design_parameters(nominal())}
    point = []
    for variable in space.variables:
        step = times * sigma(known[variable.path]) / variable.slope(variable.place(variable.start))
        drawn = variable.place(variable.start) + step * rng.standard_normal()
        point.append(float(np.clip(drawn, INSIDE, 1.0 - INSIDE)))
    return space.values(np.array(point))


def record(values: Mapping[str, float], *, noise: np.random.Generator | None) -> Measurement:
    """The reduced records of the axle with `values`: its solved curves, with noise drawn or without any."""
    like = measured(NOISE_OF)
    solved = curve_set(solve(with_values(nominal(), values)))
    cases = {name: _case(like, solved, name, noise) for name in like.curves.cases}
    angle_sd = static_sd(like.manifest.alignment)
    static = {r: _angles(solved, r, angle_sd[r], noise) for r in like.curves.static or {}}
    curves = CurveSet("synthetic", cases, static, solved.half_track)
    estimates = characteristic_estimates(curves, like.noise, {}, static_sd=angle_sd)
    return replace(like, curves=curves, characteristics=estimates)


def _case(like: Measurement, solved: CurveSet, name: str, noise: np.random.Generator | None) -> CaseCurves:
    ours, theirs = solved.cases[name], like.curves.cases[name]
    mean = {}
    for response in RIG_RESPONSES:
        model = like.noise[name][response]
        mean[response] = np.array(
            [
                np.interp(theirs.input, ours.input, ours.mean[response][side])
                + (0.0 if noise is None else drawn_error(model.covariance(side=side), noise))
                for side in (0, 1)
            ]
        )
    still = {r: np.zeros_like(c) for r, c in mean.items()}
    return CaseCurves(name, theirs.input_unit, theirs.input, mean, still)


def _angles(solved: CurveSet, response: str, sd: float, noise: np.random.Generator | None) -> FloatArray:
    if solved.static is None:
        raise ValueError("the solver gives static angles")
    return solved.static[response] + (0.0 if noise is None else sd * noise.standard_normal(2))


def quieter(records: Measurement, share: float) -> Measurement:
    """The records with `share` of the noise granted to each sensor; angles of the bench keep theirs."""
    noise = {
        case: {response: _quieter(model, share) for response, model in models.items()}
        for case, models in records.noise.items()
    }
    return replace(records, noise=noise)


def _quieter(model: NoiseModel, share: float) -> NoiseModel:
    run = model.components
    less = replace(run, offset=share * run.offset, gain=share * run.gain, smooth=share * run.smooth)
    white, of_input = share * model.white, share * model.input_white
    return replace(model, white=white, input_white=of_input, components=less)


def drawn_error(covariance: FloatArray, rng: np.random.Generator) -> FloatArray:
    """One draw of N(0, covariance), which may be singular: changes from static have no error there."""
    values, vectors = np.linalg.eigh(covariance)
    return np.asarray(vectors @ (np.sqrt(np.maximum(values, 0.0)) * rng.standard_normal(values.size)))
