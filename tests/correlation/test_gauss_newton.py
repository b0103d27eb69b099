"""Gauss-Newton on cars whose parameters are known."""

from __future__ import annotations

import numpy as np
import pytest

from doe_kc.axle import with_values
from doe_kc.correlation.least_squares import ConstraintPenalty
from doe_kc.correlation.loop import run_method
from doe_kc.correlation.methods import METHODS, MethodSettings
from doe_kc.correlation.posterior import posterior
from doe_kc.correlation.problem import Evaluated, Problem
from doe_kc.targets.options import CharacteristicOptions
from tests.correlation.cases import outcome, problem, solver, truth


@pytest.mark.parametrize("car", ["car_b", "car_e"])
def test_fits_the_curves_to_noise_and_recovers_what_the_data_see(car: str) -> None:
    case = problem(car)
    method = METHODS["gauss_newton"](case, MethodSettings(seed=1, budget=20))
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


def test_what_the_records_alone_would_violate_is_met_where_it_is_a_constraint() -> None:
    free = problem("car_b")
    fitted = _fitted(free).outcome.characteristics[free.targets.rows]
    names = [t.entry.id for t in free.targets.characteristics]
    at = names.index("vertical.bump_steer")
    low, high = fitted[at] + 0.3, fitted[at] + 0.6
    options = [CharacteristicOptions(match="vertical.bump_steer", low=low, high=high)]
    case = problem("car_b", characteristics=options)
    held = _fitted(case)
    assert held.rating is not None and held.rating.feasible
    value = held.outcome.characteristics[case.targets.rows][at]
    assert low <= value <= low + 0.02 * (high - low), "it leans on the wall that the records pull it to"


@pytest.mark.parametrize("seed", [3, 4])
def test_meets_constraints_from_a_start_that_violates_most_of_them(seed: int) -> None:
    nominal = problem("car_b")
    rng = np.random.default_rng(seed)
    point = nominal.space.start + rng.uniform(-0.3, 0.3, nominal.space.dimension)
    values = {n: v for n, v in nominal.space.values(np.clip(point, 0.0, 1.0)).items() if "." in n}
    case = problem("car_b", axle=with_values(nominal.axle, values))
    base = outcome(case.axle, {}).characteristics[ConstraintPenalty.of(case.targets).rows]
    assert np.count_nonzero(ConstraintPenalty.of(case.targets).excess(base)) > 5
    best = _fitted(case)
    assert best.rating is not None and best.rating.feasible


def _fitted(case: Problem) -> Evaluated:
    method = METHODS["gauss_newton"](case, MethodSettings(seed=1, budget=30))
    run = run_method(case, method, solver(case.axle), budget=30)
    assert method.stopped.startswith("converged")
    return run.evaluated[run.best]
