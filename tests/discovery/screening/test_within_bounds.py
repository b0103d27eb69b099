"""Gains between bounds: those of bounded least squares by another code, about the nominal axle."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import lsq_linear

from doe_kc.discovery.fit import Fit
from doe_kc.discovery.gauss_newton import fit
from doe_kc.discovery.jacobian import Jacobian
from doe_kc.discovery.screening.within_bounds import gains_within_bounds, many_held, nominal_fit
from doe_kc.discovery.thresholds import AMPLITUDE_LIMIT, BENT_SHARE
from doe_kc.effects.hypothesis import Hypothesis, Size
from tests.discovery.cases import model
from tests.discovery.search.test_proposals import ROWS, hypotheses, screened, tuned

POSITIVE = Hypothesis("hub_compliance", None, (Size("k", 1.0, "-"),))
WITHOUT_SIZES = Hypothesis("roll_technique", "wheel_to_ground", ())


def toy(rng: np.random.Generator) -> Fit:
    """Linear, at the nominal axle; its misfit is far beyond what parameters reach."""
    known = tuned(rng.standard_normal(ROWS), rng)
    residual = 40.0 * rng.standard_normal(ROWS)
    return replace(known, z=known.model.centre.copy(), residual=residual)


def least_cost(
    nominal: Fit, columns: np.ndarray, low: np.ndarray, high: np.ndarray
) -> tuple[float, np.ndarray]:
    """Of the linear model, with its prior, by scipy."""
    prior = nominal.model.prior_sd
    rows = np.vstack([np.hstack([nominal.jacobian.dense, columns]), np.eye(prior.size + columns.shape[1])])
    rows[ROWS : ROWS + prior.size] /= prior[:, None]
    data = np.concatenate([-nominal.residual, np.zeros(rows.shape[0] - ROWS)])
    below = np.concatenate([nominal.model.lower - nominal.z, low])
    above = np.concatenate([nominal.model.upper - nominal.z, high])
    solution = lsq_linear(rows, data, (below, above), tol=1e-14)
    return 2.0 * float(solution.cost), np.asarray(solution.x[prior.size :])


def test_gains_and_sizes_are_those_of_bounded_least_squares() -> None:
    rng = np.random.default_rng(5)
    nominal = toy(rng)
    columns = 3.0 * rng.standard_normal((ROWS, 5))
    known = [*hypotheses(3), POSITIVE, WITHOUT_SIZES]
    given = [screened(h, c) for h, c in zip(known, columns.T, strict=True)]
    given[4] = replace(given[4], amplitudes=np.zeros(0), columns=np.zeros((ROWS, 0)))
    most = AMPLITUDE_LIMIT * known[0].sizes[0].most
    bounds = {h.name: (-most, most) for h in known[:3]} | {
        POSITIVE.name: (0.0, most),
        WITHOUT_SIZES.name: (0.0, 1.0),
    }
    none = np.zeros((ROWS, 0))
    without, _ = least_cost(nominal, none, np.zeros(0), np.zeros(0))
    gains = gains_within_bounds(nominal, given)
    assert [g.gain for g in gains] == sorted((g.gain for g in gains), reverse=True)
    for own in gains:
        hypothesis = own.screened.hypothesis
        low, high = bounds[hypothesis.name]
        column = columns[:, [known.index(hypothesis)]]
        cost, sizes = least_cost(nominal, column, np.array([low]), np.array([high]))
        assert own.gain == pytest.approx(0.5 * (without - cost), rel=1e-6, abs=1e-6)
        np.testing.assert_allclose(own.amplitudes, sizes[: len(hypothesis.sizes)], rtol=1e-6, atol=1e-8)


def test_one_without_an_equilibrium_is_left_out() -> None:
    rng = np.random.default_rng(6)
    nominal = toy(rng)
    first, second = (screened(h, rng.standard_normal(ROWS)) for h in hypotheses(2))
    gains = gains_within_bounds(nominal, [replace(first, failed="no equilibrium"), second])
    assert [g.screened for g in gains] == [second]


def test_many_are_held_from_a_share_on() -> None:
    rng = np.random.default_rng(7)
    nominal = toy(rng)
    count = nominal.model.parameters
    slope = np.full(nominal.z.size, -1.0)
    for held in range(count + 1):
        z = nominal.z.copy()
        z[:held] = nominal.model.upper[:held]
        bent = replace(nominal, z=z, slope=slope, jacobian=Jacobian(nominal.jacobian.dense))
        assert many_held(bent) == (held >= BENT_SHARE * count)


def test_the_nominal_fit_is_the_nominal_axle_with_the_effects_as_they_are() -> None:
    car = model("named")
    current = fit(car, car.centre, steps=2)
    nominal = nominal_fit(current)
    np.testing.assert_array_equal(nominal.z, car.centre)
    np.testing.assert_allclose(nominal.residual, car.residual(car.centre), rtol=1e-12, atol=1e-9)
