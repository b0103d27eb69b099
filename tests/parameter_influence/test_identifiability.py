"""Linear algebra of the selection against closed forms."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.linalg import qr

from doe_kc.parameter_influence.identifiability import (
    choose,
    collinearity_index,
    expected_move,
    posterior_ratio,
)


def test_posterior_of_one_parameter_is_the_textbook_one() -> None:
    """sd ratio = 1 / sqrt(1 + s^2)."""
    ratio = posterior_ratio(np.array([[3.0, 0.0], [4.0, 0.0]]))
    np.testing.assert_allclose(ratio, [1 / math.sqrt(26.0), 1.0])


def test_posterior_of_two_equal_columns_shares_the_knowledge() -> None:
    """(S^T S + 1)^-1 of [[s, s]]: variance (1 + s^2) / (1 + 2 s^2)."""
    s = 5.0
    ratio = posterior_ratio(np.array([[s, s]]))
    np.testing.assert_allclose(ratio, math.sqrt((1 + s**2) / (1 + 2 * s**2)))


def test_move_without_bounds_is_the_ridge_solution() -> None:
    s, d = np.array([[2.0, 1.0], [0.5, -1.0], [0.0, 3.0]]), np.array([1.0, -2.0, 0.5])
    expected = np.linalg.solve(s.T @ s + np.eye(2), s.T @ d)
    np.testing.assert_allclose(expected_move(s, d), expected, rtol=1e-9)


def test_move_stops_at_its_bound_and_the_other_compensates() -> None:
    """With z0 = 1 fixed: z1 = (d - s0) s1 / (1 + s1^2)."""
    z = expected_move(np.array([[3.0, 2.0]]), np.array([12.0]), np.array([-1.0, -9.0]), np.array([1.0, 9.0]))
    np.testing.assert_allclose(z, [1.0, (12.0 - 3.0) * 2.0 / 5.0], rtol=1e-8)


@pytest.mark.parametrize("degrees", [90.0, 30.0, 5.0])
def test_collinearity_index_is_one_over_the_sine(degrees: float) -> None:
    angle = math.radians(degrees)
    s = np.array([[1.0, 7.0 * math.cos(angle)], [0.0, 7.0 * math.sin(angle)]])
    assert collinearity_index(s, 1, [0]) == pytest.approx(1.0 / math.sin(angle))


def test_collinearity_of_a_copy_is_infinite_and_of_nothing_one() -> None:
    s = np.array([[1.0, 2.0, 0.0], [1.0, 2.0, 0.0]])
    assert collinearity_index(s, 1, [0]) == math.inf
    assert collinearity_index(s, 2, [0]) == 1.0
    assert collinearity_index(s, 0, []) == 1.0


@pytest.mark.parametrize("seed", range(5))
def test_order_is_that_of_pivoted_qr(seed: int) -> None:
    s = 10.0 * np.random.default_rng(seed).normal(size=(6, 4))
    _, pivots = qr(s, mode="r", pivoting=True)
    found = choose(s)
    assert list(found.order) == pivots.tolist()
    assert not found.alike


def test_copy_is_passed_over_and_names_its_original() -> None:
    s = np.array([[9.0, 0.0, 3.0], [0.0, 1.0, 0.001]])
    found = choose(s)
    assert found.order == (0, 1)
    assert found.alike == {2: 0}


def test_weak_column_is_neither_chosen_nor_alike() -> None:
    found = choose(np.array([[9.0, 0.0], [0.0, 0.09]]))
    assert found.order == (0,)
    assert not found.alike


def test_no_more_columns_than_characteristics() -> None:
    found = choose(np.random.default_rng(0).normal(size=(3, 8)) + 2.0)
    assert len(found.order) <= 3
    assert len(found.order) + len(found.alike) == 8
