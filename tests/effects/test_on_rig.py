"""Faults of the measurement: what the rig reads of an axle's curves."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from doe_kc.axle import Axle
from doe_kc.curves import CurveSet
from doe_kc.effects import apply_effect, observed
from doe_kc.load_cases.roll import ROLL_TECHNIQUES, PadRoll, Roll
from doe_kc.solver.curve_set import curve_set, rising
from doe_kc.solver.suite import solve
from tests.reference import nominal


@pytest.fixture(scope="module")
def curves() -> CurveSet:
    axle = apply_effect(nominal(), "steering_friction", {}, source="test")
    return curve_set(solve(axle, compiled=False))


def read(curves: CurveSet, ident: str, options: dict[str, object]) -> CurveSet:
    return observed(apply_effect(nominal(), ident, options, source="test"), curves)


def test_an_axle_without_faults_is_read_as_it_is(curves: CurveSet) -> None:
    assert observed(nominal(), curves) is curves
    assert read(curves, "hub_compliance", {}) is curves


def test_a_channel_s_gain(curves: CurveSet) -> None:
    found = read(curves, "rig_channel_gain", {"toe": 1.1, "tyre_load": 0.9})
    for ident, case in curves.cases.items():
        for response in case.mean:
            gain = {"toe": 1.1, "tyre_load": 0.9}.get(response, 1.0)
            np.testing.assert_allclose(found.cases[ident].mean[response], gain * case.mean[response])
            np.testing.assert_allclose(
                found.cases[ident].half_width[response], gain * case.half_width[response]
            )
    assert found.static is curves.static


def test_a_wrong_input_is_the_sweep_that_goes_further() -> None:
    """With friction too: loops close where the rig truly turned back."""
    axle = apply_effect(nominal(), "steering_friction", {}, source="test")
    axle = replace(axle, load_cases={i: axle.load_cases[i] for i in ("lateral", "roll", "steer")})
    gains = {"lateral": 1.05, "roll": 0.9, "steer": 1.2}
    cases = axle.load_cases.items()
    further = {i: replace(c, amplitude=gains[i] * c.amplitude) for i, c in cases}
    true = curve_set(solve(replace(axle, load_cases=further), compiled=False))
    said = apply_effect(axle, "rig_input_gain", {**gains, "brake": 1.1}, source="test")
    found = observed(said, curve_set(solve(said, compiled=False)))
    for ident, case in found.cases.items():
        np.testing.assert_allclose(case.input * gains[ident], true.cases[ident].input, rtol=1e-12)
        for response, curve in case.mean.items():
            np.testing.assert_allclose(curve, true.cases[ident].mean[response], rtol=1e-9, atol=1e-9)
            half = true.cases[ident].half_width[response]
            np.testing.assert_allclose(case.half_width[response], half, rtol=1e-9, atol=1e-9)


def test_a_wrong_steer_input_is_a_wrong_steering_ratio() -> None:
    axle = replace(nominal(), load_cases={"steer": nominal().load_cases["steer"]})
    ratio = apply_effect(axle, "steering_ratio", {"factor": 1.07}, source="test")
    gain = apply_effect(axle, "rig_input_gain", {"steer": 1.07}, source="test")
    one, other = (curve_set(solve(a, compiled=False)).cases["steer"] for a in (ratio, gain))
    for response, curve in one.mean.items():
        np.testing.assert_allclose(curve, other.mean[response], rtol=1e-9, atol=1e-9)


def test_what_is_given_twice_stands_as_given_last() -> None:
    axle = apply_effect(nominal(), "rig_input_gain", {"steer": 1.1, "brake": 0.9}, source="test")
    axle = apply_effect(axle, "rig_input_gain", {"steer": 1.2}, source="test")
    assert axle.effects["rig_input_gain"] == {"steer": 1.2, "brake": 0.9}
    assert {i: c.gain for i, c in axle.load_cases.items() if c.gain != 1.0} == {"steer": 1.2, "brake": 0.9}


def test_a_wrong_roll_by_the_pads() -> None:
    axle = apply_effect(nominal(), "rig_input_gain", {"roll": 1.1}, source="test")
    roll = apply_effect(axle, "roll_technique", {}, source="test").load_cases["roll"]
    assert isinstance(roll, PadRoll) and roll.gain == 1.1


def test_an_offset_of_the_static_alignment(curves: CurveSet) -> None:
    found = read(curves, "rig_channel_offset", {"camber_deg": -0.2})
    assert curves.static is not None and found.static is not None
    np.testing.assert_allclose(found.static["camber"], curves.static["camber"] - 0.2)
    np.testing.assert_allclose(found.static["toe"], curves.static["toe"])
    assert found.cases is curves.cases
    assert read(replace(curves, static=None), "rig_channel_offset", {}).static is None


def test_camber_against_the_road() -> None:
    solution = solve(nominal(), ["roll", "vertical"], compiled=False)
    true = curve_set(solution)
    found = read(true, "roll_technique", {"technique": "wheel_to_ground"})
    case = solution.cases["roll"]
    assert (found.cases["roll"].input == rising(case)).all()
    neg, pos = (next(b for b in case.branches if b.name == name) for name in ("neg", "pos"))
    for row, side in enumerate("LR"):
        column = solution.column(f"camber_ground@{side}")
        against = np.concatenate([neg.y[:0:-1, column], pos.y[:, column]]) - pos.y[0, column]
        # the wheel's toe turns the axis that the road leans about: second order
        np.testing.assert_allclose(found.cases["roll"].mean["camber"][row], against, atol=2e-3)
    np.testing.assert_array_equal(found.cases["roll"].mean["toe"], true.cases["roll"].mean["toe"])
    assert found.cases["vertical"] is true.cases["vertical"]


def test_roll_by_the_pads_is_counter_phase_travel_in_deg() -> None:
    axle = apply_effect(nominal(), "roll_technique", {}, source="test")
    roll = axle.load_cases["roll"]
    assert isinstance(roll, PadRoll) and roll.unit == "deg"
    travel = nominal().half_track * np.tan(np.radians(3.0))
    in_deg = solved(axle, replace(roll, amplitude=3.0))
    in_mm = solved(axle, replace(ROLL_TECHNIQUES["counter_phase"], amplitude=travel))
    for response, curve in in_mm.mean.items():
        np.testing.assert_allclose(in_deg.mean[response][:, -1], curve[:, -1], rtol=1e-9, atol=1e-7)
    assert in_deg.input[-1] == pytest.approx(3.0)
    # it rolls the same way as the body does
    body = solved(nominal(), nominal().load_cases["roll"])
    assert np.sign(body.mean["wc_z"][:, -1]).tolist() == np.sign(in_deg.mean["wc_z"][:, -1]).tolist()


def solved(axle: Axle, roll: object):
    found = curve_set(solve(replace(axle, load_cases={"roll": roll}), compiled=False))  # type: ignore[dict-item]
    return found.cases["roll"]


def test_a_roll_case_of_another_kind_stays() -> None:
    pads = replace(nominal(), load_cases={"roll": ROLL_TECHNIQUES["counter_phase"]})
    assert apply_effect(pads, "roll_technique", {}, source="test").load_cases == pads.load_cases
    none = replace(nominal(), load_cases={})
    for technique in ("counter_phase", "wheel_to_ground"):
        axle = apply_effect(none, "roll_technique", {"technique": technique}, source="test")
        assert axle.load_cases == {}
        assert observed(axle, CurveSet("t", {}, None, 750.0)).cases == {}
    assert type(nominal().load_cases["roll"]) is Roll


@pytest.mark.parametrize("ident", ["rig_channel_gain", "rig_channel_offset"])
def test_the_axle_stays_as_it_is(ident: str) -> None:
    axle = apply_effect(nominal(), ident, {}, source="test")
    assert replace(axle, effects={}) == nominal()


def test_the_steering_ratio_is_in_the_steer_case() -> None:
    axle = apply_effect(nominal(), "steering_ratio", {"factor": 1.1}, source="test")
    assert axle.rack_mm_per_rev == pytest.approx(1.1 * nominal().rack_mm_per_rev)
    found, plain = solve(axle, ["steer"], compiled=False), solve(nominal(), ["steer"], compiled=False)
    rack = found.column("rack_travel")
    end, plain_end = (s.cases["steer"].branches[0].y[-1, rack] for s in (found, plain))
    assert end == pytest.approx(1.1 * plain_end, rel=0.01)
