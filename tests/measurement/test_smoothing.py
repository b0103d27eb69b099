from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from doe_kc.measurement.smoothing import local_weights

GRID = np.linspace(-1.0, 1.0, 21)


@settings(max_examples=40, deadline=None)
@given(st.integers(8, 300), st.integers(0, 2**31), st.floats(0.01, 0.5))
def test_quadratics_are_reproduced_from_any_samples(count: int, seed: int, width: float) -> None:
    rng = np.random.default_rng(seed)
    x = np.sort(rng.uniform(-1.0, 1.0, count)) + np.linspace(0.0, 1e-3, count)
    a, b, c = rng.normal(size=3)
    y = a + b * x + c * x**2
    inner = GRID[np.abs(GRID - (x.min() + x.max()) / 2.0) < np.ptp(x) / 2.0]
    fitted = local_weights(x, inner, width) @ y
    np.testing.assert_allclose(fitted, a + b * inner + c * inner**2, atol=1e-5)


def test_noise_is_averaged_and_the_gram_predicts_by_how_much() -> None:
    rng = np.random.default_rng(3)
    x = np.linspace(-1.0, 1.0, 257)
    weights = local_weights(x, GRID, 0.15)
    noise = rng.normal(size=(257, 4000))
    np.testing.assert_allclose((weights @ noise).var(axis=1), np.diag(weights @ weights.T), rtol=0.12)
    assert np.diag(weights @ weights.T)[10] < 0.08
