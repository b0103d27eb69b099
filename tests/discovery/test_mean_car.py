"""Several cars in a discovery: how far they scatter, and the records of their mean."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from doe_kc.axle import with_values
from doe_kc.axle.model import Axle
from doe_kc.correlation.curve_data import CurveData
from doe_kc.correlation.likelihood import Likelihood, record_likelihood
from doe_kc.curves import CaseCurves, CurveSet
from doe_kc.discovery.car_scatter import most_likely_scatter, series_scatter
from doe_kc.discovery.mean_car import mean_car_likelihood, with_rounding
from doe_kc.discovery.model import EffectModel
from doe_kc.discovery.result_cache import fingerprint
from doe_kc.discovery.thresholds import COMMON_SHARE
from doe_kc.ground.typing import FloatArray
from doe_kc.measurement import Measurement
from doe_kc.solver.curve_set import curve_set
from doe_kc.solver.suite import solve
from doe_kc.variables import VariableOptions, build_space
from tests.discovery.cases import model, nominal, records

CLEARANCES = (-3.0, 0.0, 3.0)
"""mm, of the bump stops of three cars."""
CASE = "vertical"


def axle() -> Axle:
    return replace(nominal(), load_cases={CASE: nominal().load_cases[CASE]})


@cache
def solved(clearance: float) -> CurveSet:
    own = axle().values["bump_stop.clearance@L"]
    return curve_set(solve(with_values(axle(), {"bump_stop.clearance": own + clearance})))


def measured(curves: CurveSet) -> Measurement:
    """Without noise, at the inputs of a rig."""
    like, case = records("none"), curves.cases[CASE]
    at = like.curves.cases[CASE].input

    def sampled(rows: FloatArray) -> FloatArray:
        return np.array([np.interp(at, case.input, row) for row in rows])

    mean = {r: sampled(case.mean[r]) for r in like.curves.cases[CASE].mean}
    half = {r: sampled(case.half_width[r]) for r in mean}
    cases = {CASE: CaseCurves(CASE, case.input_unit, at, mean, half)}
    static = {r: (curves.static or {})[r] for r in like.curves.static or {}}
    return replace(like, curves=CurveSet("synthetic", cases, static, curves.half_track))


@cache
def fleet() -> Measurement:
    cars = tuple(measured(solved(c)) for c in CLEARANCES)
    every = [car.curves.cases[CASE] for car in cars]
    mean = replace(
        every[0],
        mean={r: np.mean([c.mean[r] for c in every], axis=0) for r in every[0].mean},
        half_width={r: np.mean([c.half_width[r] for c in every], axis=0) for r in every[0].half_width},
    )
    return replace(cars[0], curves=replace(cars[0].curves, cases={CASE: mean}), cars=cars)


@cache
def effect_model() -> EffectModel:
    space = build_space(axle(), VariableOptions.model_validate({"use": ["bump_stop.clearance"]}), "test")
    return EffectModel(axle(), space, record_likelihood(axle(), fleet()))


def data(likelihood: Likelihood) -> CurveData:
    return next(c for c in likelihood.curves if c.response == "tyre_load" and c.side == 0)


def test_the_mean_of_bends_is_no_bend_of_the_mean_car() -> None:
    true = data(record_likelihood(axle(), measured(solved(0.0)))).value
    rounded = np.abs(data(effect_model().likelihood).value - true).max()
    corrected = np.abs(data(mean_car_likelihood(effect_model(), fleet())).value - true).max()
    assert rounded > 10.0 and corrected < 0.1 * rounded


def test_what_parameters_do_not_explain_of_the_cars_counts_as_an_error_of_their_mean() -> None:
    likelihood, rng = model("none", ("lateral",)).likelihood, np.random.default_rng(9)
    left = rng.standard_normal((3, likelihood.size))
    same = with_rounding(likelihood, left + 10.0 * rng.standard_normal(likelihood.size))
    assert np.mean(same.curves[0].level / likelihood.curves[0].level) < 1.1, "common to all: no scatter"
    assert same.figures == likelihood.figures
    ends = next(likelihood.slices())[1]
    left[:, ends.start : ends.start + 10] += 20.0 * rng.standard_normal((3, 1))
    wide = with_rounding(likelihood, left).curves[0]
    assert (wide.level[2:8] > 10.0 * likelihood.curves[0].level[2:8]).all()
    left = 3.0 * rng.standard_normal((400, likelihood.size))
    shares = np.diag(with_rounding(likelihood, left).curves[0].root) / np.diag(likelihood.curves[0].root)
    assert np.mean(shares**2) == pytest.approx(1.0 + 400 * 8.0, rel=0.05)


def test_scatter_of_parts_is_told_by_the_cars() -> None:
    """Cars of which every part is off by 0.7 of what is assumed, solved, on one rig."""
    car, rng = model("none", ("lateral", "lateral_opposite")), np.random.default_rng(8)
    start, sd = car.centre[: car.parameters], 0.7 * car.space.prior_sd
    like, cars = records("none"), []
    for _ in range(4):
        z = np.concatenate([start + sd * rng.standard_normal(sd.size), car.centre[car.parameters :]])
        read = car.curves(z)
        cases = {
            name: replace(
                case,
                mean={
                    r: np.array([np.interp(case.input, read.cases[name].input, row) for row in rows])
                    + 1e-4 * rng.standard_normal((2, case.input.size))
                    for r, rows in ((r, read.cases[name].mean[r]) for r in case.mean)
                },
            )
            for name, case in like.curves.cases.items()
            if name in read.cases
        }
        static = {r: (read.static or {})[r] for r in like.curves.static or {}}
        cars.append(replace(like, curves=CurveSet("synthetic", cases, static, read.half_track)))
    series = series_scatter(car, replace(like, cars=tuple(cars)))
    assert series.cars == 4 and series.sd_error < 0.12
    assert abs(series.sd - 0.7) < 3.0 * series.sd_error


@pytest.mark.parametrize("ratio", [0.0, 0.3, 1.0, 3.0])
def test_the_ratio_of_variances_is_recovered(ratio: float) -> None:
    rng, cars = np.random.default_rng(5), 4
    columns = rng.standard_normal((400, 40)) * np.geomspace(30.0, 0.01, 40)
    scores = []
    for _ in range(20):
        drawn = columns @ (np.sqrt(ratio) * rng.standard_normal((40, cars)))
        drawn += rng.standard_normal((400, cars))
        series = most_likely_scatter(columns, drawn - drawn.mean(axis=1, keepdims=True))
        scores.append((series.ratio - ratio) / series.ratio_sd if ratio else series.ratio)
    if ratio:
        assert abs(np.mean(scores)) < 0.7 and 0.6 < np.std(scores) < 1.5
    else:
        assert max(scores) < 0.02


def test_a_mean_is_less_off_than_a_car_but_for_what_all_have_in_common() -> None:
    rng = np.random.default_rng(6)
    columns = 100.0 * rng.standard_normal((50, 10))
    none, full = (
        most_likely_scatter(columns, apart - apart.mean(axis=1, keepdims=True))
        for apart in (
            rng.standard_normal((50, 3)),
            columns @ rng.standard_normal((10, 3)) + rng.standard_normal((50, 3)),
        )
    )
    assert none.mean_sd == pytest.approx(1.0, abs=0.01)
    common = max(1.0 - full.ratio, COMMON_SHARE)
    assert full.mean_sd == pytest.approx(np.sqrt(common + full.ratio / 3.0)) and full.mean_sd < 0.95
    assert "3 cars" in full.sentence


def test_a_tighter_prior_is_another_model() -> None:
    car = model("none", ("lateral",))
    tight = replace(car, scatter=0.5)
    count = car.parameters
    assert (tight.prior_sd[:count] == 0.5 * car.prior_sd[:count]).all()
    assert (tight.prior_sd[count:] == 1.0).all()
    assert fingerprint(tight) != fingerprint(car)
