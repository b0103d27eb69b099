"""The scatter of an axle: sides, signs, correlations, draws."""

from __future__ import annotations

import numpy as np
import pytest

from doe_kc.axle.parameters import parameter_value, with_values
from doe_kc.ground.errors import InputError
from doe_kc.production_scatter.study import car_design
from tests.production_scatter.cases import FEW, example, scatter_of


def test_every_parameter_that_scatters_by_kind_does() -> None:
    model = scatter_of()
    paths = [s.parameter.path for s in model.scatters]
    assert {"LLF.x", "llr.Fx", "spring.rate", "static.toe", "arb.radius"} <= set(paths)
    assert "ride_height" not in paths and "steer_arm.radius" not in paths  # no scatter; a rigid arm
    assert {"left.LLF.x", "right.LLF.x", "arb.radius"} <= set(model.paths)
    sd = {s.parameter.path: s.sd for s in model.scatters}
    assert sd["LLF.x"] == 1.0 and sd["llr.Fx"] == 0.2 and sd["static.toe"] == 0.1
    assert sd["spring.rate"] == pytest.approx(0.03 * parameter_value(example(), "spring.rate"))


def test_equal_deviations_of_both_sides_are_those_of_the_plain_path() -> None:
    model = scatter_of(parameters=["LLF.y", "llr.Fx", "static.toe"])
    for k in (0, 2, 4):
        deviation = np.zeros((1, 6))
        deviation[0, k : k + 2] = 0.25
        sides = dict(zip(model.paths, model.values(deviation)[0], strict=True))
        path = model.scatters[k // 2].parameter.path
        both = with_values(example(), {path: parameter_value(example(), path) + 0.25})
        each = with_values(example(), sides)
        assert dict(each.values) == pytest.approx(dict(both.values), abs=1e-12)


def test_later_entries_win_and_values_that_are_no_parameters_scatter_too() -> None:
    model = scatter_of(
        parameters=["LLF.*"],
        scatter=[
            {"match": "LLF.*", "sd": 0.5},
            {"match": "LLF.y", "tolerance": 0.6, "distribution": "uniform"},
            {"match": "LLF.x", "sd": 0.0},
            {"match": "steering.rack_mm_per_rev", "share": 0.01},
        ],
    )
    sd = {s.parameter.path: s.sd for s in model.scatters}
    assert sd["LLF.z"] == 0.5 and sd["LLF.y"] == pytest.approx(0.6 / 3.0**0.5) and "LLF.x" not in sd
    assert len(sd) == 3


def test_sides_and_parameters_correlate_as_asked() -> None:
    model = scatter_of(
        parameters=FEW,
        common=0.3,
        scatter=[{"match": "llr.Fx", "common": 0.8}],
        correlation=[{"match": ["ROB.z", "LLF.*"], "value": 0.6}],
    )
    assert not model.independent
    at = {p: k for k, p in enumerate(model.paths)}
    r = model.correlation
    assert r[at["left.ROB.z"], at["right.ROB.z"]] == pytest.approx(0.3)
    assert r[at["left.llr.Fx"], at["right.llr.Fx"]] == pytest.approx(0.8)
    assert r[at["left.ROB.z"], at["left.LLF.z"]] == 0.6
    assert r[at["left.ROB.z"], at["right.LLF.z"]] == pytest.approx(0.6 * 0.3)
    assert r[at["arb.radius"], at["left.LLF.z"]] == 0.0
    drawn = model.deviations(60_000, seed=3)
    np.testing.assert_allclose(np.corrcoef(drawn.T), r, atol=0.012)
    np.testing.assert_allclose(drawn.std(axis=0), model.sd, rtol=0.01)
    np.testing.assert_allclose(drawn.mean(axis=0), 0.0, atol=0.015)


def test_more_cars_begin_with_the_same_ones() -> None:
    model = scatter_of(parameters=FEW)
    few, _ = car_design(model, 40, 5, "s")
    more, deviations = car_design(model, 60, 5, "s")
    np.testing.assert_array_equal(few.values, more.values[:41])
    np.testing.assert_array_equal(more.values[0], model.nominal)
    np.testing.assert_allclose(more.values[1:], model.nominal + model.sign * deviations)
    assert not np.array_equal(car_design(model, 40, 6, "s")[0].values[1:], few.values[1:])


BAD = {
    "parameters": ({"parameters": ["LLX.*"]}, r"tolerance\.parameters: 'LLX\.\*' matches no parameter"),
    "scatter": ({"scatter": [{"match": "LLX.?", "sd": 1.0}]}, r"tolerance\.scatter: 'LLX\.\?' matches no"),
    "path": ({"scatter": [{"match": "LLX.x", "sd": 1.0}]}, "unknown parameter 'LLX.x'"),
    "side": ({"scatter": [{"match": "left.LLF.x", "sd": 1.0}]}, "names a side; both sides scatter alike"),
    "nothing": ({"parameters": ["ride_height"]}, "no parameter scatters"),
    "zero": ({"scatter": [{"match": "llr.Fx", "sd": 0.5}]}, "llr.Fx = 1 - with a standard deviation of 0.5 "),
    "one": ({"correlation": [{"match": ["LLF.x"], "value": 0.5}]}, "is one parameter, LLF.x; expected two"),
    "none": (
        {"correlation": [{"match": ["ride_height", "LLF.x"], "value": 0.5}]},
        "matches no parameter that",
    ),
    "impossible": (
        {"correlation": [{"match": ["LLF.x", "LLF.y", "LLF.z"], "value": -0.9}]},
        "no cars have all these correlations at once .* between LLF.x, LLF.y, LLF.z smaller",
    ),
    "unlike": (
        {
            "parameters": ["LLF.?"],
            "scatter": [{"match": "LLF.x", "distribution": "uniform"}],
            "correlation": [{"match": ["LLF.x", "LLF.y"], "value": 0.99}],
        },
        r"unlike distributions can correlate by at most 0\.98",
    ),
}


@pytest.mark.parametrize("name", BAD)
def test_what_cannot_be_is_said_in_a_sentence(name: str) -> None:
    table, pattern = BAD[name]
    with pytest.raises(InputError, match=f"^study.toml: .*{pattern}" if name != "path" else pattern):
        scatter_of(**table)


def test_a_law_without_limits_that_reaches_zero() -> None:
    model = scatter_of(parameters=["llr.Fx"], distribution="normal", scatter=[{"match": "llr.Fx", "sd": 0.5}])
    with pytest.raises(InputError, match=r"right\.llr\.Fx|left\.llr\.Fx.* not above 0 in \d+ of 400 cars"):
        car_design(model, 400, 1, "study.toml")
