"""Distributions of deviations, and the correlations that they keep."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy import stats

from doe_kc.production_scatter.laws import DEVIATION_LAWS, DeviationLaw, normal_correlation

EVERY = [DEVIATION_LAWS[name](limits) for name in DEVIATION_LAWS for limits in (2.0, 3.0)]
NODES, WEIGHTS = np.polynomial.hermite_e.hermegauss(100)


@pytest.mark.parametrize("law", EVERY, ids=repr)
def test_mean_and_variance(law: DeviationLaw) -> None:
    values, weights = law.deviations(NODES), WEIGHTS / WEIGHTS.sum()
    assert weights @ values == pytest.approx(0.0, abs=1e-12)
    assert weights @ values**2 == pytest.approx(1.0, abs=2e-4)
    assert np.abs(law.deviations(np.array([-9.0, 9.0]))).max() <= law.reach + 1e-9
    assert np.all(np.diff(law.deviations(np.linspace(-5.0, 5.0, 99))) > 0.0)


def test_a_tolerance_is_where_a_law_ends() -> None:
    for name in ("truncated_normal", "uniform"):
        law = DEVIATION_LAWS[name](3.0)
        assert law.sd_of(1.5) * law.reach == pytest.approx(1.5)
    assert DEVIATION_LAWS["normal"](3.0).sd_of(1.5) == 0.5
    truth = stats.truncnorm(-2.0, 2.0).std()
    assert DEVIATION_LAWS["truncated_normal"](2.0).sd_of(2.0) == pytest.approx(truth)


def test_the_laws_are_those_of_scipy() -> None:
    z = np.linspace(-3.0, 3.0, 13)
    cut = stats.truncnorm(-2.0, 2.0)
    law = DEVIATION_LAWS["truncated_normal"](2.0)
    np.testing.assert_allclose(law.deviations(z), cut.ppf(stats.norm.cdf(z)) / cut.std(), atol=1e-9)
    uniform = stats.uniform(-math.sqrt(3.0), 2.0 * math.sqrt(3.0))
    np.testing.assert_allclose(
        DEVIATION_LAWS["uniform"](3.0).deviations(z), uniform.ppf(stats.norm.cdf(z)), atol=1e-12
    )


@pytest.mark.parametrize("value", [-0.9, -0.3, 0.5, 1.0])
def test_uniform_correlation_in_closed_form(value: float) -> None:
    """Of uniform variables: 2 sin(pi rho / 6) (Pearson 1907)."""
    uniform = DEVIATION_LAWS["uniform"](3.0)
    truth = 2.0 * math.sin(math.pi * value / 6.0)
    assert normal_correlation(uniform, uniform, value) == pytest.approx(truth, abs=1e-9)


def test_unlike_laws_keep_their_correlation() -> None:
    first, second = DEVIATION_LAWS["uniform"](3.0), DEVIATION_LAWS["truncated_normal"](2.0)
    r = normal_correlation(first, second, 0.8)
    z = np.random.default_rng(1).standard_normal((200_000, 2))
    x = first.deviations(z[:, 0]), second.deviations(r * z[:, 0] + math.sqrt(1.0 - r * r) * z[:, 1])
    assert np.corrcoef(*x)[0, 1] == pytest.approx(0.8, abs=0.003)


def test_unlike_laws_are_never_wholly_correlated() -> None:
    with pytest.raises(ValueError, match=r"at most 0\.977"):
        normal_correlation(DEVIATION_LAWS["normal"](3.0), DEVIATION_LAWS["uniform"](3.0), 0.99)
