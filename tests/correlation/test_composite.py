"""The rating on modelled outputs: equal to equation 2.2, exact gradients, majorizers that lie above."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
import pytest

from doe_kc.correlation.modelled.archive import build_archive
from doe_kc.correlation.modelled.composite import Composite
from doe_kc.correlation.problem import Candidate, Evaluated
from tests.correlation.cases import outcome, problem


@lru_cache(maxsize=1)
def designs() -> list[Evaluated]:
    case = problem("car_b")
    rng = np.random.default_rng(3)
    points = [case.space.start] + [
        case.space.start + rng.uniform(-0.1, 0.1, case.space.dimension) for _ in range(7)
    ]
    return [
        case.judged(i, Candidate(p, "test"), outcome(case.axle, case.space.values(p)))
        for i, p in enumerate(points)
    ]


@lru_cache(maxsize=1)
def composite() -> tuple[Composite, np.ndarray]:
    archive = build_archive(problem("car_b").targets, designs())
    return archive.composite, archive.outputs


def test_rating_of_the_outputs_is_that_of_the_designs() -> None:
    rate, outputs = composite()
    known = np.array([e.merit for e in designs()])
    np.testing.assert_allclose(rate.rating(outputs), known, rtol=1e-4)


def test_gradient_against_differences() -> None:
    rate, outputs = composite()
    h = outputs[2]
    value, gradient = rate.rating_and_gradient(h[None])
    assert value[0] == pytest.approx(rate.rating(h[None])[0], rel=1e-12)
    found = gradient[0]
    for i in range(h.size):
        step = 1e-6 * max(1.0, abs(h[i]))
        up, down = h.copy(), h.copy()
        up[i] += step
        down[i] -= step
        known = (rate.rating(up[None])[0] - rate.rating(down[None])[0]) / (2.0 * step)
        assert found[i] == pytest.approx(known, rel=2e-3, abs=1e-3 * np.abs(found).max())


def test_expectation_against_sampling() -> None:
    rate, outputs = composite()
    rng = np.random.default_rng(0)
    variance = (0.05 * outputs.std(axis=0)) ** 2
    h = outputs[0]
    draws = h + np.sqrt(variance) * rng.standard_normal((40000, h.size))
    sampled = rate.rating(draws)
    expected = rate.expected(h[None], variance)[0]
    assert expected == pytest.approx(sampled.mean(), abs=6.0 * sampled.std() / 200.0, rel=2e-3)


def test_without_doubt_the_expectation_is_the_rating() -> None:
    rate, outputs = composite()
    np.testing.assert_allclose(
        rate.expected(outputs, np.zeros(outputs.shape[1])), rate.rating(outputs), rtol=1e-6
    )


@pytest.mark.parametrize("blur", [0.0, 0.02])
def test_majorizer_has_the_slope_of_the_expectation(blur: float) -> None:
    rate, outputs = composite()
    h, variance = outputs[3], (blur * outputs.std(axis=0)) ** 2 + 1e-12
    near = rate.majorizer(h, variance)
    for i in range(h.size):
        step = 1e-4 * outputs[:, i].std()
        up, down = h.copy(), h.copy()
        up[i] += step
        down[i] -= step
        slope = -(rate.expected(up[None], variance)[0] - rate.expected(down[None], variance)[0]) / (2 * step)
        assert near.gradient[i] == pytest.approx(slope, rel=5e-3, abs=2e-3 * np.abs(near.gradient).max())


def test_majorizer_has_the_slope_by_variance() -> None:
    rate, outputs = composite()
    h, variance = outputs[3], (0.05 * outputs.std(axis=0)) ** 2
    near = rate.majorizer(h, variance)
    for i in range(h.size):
        up, down = variance.copy(), variance.copy()
        up[i] *= 1.001
        down[i] *= 0.999
        slope = -(rate.expected(h[None], up)[0] - rate.expected(h[None], down)[0]) / (0.002 * variance[i])
        assert near.variance[i] == pytest.approx(slope, rel=2e-2, abs=1e-2 * np.abs(near.variance).max())
