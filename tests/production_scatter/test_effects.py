"""Shares of the variance, what tightening brings, and statistics, each against a closed form."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy import stats

from doe_kc.characteristics import CHARACTERISTICS
from doe_kc.production_scatter.first_order import FirstOrderScatter, regression_slopes
from doe_kc.production_scatter.requirements import Requirement
from doe_kc.production_scatter.statistics import car_share, moments, percentile_of
from doe_kc.production_scatter.tightening import tightenings
from doe_kc.production_scatter.total_effects import total_effects
from tests.production_scatter.cases import plain_model, scatter_of

ENTRY = CHARACTERISTICS["vertical.bump_steer"]


def test_variance_of_a_linear_model_with_correlations() -> None:
    """Var(a x + b y) = a² s² + b² t² + 2 a b r s t; shares by Cov(y, a x) / Var(y)."""
    model = plain_model([2.0, 0.5], np.array([[1.0, -0.6], [-0.6, 1.0]]))
    first = FirstOrderScatter(np.array([[3.0, 4.0]]), model.covariance, "test")
    variance = 9.0 * 4.0 + 16.0 * 0.25 - 2.0 * 3.0 * 4.0 * 0.6 * 2.0 * 0.5
    assert first.sd[0] == pytest.approx(math.sqrt(variance))
    covariance = 3.0 * 4.0 * 0.6 * 2.0 * 0.5
    np.testing.assert_allclose(first.shares[0] * variance, [36.0 - covariance, 4.0 - covariance])
    assert first.shares.sum() == pytest.approx(1.0) and first.shares[0, 1] < 0.0
    x = model.deviations(100_000, 1)
    assert first.changes(x).std() == pytest.approx(first.sd[0], rel=0.01)
    np.testing.assert_allclose(regression_slopes(x[:500], first.changes(x[:500])), first.slopes, rtol=1e-6)


def test_total_shares_of_a_quadratic_in_closed_form() -> None:
    """y = 2 u + v² + u v of standard normal u, v: variance 4 + 2 + 1, totals (4 + 1) / 7 and (2 + 1) / 7."""
    model = plain_model([0.5, 2.0, 1.0])
    x = model.deviations(4000, 1)
    u, v = x[:, 0] / 0.5, x[:, 1] / 2.0
    y = (2.0 * u + v**2 + u * v)[:, None]
    done = total_effects(x, y, np.array([[4.0, 0.0, 0.0]]), model)
    np.testing.assert_allclose(done.shares[:, 0], [5.0 / 7.0, 3.0 / 7.0, 0.0], atol=0.02)
    assert done.unexplained[0] < 1e-6
    rough = total_effects(x, y + np.sin(4.0 * x[:, 2:]), np.array([[4.0, 0.0, 0.0]]), model)
    assert 0.04 < rough.unexplained[0] < 0.08  # variance 1/2 of 7.5 that no quadratic has


def test_an_interaction_of_the_two_sides_counts_once() -> None:
    model = scatter_of(parameters=["LLF.z", "ROB.z"], common=0.0, distribution="normal")
    x = model.deviations(3000, 2)
    y = (x[:, 0] * x[:, 1])[:, None]
    done = total_effects(x, y, np.zeros((1, 4)), model)
    np.testing.assert_allclose(done.shares[:, 0], [1.0, 0.0], atol=1e-3)


def test_halving_a_scatter_of_a_linear_model() -> None:
    """Of a normal y of variance a² + b², requirement |y| < L: 2 Phi(-L / sd) of the cars are outside."""
    model = plain_model([1.0, 1.0])
    slopes = np.array([[3.0, 4.0]])
    x = model.deviations(100_000, 4)
    values = x @ slopes.T
    first = FirstOrderScatter(slopes, model.covariance, "test")
    requirement = Requirement(ENTRY, -8.0, 8.0)
    one, other = tightenings(model, x, values, first, [(0, requirement)])
    for t, sd, twice in (
        (one, math.hypot(1.5, 4.0), math.hypot(6.0, 4.0)),
        (other, math.hypot(3.0, 2.0), math.hypot(3.0, 8.0)),
    ):
        assert t.sd_ratio[0] == pytest.approx(sd / 5.0, rel=0.01)
        assert t.any_outside.share == pytest.approx(2.0 * stats.norm.cdf(-8.0 / sd), abs=0.003)
        assert t.doubled.share == pytest.approx(2.0 * stats.norm.cdf(-8.0 / twice), abs=0.005)
        assert t.missed == t.any_outside.share == t.outside[0].share
    np.testing.assert_allclose([one.sd_slope[0], other.sd_slope[0]], [9.0 / 5.0, 16.0 / 5.0])


@pytest.mark.parametrize(("count", "n"), [(0, 50), (3, 50), (25, 50), (50, 50), (1, 1000)])
def test_the_interval_of_a_share_is_wilsons(count: int, n: int) -> None:
    share = car_share(count, n)
    truth = stats.binomtest(count, n).proportion_ci(0.95, method="wilson")
    assert (share.low, share.high) == pytest.approx((truth.low, truth.high), abs=1e-12)
    assert share.share == count / n


def test_moments() -> None:
    rng = np.random.default_rng(1)
    values = rng.normal(3.0, 2.0, 20_000)
    m = moments(values)
    assert m.sd_error == pytest.approx(2.0 / math.sqrt(2.0 * len(values)), rel=0.05)  # of a normal sample
    assert m.mean == pytest.approx(3.0, abs=0.05) and abs(m.skewness) < 0.06
    assert moments(rng.exponential(size=50_000)).skewness == pytest.approx(2.0, abs=0.15)
    assert moments(np.full(10, 2.5)).sd == 0.0
    assert percentile_of(2.0, np.array([1.0, 2.0, 3.0, 4.0])) == 37.5


def test_a_requirement_of_one_side() -> None:
    requirement = Requirement(ENTRY, -math.inf, 1.0)
    assert requirement.outside(np.array([-1e9, 1.0, 1.1])).tolist() == [False, False, True]
