"""Gauss-Newton on cars whose parameters are known."""

from __future__ import annotations

import numpy as np
import pytest

from doe_kc.correlation.loop import run_method
from doe_kc.correlation.methods import METHODS, Settings
from doe_kc.correlation.posterior import posterior
from tests.correlation.cases import problem, solver, truth


@pytest.mark.parametrize("car", ["car_b", "car_e"])
def test_fits_the_curves_to_noise_and_recovers_what_the_data_see(car: str) -> None:
    case = problem(car)
    method = METHODS["gauss_newton"](case, Settings(seed=1, budget=20))
    run = run_method(case, method, solver(case.axle), budget=20)
    best = run.evaluated[run.best]
    assert method.stopped.startswith("converged")
    assert best.outcome.curves is not None
    residual = case.likelihood.residual(best.outcome.curves, best.outcome.characteristics)
    assert 0.9 < np.mean(residual**2) < 1.1
    assert best.rating is not None and best.rating.feasible
    expansion = case.linearize(best.point)
    found = posterior(
        case.likelihood.jacobian(expansion.curves, expansion.characteristics), case.space.prior_sd
    )
    known = truth(car, case.axle)
    seen = [i for i, v in enumerate(case.space.variables) if found.visible[i] and v.path in known]
    distance = [
        (best.point[i] - case.space.variables[i].place(known[case.space.paths[i]])) / found.sd[i]
        for i in seen
    ]
    assert len(seen) > 30
    assert np.mean(np.abs(distance) <= 2.0) >= 0.9
