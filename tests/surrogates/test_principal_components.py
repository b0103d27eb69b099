"""Curves to scores and back."""

from __future__ import annotations

import numpy as np
import pytest

from doe_kc.errors import InputError
from doe_kc.surrogates.principal_components import principal_components

T = np.linspace(-1.0, 1.0, 41)
RNG = np.random.default_rng(3)
SCORES = RNG.normal(size=(30, 3)) * [5.0, 1.0, 0.01]
CURVES = 2.0 + SCORES @ np.array([T, T**2, np.sin(9.0 * T)])


def test_as_many_components_as_the_error_asks() -> None:
    for error, count in ((1e-9, 3), (0.05, 2), (1.5, 1), (100.0, 0)):
        found = principal_components(CURVES, error=error)
        assert len(found.basis) == count
        rebuilt = found.curves(found.scores(CURVES))
        assert np.sqrt(np.square(rebuilt - CURVES).mean(axis=1)).max() <= error
    assert len(principal_components(CURVES, error=1e-9, most=1).basis) == 1


def test_the_basis_is_orthonormal_and_the_spread_that_of_the_scores() -> None:
    found = principal_components(CURVES, error=1e-9)
    np.testing.assert_allclose(found.basis @ found.basis.T, np.eye(3), atol=1e-12)
    scores = found.scores(CURVES)
    assert scores.std(axis=0) == pytest.approx(found.spread)
    assert scores.mean(axis=0) == pytest.approx(0.0, abs=1e-10)


def test_variance_is_that_of_many_draws() -> None:
    found = principal_components(CURVES, error=0.05)
    variance = np.array([0.4, 0.09])
    drawn = found.curves(RNG.normal(size=(40_000, 2)) * np.sqrt(variance))
    predicted = found.curve_variance(variance[None])[0] - found.rest
    assert drawn.var(axis=0) == pytest.approx(predicted, rel=0.05, abs=1e-6)
    left = CURVES - found.curves(found.scores(CURVES))
    assert found.rest == pytest.approx(np.square(left).mean(axis=0))


def test_curves_that_are_alike_have_no_components() -> None:
    found = principal_components(np.tile(T, (5, 1)), error=0.0)
    assert found.basis.shape == (0, 41)
    np.testing.assert_allclose(found.curves(np.zeros((2, 0))), np.tile(T, (2, 1)))


def test_a_hole_is_named() -> None:
    with pytest.raises(InputError, match="finite"):
        principal_components(np.where(np.arange(41) == 3, np.nan, CURVES), error=0.1)
    with pytest.raises(InputError, match="two or more rows"):
        principal_components(CURVES[:1], error=0.1)
