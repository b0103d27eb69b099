"""One search of a case: how many evaluations of the outside model it took."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from benchmarks.twin.cars import TwinCase, write_case
from benchmarks.twin.corrections import CORRECTIONS, led_by
from doe_kc.campaign.runner import Campaign
from doe_kc.correlation.loop import run_method
from doe_kc.correlation.methods import MethodSettings
from doe_kc.correlation.methods._base import best_design
from doe_kc.correlation.methods.ego import Ego
from doe_kc.correlation.problem import Evaluated, Problem
from doe_kc.correlation.twin_agreement import twin_agreement
from doe_kc.study import read_study
from doe_kc.targets import improvements, mean_improvement
from doe_kc.true_solver.make import solver_for
from doe_kc.workflow.correlation_problem import sought_problem, study_problem
from doe_kc.workflow.measure import study_records

NO_TWIN = "no twin"
REACHED = 98.0
"""% mean improvement."""


@dataclass(frozen=True)
class TwinRun:
    """feasible, reached: evaluations until every constraint was met, until the mean improvement was REACHED;
    None for never. improvement: (n,) % of the best design after each evaluation. agreement: what is said of
    the twin, empty without one. own_cpu: seconds of this process, the outside model's not in them."""

    case: str
    how: str
    seed: int
    feasible: int | None
    reached: int | None
    improvement: tuple[float, ...]
    agreement: str
    own_cpu: float


def run(case: TwinCase, how: str, seed: int, budget: int, folder: Path) -> TwinRun:
    """A search with the study's own method, its outside model behind the protocol."""
    twin = how != NO_TWIN
    study = read_study(write_case(case, folder, twin=twin, seed=seed, budget=budget))
    reduced = study_records(study)
    plain = study_problem(study, reduced)
    solver = solver_for(study.axle, study.solver, study.windows, study.folder)
    started = time.process_time()
    with Campaign(solver, study.store, workers=1) as campaign:
        (start,) = campaign.evaluate([plain.space.values(plain.space.start)], "baseline")
        problem, _ = sought_problem(study, plain, start)
        method = Ego(problem, MethodSettings(seed=seed, budget=budget))
        if twin:
            method = led_by(method, problem, CORRECTIONS[how])
        done = run_method(problem, method, lambda d: campaign.evaluate(d, "ego"), budget=budget)
    agreement = twin_agreement(problem, done.evaluated, done.evaluated[done.best])
    improvement, feasible = _course(problem, done.evaluated)
    return TwinRun(
        case.name,
        how,
        seed,
        _first(feasible),
        _first([value >= REACHED for value in improvement]),
        tuple(improvement),
        "" if agreement is None else agreement.line,
        time.process_time() - started,
    )


def _course(problem: Problem, evaluated: Sequence[Evaluated]) -> tuple[list[float], list[bool]]:
    """Mean improvement and feasibility of the design that would be handed over after each evaluation."""
    values, feasible = [], []
    for n in range(1, len(evaluated) + 1):
        best = evaluated[best_design(evaluated[:n])]
        if evaluated[0].score is None or best.score is None:
            raise ValueError("the outside model has no answer to the start")
        entries = improvements(problem.targets, evaluated[0].score, best.score, sought=problem.search)
        values.append(mean_improvement(entries))
        feasible.append(bool(best.rating is not None and best.rating.feasible))
    return values, feasible


def _first(marks: Sequence[bool]) -> int | None:
    """Number of the first that is true, counted from 1."""
    return next((i for i, mark in enumerate(marks, start=1) if mark), None)
