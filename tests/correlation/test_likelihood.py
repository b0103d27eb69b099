"""The data of a correlation: whitened by their own noise, derivatives exact."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from doe_kc.correlation.curve_data import CALIBRATION, RIG_HYSTERESIS
from doe_kc.correlation.likelihood import Rewhitening, build_likelihood, record_likelihood, rewhitened
from doe_kc.targets import CharacteristicOptions, CurveOptions, build_targets
from tests.correlation.cases import measured, outcome, problem, truth


def test_residuals_at_the_truth_are_noise() -> None:
    case = problem("car_b")
    known = truth("car_b", case.axle)
    point = np.array(
        [v.place(known[v.path]) if v.path in known else v.place(v.start) for v in case.space.variables]
    )
    there = outcome(case.axle, case.space.values(point))
    residual = case.likelihood.residual(there.curves, there.characteristics)
    assert 0.95 < np.mean(residual**2) < 1.12
    assert np.abs(residual).max() < 6.0


def test_jacobian_against_differences() -> None:
    case = problem("car_b")
    point = case.space.start + 0.02
    expansion = case.linearize(point)
    jacobian = case.likelihood.jacobian(expansion.curves, expansion.characteristics)
    for path in ("LWB.z", "llr.Fx", "spring.rate", "static.toe", "ride_height"):
        i, h = case.space.paths.index(path), 2e-4
        up, down = point.copy(), point.copy()
        up[i] += h
        down[i] -= h
        plus, minus = (outcome(case.axle, case.space.values(p)) for p in (up, down))
        data = case.likelihood
        slope = data.residual(plus.curves, plus.characteristics) - data.residual(
            minus.curves, minus.characteristics
        )
        found = jacobian[:, i]
        np.testing.assert_allclose(slope / (2 * h), found, atol=2e-4 * np.abs(found).max())


def test_a_typed_target_replaces_its_curve() -> None:
    case = problem("car_b")
    options = CharacteristicOptions(match="vertical.bump_steer", target=-5.0)
    targets = build_targets(case.axle, measured("car_b"), [options], [], source="test")
    found = build_likelihood(case.axle, measured("car_b"), targets)
    assert not any((c.load_case, c.response) == ("vertical", "toe") for c in found.curves)
    assert [f.name for f in found.figures if f.row >= 0] == ["vertical.bump_steer"]


def test_typed_targets_alone_are_data() -> None:
    case = problem("car_b")
    options = CharacteristicOptions(match="vertical.bump_steer", target=-5.0, sd=0.5)
    targets = build_targets(case.axle, None, [options], [], source="test")
    found = build_likelihood(case.axle, None, targets)
    base = outcome(case.axle, case.space.values(case.space.start))
    assert found.size == 1
    value = base.characteristics[targets.rows[0]]
    assert found.residual(None, base.characteristics) == pytest.approx([(value + 5.0) / 0.5])


def test_what_the_study_switches_off_is_no_data() -> None:
    case = problem("car_b")
    data = {(c.load_case, c.response) for c in case.likelihood.curves}
    off = [
        CharacteristicOptions(match="lateral.camber_change", objective=False, constraint=False),
        CharacteristicOptions(match="brake.*", objective=False),
    ]
    targets = build_targets(
        case.axle, measured("car_b"), off, [CurveOptions(match="drive.toe", objective=False)], source="test"
    )
    kept = {(c.load_case, c.response) for c in build_likelihood(case.axle, measured("car_b"), targets).curves}
    assert data - kept == {("lateral", "camber"), ("drive", "toe")}


def test_a_static_angle_that_is_switched_off_is_no_datum() -> None:
    case = problem("car_b")
    off = [CharacteristicOptions(match="static.toe", objective=False, constraint=False)]
    targets = build_targets(case.axle, measured("car_b"), off, [], source="test")
    found = build_likelihood(case.axle, measured("car_b"), targets)
    assert "toe" in {f.response for f in case.likelihood.figures}
    assert "toe" not in {f.response for f in found.figures}


def test_errors_that_all_repeats_share_are_parts_of_the_errors_known_by_themselves() -> None:
    """Of the sensor's calibration a share of its reading, of the rig's hysteresis one of its white noise."""
    case = problem("car_b")
    measurement = measured("car_b")
    kinds = {}
    for curve in record_likelihood(case.axle, measurement).curves:
        noise = measurement.noise[curve.load_case][curve.response]
        kinds[curve.branches] = set(curve.systematic)
        reading = np.abs(curve.value) if curve.branches == "half_width" else np.abs(noise.signal[curve.side])
        assert np.abs(curve.systematic["calibration"]).max() <= 1.0001 * CALIBRATION * reading.max()
        if curve.branches == "half_width":
            largest = RIG_HYSTERESIS * noise.white
            assert 0.8 * largest < curve.systematic["hysteresis"].max() <= largest
        rest = curve.root @ curve.root.T - sum(np.outer(e, e) for e in curve.systematic.values())
        assert np.linalg.eigvalsh(rest).min() > 0.0
    assert kinds == {"mean": {"calibration"}, "half_width": {"calibration", "hysteresis"}}


def test_rows_keep_their_curves_between_errors() -> None:
    before = problem("car_b").likelihood
    wider = replace(before, curves=tuple(replace(c, root=2.0 * c.root) for c in before.curves))
    rows = np.random.default_rng(1).standard_normal((before.size, 2))
    curves = before.size - len(before.figures)
    found = rewhitened(rows, before, wider)
    np.testing.assert_allclose(found[:curves], rows[:curves] / 2.0)
    np.testing.assert_array_equal(found[curves:], rows[curves:])
    assert rewhitened(rows, before, before) is rows
    units = Rewhitening(before, wider)
    for column in rows.T:
        np.testing.assert_array_equal(units.of(column), rewhitened(column, before, wider))
