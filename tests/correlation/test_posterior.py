"""Standard deviations of the variables: with a misfit, and at a bound."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import quad

from doe_kc.correlation.posterior import posterior

PRIOR = np.full(2, 12.0**-0.5)
JACOBIAN = np.array([[30.0, 0.0], [0.0, 10.0], [5.0, 5.0]])


def test_a_misfit_multiplies_what_the_data_say() -> None:
    plain = posterior(JACOBIAN, PRIOR)
    left = np.full(3, 2.0)
    doubted = posterior(JACOBIAN, PRIOR, residual=left)
    assert plain.misfit == 1.0 and doubted.misfit == pytest.approx(2.0)
    weighted = posterior(JACOBIAN / 2.0, PRIOR)
    np.testing.assert_allclose(doubted.sd, weighted.sd)
    assert (doubted.sd > 1.5 * plain.sd).all() and (doubted.sd <= PRIOR).all()


def test_less_than_noise_gives_no_smaller_deviation() -> None:
    np.testing.assert_array_equal(
        posterior(JACOBIAN, PRIOR, residual=np.full(3, 0.3)).sd, posterior(JACOBIAN, PRIOR).sd
    )


@pytest.mark.parametrize("push", [0.0, 1.0, 30.0, 300.0])
def test_at_a_bound_the_value_lies_inward_within_68_percent(push: float) -> None:
    """Against the integral of the density beyond the bound, exp(-g t - t^2 / 2 sd^2)."""
    jacobian = np.array([[20.0]])
    found = posterior(jacobian, PRIOR[:1], residual=np.array([push / 20.0]), point=np.array([0.0]))
    sd, slope = float(found.sd[0]), push / found.misfit**2

    def density(t: float) -> float:
        return float(np.exp(-slope * t - 0.5 * (t / sd) ** 2))

    end = 12.0 * min(sd, 1.0 / slope if slope else np.inf)
    whole = quad(density, 0.0, end, epsabs=1e-14)[0]
    inside = quad(density, 0.0, float(found.inward[0]), epsabs=1e-14)[0]
    assert found.at_bound[0] == -1 and inside / whole == pytest.approx(0.6827, abs=1e-3)


def test_between_the_bounds_there_is_nothing_one_sided() -> None:
    found = posterior(JACOBIAN, PRIOR, residual=np.zeros(3), point=np.array([0.5, 1.0]))
    assert list(found.at_bound) == [0, 1]
    assert np.isnan(found.inward[0]) and np.isfinite(found.inward[1])
