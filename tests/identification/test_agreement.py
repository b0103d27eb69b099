"""The measure of agreement against closed forms."""

from __future__ import annotations

import math

import numpy as np
import pytest

from doe_kc.identification.agreement import agreement, correlation


def test_a_column_of_the_opposite_sign_agrees_but_for_that() -> None:
    own = np.array([[1.0, 2.0], [-2.0, 1.0], [4.0, -3.0]])
    table = agreement(own, own * [-3.0, 5.0], np.ones((3, 2), bool), any_sign=True)
    np.testing.assert_allclose(table.signed, 1.0)
    assert table.sign.tolist() == [-1, 1] and table.means == pytest.approx((1.0, 1.0))
    strict = agreement(own, own * [-3.0, 5.0], np.ones((3, 2), bool), any_sign=False)
    np.testing.assert_allclose(strict.signed, [-1.0, 1.0])
    np.testing.assert_allclose(strict.magnitude, 1.0)


def test_only_cells_that_count_are_compared() -> None:
    own = np.array([[1.0], [2.0], [3.0], [50.0]])
    other = np.array([[2.0], [4.0], [6.0], [0.0]])
    counted = np.array([[True], [True], [True], [False]])
    table = agreement(own, other, counted, any_sign=True)
    assert table.signed[0] == pytest.approx(1.0) and table.cells.tolist() == [3]
    assert agreement(own, other, np.ones((4, 1), bool), any_sign=True).signed[0] < 0.9


def test_correlation_of_a_right_angle_and_of_nothing() -> None:
    assert correlation(np.array([1.0, -1.0, 0.0]), np.array([1.0, 1.0, -2.0])) == pytest.approx(0.0)
    assert correlation(np.array([0.0, 1.0, 0.0]), np.array([0.0, 1.0, 1.0])) == pytest.approx(0.5)
    assert math.isnan(correlation(np.array([1.0]), np.array([1.0])))
    assert math.isnan(correlation(np.array([1.0, 2.0]), np.array([3.0, 3.0])))
