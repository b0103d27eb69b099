"""The likelihood of one length-scale a variable: its value by SciPy, its derivatives by differences."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.stats import multivariate_normal
from sklearn.gaussian_process.kernels import Matern

from doe_kc.surrogate_models.ard_likelihood import (
    NOT_POSITIVE,
    Pairs,
    Scales,
    even_scales,
    fixed_point,
    maximise,
    negative_log_likelihood,
)

Z = np.random.default_rng(0).random((20, 5)) - 0.5
Y = np.random.default_rng(1).standard_normal((20, 3))
LOGARITHMS = np.random.default_rng(2).standard_normal((3, 7))
PAIRS = Pairs.of(Z)
NUGGET = 1e-3


def covariance(logarithms: np.ndarray) -> np.ndarray:
    curvature, bend, constant = np.exp(logarithms[:5]), np.exp(logarithms[5]), np.exp(logarithms[6])
    kernel = bend * Matern(1.0 / np.sqrt(curvature), nu=2.5)(Z) + constant
    return np.asarray(kernel + NUGGET * np.eye(20))


def test_the_values_are_those_of_gaussians_with_scikit_learns_kernel() -> None:
    wanted = [
        -multivariate_normal(np.zeros(20), covariance(row)).logpdf(y) - 10.0 * np.log(2.0 * np.pi)
        for row, y in zip(LOGARITHMS, Y.T, strict=True)
    ]
    for order in (0, 1, 2):
        known = negative_log_likelihood(LOGARITHMS, PAIRS, Y, NUGGET, order=order)
        assert known.value == pytest.approx(wanted, rel=1e-10)


def test_the_gradients_are_those_of_the_values() -> None:
    def value(step: np.ndarray) -> np.ndarray:
        return negative_log_likelihood(LOGARITHMS + step, PAIRS, Y, NUGGET).value

    wanted = np.transpose([(value(e) - value(-e)) / 2e-5 for e in 1e-5 * np.eye(7)])
    found = negative_log_likelihood(LOGARITHMS, PAIRS, Y, NUGGET).gradient
    np.testing.assert_allclose(found, wanted, rtol=1e-6, atol=1e-6)


def test_the_determinants_part_is_that_of_half_its_logarithm() -> None:
    def half_log(step: np.ndarray) -> list[float]:
        return [0.5 * np.linalg.slogdet(covariance(row))[1] for row in LOGARITHMS + step]

    wanted = np.transpose([np.subtract(half_log(e), half_log(-e)) / 2e-5 for e in 1e-5 * np.eye(7)])
    found = negative_log_likelihood(LOGARITHMS, PAIRS, Y, NUGGET, order=2).determinant
    np.testing.assert_allclose(found, wanted, rtol=1e-6, atol=1e-6)


def test_an_output_that_cannot_be_factorised_leaves_the_others_as_they_are() -> None:
    broken = LOGARITHMS.copy()
    broken[1, :5], broken[1, 5] = -60.0, 60.0  # all rows equal, of a variance that drowns the nugget
    known = negative_log_likelihood(broken, PAIRS, Y, NUGGET)
    whole = negative_log_likelihood(LOGARITHMS, PAIRS, Y, NUGGET)
    assert known.value[1] == NOT_POSITIVE
    assert not known.gradient[1].any()
    assert known.value[[0, 2]] == pytest.approx(whole.value[[0, 2]], rel=1e-12)


@pytest.mark.parametrize("rows", [8, 9])  # the packed triangles of even and odd numbers differ
def test_pairs_are_the_packed_lower_triangle(rows: int) -> None:
    pairs = Pairs.of(Z[:rows])
    assert len(pairs.squares) == rows * (rows + 1) // 2
    assert not pairs.squares[pairs.diagonal].any()
    i, j = np.tril_indices(rows, -1)
    wanted = np.sort(((Z[i] - Z[j]) ** 2).sum(axis=1))
    found = np.delete(pairs.squares, pairs.diagonal, axis=0).sum(axis=1)
    assert np.sort(found) == pytest.approx(wanted)


def test_a_fixed_point_step_is_worth_several_of_descent() -> None:
    z = np.random.default_rng(3).random((30, 8)) - 0.5
    y = np.column_stack([z[:, 0] + z[:, 1] ** 2, np.sin(3.0 * z[:, 2]) + z[:, 0]])
    values, pairs = (y - y.mean(axis=0)) / y.std(axis=0), Pairs.of(z)
    first = even_scales((z**2).mean(axis=0), 2)

    def value(scales: Scales) -> np.ndarray:
        return negative_log_likelihood(scales.logarithms, pairs, values, NUGGET).value

    fixed = fixed_point(first, pairs, values, nugget=NUGGET, steps=4)
    descended = maximise(first, pairs, values, nugget=NUGGET, evaluations=4)
    assert (value(descended) < value(first)).all()
    assert (value(fixed) < value(descended)).all()
