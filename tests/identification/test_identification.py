"""A known car found from its matrix; what the matrix does not say stays at the prior."""

from __future__ import annotations

import numpy as np
import pytest

from doe_kc.axle import parameter_value
from doe_kc.ground.errors import RunError
from doe_kc.identification.identification import Identification, identification
from tests.identification.cases import CAR, FREE, car_matrix, model


@pytest.fixture(scope="module")
def result() -> Identification:
    return identification(model(car_matrix()), starts=2, seed=3, workers=1)


def test_the_car_is_found(result: Identification) -> None:
    for path, value in CAR.items():
        assert parameter_value(result.axle, path) == pytest.approx(value, rel=2e-3), path
    assert result.agreement.means == pytest.approx((1.0, 1.0), abs=1e-6)
    assert result.agreement_before.means[1] < 0.99
    np.testing.assert_allclose(result.in_measured_units, result.measured.values, atol=0.2)


def test_both_starts_end_there(result: Identification) -> None:
    starts = result.starts()
    assert starts["converged"].all() and starts["distance"].max() < 1e-2
    assert starts["cost"].is_monotonic_increasing


def test_a_column_of_the_other_sign_is_the_same_measurement(result: Identification) -> None:
    flipped = car_matrix() * [1, -1, 1, 1, -1, 1]
    other = identification(model(flipped), starts=1, workers=1)
    np.testing.assert_allclose(other.best.z, result.best.z, atol=1e-2)
    assert other.agreement.sign.tolist() == [1, -1, 1, 1, -1, 1]
    strict = identification(model(flipped, any_sign=False, noise=0.1), starts=1, workers=1)
    assert strict.agreement.means[1] < 0.9


def test_masked_cells_are_predicted() -> None:
    wrong = car_matrix().copy()
    wrong.loc["ROB.x", "lateral.toe_change"] /= 10.0
    masked = identification(model(wrong, mask=(("ROB.x", "lateral.toe_change"),)), starts=1, workers=1)
    i, j = list(wrong.index).index("ROB.x"), list(wrong.columns).index("lateral.toe_change")
    assert masked.in_measured_units[i, j] == pytest.approx(10.0 * wrong.iloc[i, j], rel=5e-3)
    seen = identification(model(wrong), starts=1, workers=1)
    assert seen.best.cost > 100.0 * masked.best.cost


def test_two_processes_and_the_same_seed_say_the_same(result: Identification) -> None:
    other = identification(model(car_matrix()), starts=2, seed=3, workers=2)
    for one, two in zip(result.fits, other.fits, strict=True):
        np.testing.assert_array_equal(one.z, two.z)


def test_what_the_matrix_does_not_say_stays_at_the_prior() -> None:
    """The torsion stiffness of a sub-frame mount moves none of these columns."""
    free = {**FREE, "sff.Tz": 2.0}
    values = identification(model(car_matrix(), free, noise=0.01), starts=1, workers=1).parameters()
    row = values.loc["sff.Tz"]
    assert row["identified"] == pytest.approx(1.0, abs=1e-3)
    assert row["sd_after"] == pytest.approx(row["sd_before"], rel=1e-3)
    assert values.loc["upb.Fy", "sd_after"] < 0.1 * values.loc["upb.Fy", "sd_before"]


def test_sd_of_one_unknown_is_the_textbook_one() -> None:
    """sd after / sd before = 1 / sqrt(1 + |J|^2)."""
    alone = identification(model(car_matrix(), {"llr.Fx": 2.0}, noise=0.05), starts=1, workers=1)
    values, (direction,) = alone.parameters(), [row for _, row in alone.directions().iterrows()]
    length = float(np.linalg.norm(alone.best.jacobian))
    assert direction["information"] == pytest.approx(length) and alone.informed == int(length > 1.0)
    ratio = values["sd_after"].item() / values["sd_before"].item()
    assert ratio == pytest.approx(1.0 / np.sqrt(1.0 + length**2)) == direction["sd_ratio"]
    assert direction["unknowns"] == "llr.Fx +1.00"


def test_a_bound_holds_what_lies_beyond() -> None:
    """llr.Fx of the car is 0.6; with 1.05 per sd it may go to 1.05 ** -2.5 = 0.885."""
    values = identification(model(car_matrix(), {"llr.Fx": 1.05}), starts=1, workers=1).parameters()
    assert values["at_bound"].item() and values["identified"].item() == pytest.approx(1.05**-2.5)


def test_starts_without_equilibrium_are_said(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("doe_kc.identification.identification.projected_fit", lambda *_: None)
    with pytest.raises(RunError, match="none of 20 starts"):
        identification(model(car_matrix()), starts=2, workers=1)
