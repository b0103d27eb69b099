"""Finished correlations to report on: a real one, one with everything odd, one with typed targets only."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache

import numpy as np

from doe_kc.axle_file import read_axle
from doe_kc.correlation.likelihood import Likelihood, build_likelihood
from doe_kc.correlation.loop import Run, run_method
from doe_kc.correlation.methods import METHODS, MethodSettings
from doe_kc.correlation.posterior import ParameterPosterior, posterior
from doe_kc.correlation.problem import Candidate, Evaluated, Problem, RatingForecast
from doe_kc.correlation.result import Correlation
from doe_kc.targets import CharacteristicOptions, build_targets
from doe_kc.true_solver.outcome import failure
from doe_kc.variables import VariableOptions, build_space
from tests.correlation.cases import AXLE, measured, outcome, problem, solver

CAR = "car_b"
STEPS = ("ride_height set to +1.20 mm from the vertical record (sd 0.3 mm).",)
ODD_WEIGHTS = (
    CharacteristicOptions(match="drive.anti_lift", goal="maximize", linear=0.5, quadratic=0.1),
    CharacteristicOptions(match="brake.*", linear=2.0, constraint_linear=3.0),
    CharacteristicOptions(match="vertical.bump_steer", low=-4.5, high=-4.0),
)
EVIL = "</script><script>alert('x')</script> & =1+1"


@lru_cache(maxsize=1)
def real() -> Correlation:
    """Gauss-Newton on a virtual car, with posterior."""
    case = problem(CAR)
    method = METHODS["gauss_newton"](case, MethodSettings(seed=1, budget=3))
    run = run_method(case, method, solver(case.axle), budget=3)
    expansion = case.linearize(run.evaluated[run.best].point)
    assert case.likelihood is not None
    rows = case.likelihood.jacobian(expansion.curves, expansion.characteristics)
    return Correlation("gauss_newton", case, run, STEPS, posterior(rows, case.space.prior_sd), seconds=12.3)


@lru_cache(maxsize=1)
def odd() -> Correlation:
    """Ties, a fixed parameter, designs at their bounds, failures, predictions, a maximized figure."""
    axle = read_axle(AXLE)
    options = VariableOptions.model_validate(
        {
            "use": ["LL?.?", "UPB.?", "llf.F?", "llr.F?", "sff.Fy", "spring.rate", "static.*"],
            "change": [
                {"match": "sfr.Fy", "tie": "sff.Fy"},
                {"match": "UPB.y", "tie": "UPB.x"},
                {"match": "ride_height", "fixed": 1.5},
            ],
        }
    )
    targets = build_targets(axle, measured(CAR), ODD_WEIGHTS, [], source="test")
    case = Problem(
        axle=axle,
        space=build_space(axle, options, "test"),
        targets=targets,
        likelihood=build_likelihood(axle, measured(CAR), targets),
        windows={},
        exact=True,
    )
    return Correlation("ego", case, _wandering(case), (), _made_up(case), seconds=3.0)


def _wandering(case: Problem) -> Run:
    """A failed design among ten; the last ones at bounds."""
    rng = np.random.default_rng(2)
    start = case.space.start
    runs = [case.judged(0, Candidate(start, "baseline"), outcome(case.axle, case.space.values(start)))]
    for i in range(1, 10):
        runs.append(_step(case, runs, i, rng))
    return Run(tuple(runs), max(range(4, 10), key=lambda k: runs[k].merit), "budget used up")


def _step(case: Problem, runs: list[Evaluated], i: int, rng: np.random.Generator) -> Evaluated:
    """On the way to the car, with detours."""
    there = np.clip([v.place(real().values[v.path]) for v in case.space.variables], 0.0, 1.0)
    point = case.space.start + (i / 10.0) * (there - case.space.start)
    point = np.clip(point + rng.normal(0, 0.1 / i**2, point.size), 0.0, 1.0)
    if i > 3:
        point[9], point[12] = 0.0, 1.0
    merit = max(e.merit for e in runs)
    guess = RatingForecast(np.zeros(0), np.zeros(0), merit * 0.7, abs(merit) * 0.1)
    candidate = Candidate(point, "first sample" if i < 4 else "ego", guess if i >= 4 else None)
    if i in {2, 6}:
        return case.judged(i, candidate, failure(f"no equilibrium in brake at 1200 N {EVIL}", 0.1))
    return case.judged(i, candidate, outcome(case.axle, case.space.values(point)))


def _made_up(case: Problem) -> ParameterPosterior:
    rows = np.diag(np.linspace(0.1, 200.0, case.space.dimension))
    return posterior(rows, case.space.prior_sd)


@lru_cache(maxsize=1)
def typed() -> Correlation:
    """No measurement, no posterior, no curves: two typed targets, one exactly met at the start."""
    axle = read_axle(AXLE)
    first = outcome(axle, {})
    met = float(first.value("steer.steering_ratio"))
    wanted = [
        CharacteristicOptions(match="vertical.bump_steer", target=-5.0),
        CharacteristicOptions(match="steer.steering_ratio", target=met),
        CharacteristicOptions(match="lateral.toe_change", target=0.0, sd=0.001, objective=True),
    ]
    targets = build_targets(axle, None, wanted, [], source="test")
    space = build_space(axle, VariableOptions.model_validate({"use": ["RIB.z", "ROB.z"]}), "test")
    case = Problem(
        axle=axle, space=space, targets=targets, likelihood=Likelihood((), ()), windows={}, exact=False
    )
    bare = replace(first, curves=None)
    moved = outcome(axle, space.values(np.array([0.75, 0.5])))
    runs = (
        case.judged(0, Candidate(space.start, "baseline"), bare),
        case.judged(1, Candidate(np.array([0.75, 0.5]), "ego"), replace(moved, curves=None)),
    )
    return Correlation("ego", case, Run(runs, 1, "converged"), (), None, seconds=0.5)


def all_three() -> dict[str, Correlation]:
    """By name."""
    return {"real": real(), "odd": odd(), "typed": typed()}
