"""What the data say of the variables: with a misfit, at a bound, away from the most probable design."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import lsq_linear

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


def test_the_offset_leads_to_the_most_probable_place_between_the_bounds() -> None:
    """Against bounded least squares of SciPy on the same data and prior."""
    rng = np.random.default_rng(4)
    jacobian, others = rng.normal(0.0, 4.0, (200, 3)), rng.normal(0.0, 4.0, (200, 2))
    point, start, prior = np.array([0.2, 0.5, 0.97]), np.full(3, 0.5), np.full(3, 0.5)
    residual = rng.normal(0.0, 1.0, 200) - jacobian @ np.array([0.9, 0.1, -0.2])
    seen = posterior(jacobian, prior, residual=residual, point=point, start=start, nuisance=others)
    rows = np.vstack([np.hstack([jacobian, others]) / seen.misfit, np.diag([2.0, 2.0, 2.0, 1.0, 1.0])])
    values = -np.concatenate([residual / seen.misfit, (point - start) * 2.0, np.zeros(2)])
    box = (np.append(-point, [-np.inf] * 2), np.append(1.0 - point, [np.inf] * 2))
    expected = lsq_linear(rows, values, box, method="bvls", tol=1e-14).x[:3]
    np.testing.assert_allclose(seen.offset, expected, atol=1e-9)
    assert point[0] + expected[0] == pytest.approx(1.0), "it ends at a bound"


def test_the_error_of_a_design_has_the_size_that_is_stated() -> None:
    """2000 cars drawn from the prior, with a number that nobody asks for, and a design that is not the most
    probable: the car's value less the design's has the mean square that is stated, at every variable."""
    rng = np.random.default_rng(5)
    jacobian, others = rng.normal(0.0, 1.0, (600, 3)), rng.normal(0.0, 0.1, (600, 1))
    others += 0.03 * jacobian[:, :1]
    prior, start, point = np.full(3, 0.04), np.full(3, 0.5), np.array([0.46, 0.52, 0.55])
    errors, stated, alone = [], [], []
    for _ in range(2000):
        moved, more = rng.normal(0.0, prior), rng.normal(size=1)
        residual = jacobian @ (point - start - moved) - others @ more + rng.normal(0.0, 1.0, 600)
        seen = posterior(jacobian, prior, residual=residual, point=point, start=start, nuisance=others)
        errors.append((start + moved - point) ** 2)
        stated.append(seen.rms_error**2)
        alone.append(seen.sd**2)
    np.testing.assert_allclose(np.mean(errors, axis=0) / np.mean(stated, axis=0), 1.0, atol=0.06)
    assert (np.mean(errors, axis=0) > 1.3 * np.mean(alone, axis=0)).all()
