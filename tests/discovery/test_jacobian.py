"""Derivatives in blocks do what the whole matrix does."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.sparse import csc_array

from doe_kc.discovery.jacobian import Jacobian
from doe_kc.discovery.linear_nuisances import LinearNuisances, Trace
from doe_kc.effects.hypothesis import Hypothesis

ROWS, OWN, START, LINEAR = 30, 6, 4, 3
RNG = np.random.default_rng(2)


@pytest.fixture
def jacobian() -> Jacobian:
    """Four parameters, three linear nuisances of which one does not count, two amplitudes."""
    nuisances = LinearNuisances(RNG.standard_normal((ROWS, LINEAR)), (Trace(Hypothesis("a", None, ()), 0),))
    return Jacobian(RNG.standard_normal((ROWS, OWN)), START, nuisances, np.array([1.0, 1.0, 0.0]))


def test_products_are_those_of_the_whole_matrix(jacobian: Jacobian) -> None:
    whole, rows = jacobian.dense, RNG.standard_normal((ROWS, 2))
    assert whole.shape == (ROWS, jacobian.size) and not whole[:, START + 2].any()
    step = RNG.standard_normal((jacobian.size, 2))
    np.testing.assert_allclose(jacobian.gram, whole.T @ whole, atol=1e-12)
    np.testing.assert_allclose(jacobian.pulled(rows), whole.T @ rows, atol=1e-12)
    np.testing.assert_allclose(jacobian.pulled(csc_array(rows)), whole.T @ rows, atol=1e-12)
    np.testing.assert_allclose(jacobian.pulled(rows[:, 0]), whole.T @ rows[:, 0], atol=1e-12)
    np.testing.assert_allclose(jacobian.moved(step), whole @ step, atol=1e-12)
    np.testing.assert_allclose(jacobian.moved(step[:, 1]), whole @ step[:, 1], atol=1e-12)
    np.testing.assert_array_equal(jacobian.rows(np.array([3, 1])), whole[[3, 1]])


def test_without_nuisances_it_is_its_own_columns() -> None:
    own = RNG.standard_normal((ROWS, OWN))
    plain = Jacobian(own)
    np.testing.assert_array_equal(plain.dense, own)
    np.testing.assert_allclose(plain.gram, own.T @ own)


def test_a_secant_change_satisfies_the_step_and_keeps_linear_nuisances(jacobian: Jacobian) -> None:
    step, change = RNG.standard_normal(jacobian.size), RNG.standard_normal(ROWS)
    changed = jacobian.secant(change - jacobian.moved(step), step)
    np.testing.assert_allclose(changed.moved(step), change, atol=1e-12)
    np.testing.assert_allclose(changed.gram, changed.dense.T @ changed.dense, atol=1e-12)
    linear = slice(START, START + LINEAR)
    np.testing.assert_array_equal(changed.dense[:, linear], jacobian.dense[:, linear])
    nowhere = np.zeros(jacobian.size)
    nowhere[linear] = 1.0
    assert jacobian.secant(change, nowhere) is jacobian


def test_another_order_of_the_amplitudes_and_other_units(jacobian: Jacobian) -> None:
    order = np.array([*range(START + LINEAR), START + LINEAR + 1, START + LINEAR])
    other = jacobian.ordered(order)
    np.testing.assert_array_equal(other.dense, jacobian.dense[:, order])
    np.testing.assert_allclose(other.gram, other.dense.T @ other.dense, atol=1e-12)
    factors = np.ones(jacobian.size)
    factors[1] = 3.0
    scaled = other.scaled(factors)
    np.testing.assert_allclose(scaled.dense, other.dense * factors)
    np.testing.assert_allclose(scaled.gram, scaled.dense.T @ scaled.dense, atol=1e-12)
