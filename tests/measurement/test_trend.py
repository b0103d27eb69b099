from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from doe_kc.measurement import fit_trends


@settings(max_examples=25, deadline=None)
@given(st.integers(1, 6), st.integers(0, 2**31), st.floats(-1e4, 1e4), st.floats(0.1, 1e4))
def test_a_polynomial_is_found_on_any_scale(degree: int, seed: int, centre: float, scale: float) -> None:
    rng = np.random.default_rng(seed)
    t = np.linspace(-1.0, 1.0, 600)
    coefficients = rng.uniform(0.5, 1.0, degree + 1) * rng.choice([-1.0, 1.0], degree + 1)
    clean = np.polynomial.chebyshev.chebval(t, coefficients)
    noisy = clean + 0.02 * rng.normal(size=t.size)
    (trend,) = fit_trends(centre + scale * t, noisy[None, :])
    assert degree <= trend.degree
    assert np.sqrt(np.mean((trend(centre + scale * t) - clean) ** 2)) < 0.01
    assert trend.cv_rmse == pytest.approx(0.02, rel=0.2)
    assert trend.residual_rmse <= trend.cv_rmse * 1.001


@pytest.mark.parametrize("degree", range(1, 7))
def test_the_degree_is_mostly_the_true_one(degree: int) -> None:
    rng = np.random.default_rng(100 + degree)
    t = np.linspace(-1.0, 1.0, 600)
    coefficients = rng.uniform(0.5, 1.0, (100, degree + 1)) * rng.choice([-1.0, 1.0], (100, degree + 1))
    clean = np.polynomial.chebyshev.chebval(t, coefficients.T)
    trends = fit_trends(t, clean + 0.02 * rng.normal(size=clean.shape))
    excess = np.array([trend.degree for trend in trends]) - degree
    assert excess.min() == 0 and excess.max() <= 6
    assert np.mean(excess == 0) >= 0.8 and np.mean(excess <= 2) >= 0.95


def test_a_line_in_noise_stays_a_line_mostly() -> None:
    rng = np.random.default_rng(5)
    t = np.linspace(-1.0, 1.0, 1500)
    rows = t + 0.1 * rng.normal(size=(30, t.size))
    degrees = [trend.degree for trend in fit_trends(t, rows)]
    assert np.median(degrees) == 1 and max(degrees) <= 8


def test_a_loop_is_fitted_through_its_middle() -> None:
    t = np.concatenate([np.linspace(1, -1, 300), np.linspace(-1, 1, 300)])
    width = np.where(np.arange(600) < 300, 0.3, -0.3)
    (trend,) = fit_trends(t, (2.0 * t + width)[None, :])
    np.testing.assert_allclose(trend(np.array([-0.5, 0.5])), [-1.0, 1.0], atol=0.02)
    assert trend.residual_rmse == pytest.approx(0.3, rel=0.02)
