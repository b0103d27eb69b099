"""The likelihood of one length-scale a variable: its value by SciPy, its gradient by differences."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.stats import multivariate_normal
from sklearn.gaussian_process.kernels import Matern

from doe_kc.surrogate_models.ard_likelihood import negative_log_likelihood

Z = np.random.default_rng(0).random((20, 5)) - 0.5
Y = np.random.default_rng(1).standard_normal(20)
LOGARITHMS = np.random.default_rng(2).standard_normal(7)


def test_the_value_is_that_of_a_gaussian_with_scikit_learns_kernel() -> None:
    curvature, bend, constant = np.exp(LOGARITHMS[:5]), np.exp(LOGARITHMS[5]), np.exp(LOGARITHMS[6])
    kernel = bend * Matern(1.0 / np.sqrt(curvature), nu=2.5)(Z) + constant + 1e-3 * np.eye(20)
    wanted = -multivariate_normal(np.zeros(20), kernel).logpdf(Y) - 10.0 * np.log(2.0 * np.pi)
    assert negative_log_likelihood(LOGARITHMS, Z, Y, 1e-3)[0] == pytest.approx(wanted, rel=1e-10)


def test_the_gradient_is_that_of_the_value() -> None:
    def value(step: np.ndarray) -> float:
        return negative_log_likelihood(LOGARITHMS + step, Z, Y, 1e-3)[0]

    wanted = [(value(e) - value(-e)) / 2e-5 for e in 1e-5 * np.eye(7)]
    assert negative_log_likelihood(LOGARITHMS, Z, Y, 1e-3)[1] == pytest.approx(wanted, rel=1e-6, abs=1e-6)
