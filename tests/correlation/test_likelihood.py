"""The data of a correlation: whitened by their own noise, derivatives exact."""

from __future__ import annotations

import numpy as np
import pytest

from doe_kc.correlation.likelihood import build_likelihood, corner_error
from doe_kc.targets import CharacteristicOptions, build_targets
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


def test_corners_are_granted_an_error() -> None:
    x = np.linspace(-10.0, 10.0, 21)
    kinked = np.maximum(x, 0.0) * 8.0
    error = corner_error(kinked, white=0.05)
    assert error[10] == error[9] == error[11] == pytest.approx(1.0)
    assert np.all(error[:8] == 0.0)
    assert np.all(corner_error(0.1 * x, white=0.05) == 0.0)
