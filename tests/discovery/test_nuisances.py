"""A calibration of the rig and a wrong input are one number, by the same columns."""

from __future__ import annotations

import numpy as np
import pytest

from doe_kc.correlation.likelihood import record_likelihood
from doe_kc.discovery.derivatives import amplitude_columns
from doe_kc.discovery.fit import Fit, amplitude_estimates
from doe_kc.discovery.gauss_newton import fit, known_columns
from doe_kc.discovery.jacobian import Jacobian
from doe_kc.discovery.model import EffectModel
from doe_kc.discovery.nuisances import side_differences, sided_variables
from doe_kc.discovery.thresholds import INPUT_GAIN, SIDE_BUSHING
from doe_kc.effects.hypothesis import Hypothesis
from doe_kc.ground.typing import FloatArray
from doe_kc.solver.curve_set import curve_set
from doe_kc.solver.suite import solve
from tests.discovery.cases import LOAD_CASES, library, nominal, records, space

SEEDS = (1, 2)


@pytest.fixture(scope="module", params=SEEDS)
def tuned(request: pytest.FixtureRequest) -> Fit:
    """A sound car on a sound rig."""
    car = EffectModel(nominal(), space(), record_likelihood(nominal(), records("none", request.param)))
    return fit(car, car.centre)


def wrong_input(case: str) -> Hypothesis:
    return next(h for h in library("rig_input_gain") if h.location == case)


def test_a_stop_touches_inside_the_sweep() -> None:
    """Else the tests below say little: the slope of the curve jumps there."""
    vertical = curve_set(solve(nominal())).cases["vertical"]
    slope = np.gradient(vertical.mean["tyre_load"][0], vertical.input)
    assert slope[0] > 2.0 * slope[2]


@pytest.mark.parametrize("case", LOAD_CASES)
def test_the_calibration_is_the_effect_s_own_column(tuned: Fit, case: str) -> None:
    model = tuned.model.extended(wrong_input(case))
    place = model.calibrations.start + model.cases.index(case)
    z = np.append(tuned.z, 0.0)
    effect = amplitude_columns(model, z, tuned.residual, [tuned.z.size])[:, 0] / np.log(1.05)
    calibration = tuned.jacobian.dense[:, place] / INPUT_GAIN
    assert np.linalg.norm(effect) > 50.0
    assert np.linalg.norm(effect - calibration) < 0.01 * np.linalg.norm(effect)


@pytest.mark.parametrize("case", LOAD_CASES)
def test_a_sound_rig_gives_no_wrong_input(tuned: Fit, case: str) -> None:
    """Neither one that cancels its calibration nor a sum of both."""
    place = tuned.model.calibrations.start + tuned.model.cases.index(case)
    model = tuned.model.extended(wrong_input(case))
    found = fit(model, np.append(tuned.z, 0.0), known=known_columns(tuned, model))
    assert found.evidence < tuned.evidence - 1.5
    assert abs(tuned.z[place]) < 3.0 * np.sqrt(tuned.covariance[place, place])
    (total,), (sd,) = amplitude_estimates(found, wrong_input(case))
    assert abs(total) < 3.0 * sd
    assert sd <= np.sqrt(found.covariance[-1, -1])


def test_the_records_show_the_sum_of_both(tuned: Fit) -> None:
    """Moved from the one to the other, nothing changes but the prior's cost."""
    steer = wrong_input("steer")
    model = tuned.model.extended(steer)
    place = model.calibrations.start + model.cases.index("steer")
    z = np.append(tuned.z, 0.0)
    z[place] = 2.0
    moved = z.copy()
    moved[place], moved[-1] = 0.0, np.log1p(2.0 * INPUT_GAIN) / np.log(1.05)
    np.testing.assert_allclose(model.residual(moved), model.residual(z), atol=1e-3)
    blank = np.zeros((model.likelihood.size, z.size))
    totals = [
        amplitude_estimates(Fit(model, at, blank[:, 0], Jacobian(blank), 0.0, 1, True), steer)[0][0]
        for at in (z, moved)
    ]
    assert totals[0] == pytest.approx(totals[1], rel=5e-3)


def test_a_side_differs_by_a_share_of_its_own_value() -> None:
    """Of a bushing twice as stiff on the right the right one scatters twice as much."""
    path = "llr.Fy"
    stiffer = nominal().changed({f"{path}@R": 2.0 * nominal().values[f"{path}@L"]})
    likelihood = record_likelihood(nominal(), records("none", 1))
    place = [v.path for v in sided_variables(stiffer, space())].index(path)
    half = 0.5 * SIDE_BUSHING

    def unlike(of: float) -> FloatArray:
        moved = {
            f"{path}@{side}": stiffer.values[f"{path}@{side}"] * (1.0 + sign * of * half)
            for side, sign in (("L", -1.0), ("R", 1.0))
        }
        return likelihood.residual(curve_set(solve(stiffer.changed(moved))), np.zeros(0))

    change = 0.5 * (unlike(1.0) - unlike(-1.0))
    column = side_differences(stiffer, space(), likelihood)[:, place]
    assert np.linalg.norm(column - change) < 1e-3 * np.linalg.norm(change)
