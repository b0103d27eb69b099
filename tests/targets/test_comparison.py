"""Constraint intervals (5.1, 5.2), RMS deviation (2.1), and model against measurement."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from doe_kc.characteristics import CHARACTERISTICS
from doe_kc.curves import RESPONSE_UNITS, RIG_RESPONSES, CaseCurves, CurveSet
from doe_kc.ground.typing import FloatArray
from doe_kc.targets.comparison import compare, constraint_interval, resample, rms_deviation

SLOPES = {"toe": 0.02, "camber": -0.015, "caster": 0.04, "spin": 0.03, "wc_x": 0.05, "wc_y": -0.1}


def case(ident: str, unit: str, amplitude: float, *, points: int = 41, gain: float = 1.0) -> CaseCurves:
    """Straight curves: response = slope x input; the wheel follows the pad, the load rises by 25 a unit."""
    x = np.linspace(-amplitude, amplitude, points)
    mean = {r: np.stack([s * gain * x, s * gain * x]) for r, s in SLOPES.items()}
    mean |= {"wc_z": np.stack([x, x]), "tyre_load": np.stack([4000.0 + 25.0 * x] * 2)}
    half: dict[str, FloatArray] = {r: np.zeros((2, points)) for r in RESPONSE_UNITS}
    return CaseCurves(ident, unit, x, mean, half)


def curve_set(*cases: CaseCurves, static: bool = True) -> CurveSet:
    angles = {"toe": 0.1, "camber": -0.5, "caster": 4.2, "spin": 4.2}
    values = {r: np.array([v, v]) for r, v in angles.items()} if static else None
    return CurveSet("made up", {c.load_case: c for c in cases}, values, 790.0)


VERTICAL = case("vertical", "mm", 80.0)
BRAKE = case("brake", "N", 4000.0)


@pytest.mark.parametrize(
    ("target", "half"),
    [
        (0.0, 0.15 * 0.0707106781),
        (1.0, 0.15 * 1.0024968828),
        (-1.0, 0.15 * 1.0024968828),
        (0.02, 0.15 * 0.0734846923),
        (26.0, 0.15 * 26.0000961537),
    ],
)
def test_interval_by_hand(target: float, half: float) -> None:
    """target -+ 0.15 sqrt(target^2 + 0.005)."""
    low, high = constraint_interval(target)
    assert (target - low, high - target) == pytest.approx((half, half), rel=1e-8)


@given(st.floats(-1e6, 1e6))
def test_interval_surrounds_its_target_and_mirrors(target: float) -> None:
    low, high = constraint_interval(target)
    assert low < target < high
    assert constraint_interval(-target) == (-high, -low)
    assert high - low >= 2 * 0.15 * abs(target)


def test_rms_by_hand() -> None:
    """sqrt(1/4 (1 + 4 + 0 + 4)) = 1.5."""
    curve, target = np.array([1.0, 2.0, 3.0, 4.0]), np.array([0.0, 4.0, 3.0, 2.0])
    assert rms_deviation(curve, target) == pytest.approx(1.5)
    assert rms_deviation(curve, curve) == 0.0
    assert rms_deviation(target, curve) == rms_deviation(curve, target)


def test_a_model_that_is_the_measurement() -> None:
    curves = curve_set(VERTICAL, BRAKE)
    found = compare(curves, curves)
    assert {c.entry.load_case for c in found.characteristics} == {"static", "vertical", "brake"}
    assert [c.entry.id for c in found.characteristics] == [
        i for i in CHARACTERISTICS if i.split(".")[0] in {"static", "vertical", "brake"}
    ]
    for row in found.characteristics:
        assert row.difference == 0 and row.inside and row.low < row.target < row.high
        assert math.isnan(row.target_sd)
    assert len(found.curves) == 2 * len(RIG_RESPONSES) * 2
    assert all(c.rms == 0 and c.rms_half_width == 0 for c in found.curves)


def test_a_model_that_differs() -> None:
    """Ten percent on every slope: RMS of 0.1 slope x over 41 points, and the differences of the slopes."""
    softer = case("brake", "N", 4000.0, gain=1.1)
    found = compare(curve_set(softer), curve_set(BRAKE), target_sd={"brake.wind_up": 0.3})
    rms = {(c.response, c.side): c for c in found.curves}
    spread = math.sqrt(np.mean(BRAKE.input**2))
    assert rms["toe", "L"].rms == pytest.approx(0.1 * 0.02 * spread)
    assert rms["wc_y", "R"].rms == pytest.approx(0.1 * 0.1 * spread)
    assert rms["toe", "L"].span == pytest.approx(0.02 * 8000.0)
    assert rms["tyre_load", "L"].rms == 0
    rows = {c.entry.id: c for c in found.characteristics}
    assert rows["brake.brake_steer"].target == pytest.approx(20.0)
    assert rows["brake.brake_steer"].difference == pytest.approx(2.0)
    assert rows["brake.brake_steer"].inside
    assert rows["brake.wind_up"].target_sd == 0.3
    twice = compare(curve_set(case("brake", "N", 4000.0, gain=1.2)), curve_set(BRAKE))
    assert not next(c for c in twice.characteristics if c.entry.id == "brake.brake_steer").inside


def test_half_widths_are_compared() -> None:
    wide = replace(BRAKE, half_width={**BRAKE.half_width, "toe": np.full((2, 41), 0.25)})
    found = compare(curve_set(BRAKE), curve_set(wide))
    rms = {c.response: c.rms_half_width for c in found.curves}
    assert rms["toe"] == pytest.approx(0.25) and rms["camber"] == 0


def test_rolled_by_another_technique_is_left_out() -> None:
    body, pads = case("roll", "deg", 4.0), case("roll", "mm", 50.0)
    found = compare(curve_set(body, BRAKE), curve_set(pads, BRAKE))
    assert {c.load_case for c in found.curves} == {"brake"}
    assert compare(curve_set(pads), curve_set(pads)).curves


def test_without_alignment_only_changes_are_compared() -> None:
    found = compare(curve_set(VERTICAL), curve_set(VERTICAL, static=False))
    ids = {c.entry.id for c in found.characteristics}
    assert not ids & {"static.toe", "static.camber", "static.caster", "vertical.static_caster"}
    assert "vertical.bump_steer" in ids


def test_load_cases_and_ranges_that_only_one_has() -> None:
    long = case("vertical", "mm", 120.0, points=61)
    found = compare(curve_set(VERTICAL, BRAKE), curve_set(long))
    assert {c.load_case for c in found.curves} == {"vertical"}
    assert all(c.rms == pytest.approx(0, abs=1e-12) for c in found.curves)
    assert {c.span for c in found.curves if c.response == "wc_z"} == {160.0}
    assert {c.entry.load_case for c in found.characteristics} == {"static", "vertical"}


def test_other_inputs_are_met_by_straight_lines() -> None:
    np.testing.assert_allclose(resample(BRAKE, BRAKE.input**2, np.array([100.0])), [200.0 * 100.0])
    coarse = case("brake", "N", 4000.0, points=9)
    assert all(
        c.rms == pytest.approx(0, abs=1e-10) for c in compare(curve_set(BRAKE), curve_set(coarse)).curves
    )


def test_windows_reach_both_sides() -> None:
    bent = {**BRAKE.mean, "toe": np.sign(BRAKE.input) * BRAKE.input**2 * np.ones((2, 1))}
    curves = curve_set(replace(BRAKE, mean=bent))
    narrow, wide = (
        {c.entry.id: c.value for c in compare(curves, curves, windows=w).characteristics}
        for w in ({"brake": 400.0}, {"brake": 4000.0})
    )
    assert narrow["brake.brake_steer"] < wide["brake.brake_steer"] / 5
    assert narrow["brake.wind_up"] == pytest.approx(wide["brake.wind_up"])
