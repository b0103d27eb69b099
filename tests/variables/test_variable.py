"""Variables: places between the bounds, levels, distributions."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats

from doe_kc.axle.design_parameters import Parameter
from doe_kc.variables import Variable
from doe_kc.variables.options import Distribution

PLAIN = Parameter(
    path="LLF.x", label="", group="HARDPOINTS", unit="mm", nominal=0.0, lower=-3, upper=3, step=1, active=True
)

CLEARANCE = replace(PLAIN, path="bump_stop.clearance", group="OTHER", nominal=11.0, lower=1.0, upper=21.0)


def variable(
    *, lower: float = -3.0, upper: float = 3.0, start: float = 0.0, levels: int | None = 101,
    distribution: Distribution = "uniform", logarithmic: bool = False,
) -> Variable:  # fmt: skip
    return Variable(
        parameter=PLAIN, lower=lower, upper=upper, start=start, levels=levels,
        distribution=distribution, logarithmic=logarithmic,
    )  # fmt: skip


FACTOR = variable(lower=0.5, upper=2.0, start=1.0, logarithmic=True)


@pytest.mark.parametrize("v", [variable(), FACTOR])
@given(u=st.floats(0.0, 1.0))
def test_place_undoes_value(v: Variable, u: float) -> None:
    assert v.place(v.value(u)) == pytest.approx(u, abs=1e-12)


@pytest.mark.parametrize("v", [variable(), FACTOR])
def test_slope_is_the_derivative(v: Variable) -> None:
    h = 1e-6
    assert v.slope(0.3) == pytest.approx((v.value(0.3 + h) - v.value(0.3 - h)) / (2 * h), rel=1e-8)


def test_a_factor_of_one_lies_in_the_middle_of_half_and_double() -> None:
    assert FACTOR.place(1.0) == pytest.approx(0.5)


@pytest.mark.parametrize("v", [variable(start=1.0), FACTOR])
def test_a_wider_range_keeps_its_middle(v: Variable) -> None:
    wide = v.widened(1.5)
    assert wide.value(0.5) == pytest.approx(v.value(0.5)) and wide.start == v.start
    assert wide.slope(0.5) == pytest.approx(1.5 * v.slope(0.5))


def test_a_range_that_is_not_below_zero_stays_so_hardpoints_aside() -> None:
    clearance = replace(variable(lower=1.0, upper=21.0, start=11.0), parameter=CLEARANCE)
    assert clearance.widened(2.0).lower == pytest.approx(0.5)
    assert clearance.widened(2.0).upper == pytest.approx(31.0)
    assert variable(lower=1.0, upper=7.0, start=4.0).widened(2.0).lower == pytest.approx(-2.0)


def test_levels_are_hundredths_of_the_range() -> None:
    v = variable()
    assert v.value(v.snapped(v.place(0.1))) == pytest.approx(0.12)
    assert v.snapped(0.5) == 0.5
    assert variable(levels=None).snapped(0.123456) == 0.123456


def test_uniform_draws_are_the_probabilities() -> None:
    p = np.linspace(0.01, 0.99, 9)
    np.testing.assert_array_equal(variable().drawn(p), p)


def test_gaussian_draws_are_a_normal_cut_at_the_bounds() -> None:
    p = np.linspace(0.001, 0.999, 999)
    drawn = variable(distribution="gaussian").drawn(p)
    known = stats.truncnorm(-3.0, 3.0, loc=0.5, scale=1.0 / 6.0)
    np.testing.assert_allclose(drawn, known.ppf(p), atol=1e-9)


def test_prior_sd() -> None:
    assert variable().prior_sd == pytest.approx(np.sqrt(1.0 / 12.0))
    assert variable(distribution="gaussian").prior_sd == pytest.approx(1.0 / 6.0)


def test_another_start_takes_the_bounds_along() -> None:
    moved = variable().started(1.0)
    assert (moved.lower, moved.start, moved.upper) == (-2.0, 1.0, 4.0)
