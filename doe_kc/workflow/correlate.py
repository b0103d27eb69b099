"""Correlate: from a study to the tuned axle, every true-solver evaluation into the store."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import TypedDict

import numpy as np

from doe_kc.axle.model import Axle
from doe_kc.campaign.runner import Campaign
from doe_kc.correlation.linearization import Linearization
from doe_kc.correlation.loop import Evaluate, Run, run_method
from doe_kc.correlation.methods import Method, MethodSettings, method_class
from doe_kc.correlation.posterior import ParameterPosterior, posterior
from doe_kc.correlation.problem import Candidate, Evaluated, Problem
from doe_kc.correlation.reach import Relaxation, conflict_sentences, level_sentences, reach_sentences
from doe_kc.correlation.result import Correlation
from doe_kc.correlation.twin_agreement import twin_agreement
from doe_kc.discovery.thresholds import AMPLITUDE_STEP
from doe_kc.ground.errors import InputError, RunError
from doe_kc.ground.threads import one_thread
from doe_kc.ground.typing import FloatArray
from doe_kc.parameter_influence.selection_result import Selection
from doe_kc.solver.result import NotConverged
from doe_kc.study import Study
from doe_kc.true_solver.make import solver_for
from doe_kc.true_solver.outcome import Outcome
from doe_kc.true_solver.own import AxleSolver
from doe_kc.variables import Space
from doe_kc.workflow.adopt import Adoption
from doe_kc.workflow.correlation_problem import (
    correlation_space,
    given_outcome,
    sought_problem,
    study_problem,
)
from doe_kc.workflow.measure import Reduced
from doe_kc.workflow.set_first import set_first


def expansion_at(problem: Problem, design: Evaluated) -> Linearization | None:
    """First-order expansion at a design, of the twin beside an outside solver; None where there is none."""
    if not problem.has_slopes:
        return None
    try:
        return problem.linearize(design.point)
    except NotConverged:
        return None


@one_thread()
def posterior_at(
    problem: Problem,
    expansion: Linearization | None,
    best: Evaluated,
    size_steps: Sequence[Axle] = (),
) -> ParameterPosterior | None:
    """What the data say of each variable; None without exact sensitivities.

    size_steps: of effects that were found in the same data, see `Adoption`, so that their sizes are open as
    well: each within its typical size before any record. Those of an outside solver's model are held.
    """
    if expansion is None or best.outcome.failed or not problem.likelihood.size:
        return None
    residual = problem.likelihood.residual(best.outcome.curves, best.outcome.characteristics)
    return posterior(
        problem.likelihood.jacobian(expansion.curves, expansion.characteristics),
        problem.space.prior_sd,
        residual=residual,
        point=best.point,
        start=problem.space.start,
        nuisance=_size_slopes(problem, best, residual, size_steps) if problem.exact else None,
    )


def _size_slopes(
    problem: Problem, best: Evaluated, residual: FloatArray, size_steps: Sequence[Axle]
) -> FloatArray:
    """(M, at most as many as steps) derivatives of the residual to the amplitudes at a design; a size with
    which there is no equilibrium is held."""
    values, columns = problem.space.values(best.point), []
    for axle in size_steps:
        outcome = AxleSolver(axle, problem.windows).evaluate(values)
        if not outcome.failed:
            larger = problem.likelihood.residual(outcome.curves, outcome.characteristics)
            columns.append((larger - residual) / AMPLITUDE_STEP)
    return np.column_stack(columns) if columns else np.zeros((residual.size, 0))


@one_thread()
def notes_on(
    problem: Problem, run: Run, at_best: Linearization | None, relaxed: Relaxation | None
) -> tuple[str, ...]:
    """Targets out of reach, constraints in conflict and levels too coarse, in sentences."""
    best = run.evaluated[run.best]
    said = reach_sentences(problem, relaxed) if relaxed is not None else []
    if at_best is None:
        return tuple(said)
    return (*said, *conflict_sentences(problem, best, at_best), *level_sentences(problem, best, at_best))


NEAREST = 160
"""Sampled designs that count as known, those nearest the start."""
NEAREST_WITH_SLOPES = 16
"""The same beside exact slopes. On the example 200 of them made a run ten times as long and no better."""


def sampled(campaign: Campaign, problem: Problem) -> list[tuple[Candidate, Outcome]]:
    """Stored designs of sampling campaigns that lie in the problem's space, those nearest the start.

    Beside slopes they say little, and surrogates slow down with the cube of their number.
    """
    start, most = problem.space.start, NEAREST_WITH_SLOPES if problem.has_slopes else NEAREST
    designs = [
        (candidate, record.key)
        for record in campaign.store.records("sample:*")
        if (candidate := inside(problem.space, record.parameters)) is not None
    ]
    designs.sort(key=lambda d: float(np.linalg.norm(d[0].point - start)))
    windows = campaign.solver.windows
    return [(c, campaign.store.outcome(key, windows)) for c, key in designs[:most]]


def inside(space: Space, values: Mapping[str, float]) -> Candidate | None:
    """The design as a point of the space; None when it is not one of it."""
    if not set(space.paths) <= set(values):
        return None
    point = space.unit(values)
    same = space.values(point)
    if set(same) != set(values) or any(abs(same[p] - v) > 1e-9 * max(1.0, abs(v)) for p, v in values.items()):
        return None
    return Candidate(point, "sample") if bool(((point >= 0.0) & (point <= 1.0)).all()) else None


def refit_proposal(problem: Problem, adoption: Adoption | None) -> list[Candidate]:
    """The design that a discovery fitted, within the bounds; none without one."""
    if adoption is None or not adoption.refit:
        return []
    space = problem.space
    point = np.array([v.place(adoption.refit.get(v.path, v.start)) for v in space.variables])
    return [Candidate(space.snapped(point), "discovery refit")]


Watch = Callable[[Sequence[Evaluated]], None]


class CorrelationChoices(TypedDict, total=False):
    """Keywords of `correlate` that callers hand on."""

    adoption: Adoption | None
    selection: Selection | None
    method: str | None
    budget: int | None
    workers: int | None
    scheduler: str | None


@one_thread()
def correlate(
    study: Study,
    reduced: Reduced | None,
    *,
    adoption: Adoption | None = None,
    selection: Selection | None = None,
    method: str | None = None,
    budget: int | None = None,
    workers: int | None = None,
    scheduler: str | None = None,
    watch: Watch = lambda _: None,
) -> Correlation:
    """Run the study's correlation method (or another) against the records and the typed targets.

    adoption: effects to begin with, and what the records hold that no model explains. selection: of the
    study's influence study, where it was made already. method, budget: in place of the study's own. watch:
    told of each round of evaluations. InputError for an unknown method, or sensitivities asked of a solver
    that gives none.
    """
    started = time.perf_counter()
    options, chosen = study.correlation, study_method(study, method)
    axle = study.axle if adoption is None else adoption.axle
    solver = solver_for(axle, study.solver, study.windows, study.folder)
    store = study.store if axle is study.axle else study.extended_store(solver.fingerprint())
    with Campaign(solver, store, workers=workers, scheduler=scheduler) as campaign:

        def ask(origin: str) -> Evaluate:
            return partial(campaign.evaluate, origin=origin)

        values, steps = set_first(study, reduced, ask("set_first"))
        space = correlation_space(study, reduced, adoption, selection, workers).started(values)
        plain = study_problem(study, reduced, space=space, adoption=adoption)
        (start,) = ask("baseline")([space.values(space.start)])
        if start.failed:
            raise RunError(f"the baseline axle cannot be solved: {start.reason}")
        given = None if axle is study.axle else given_outcome(study)
        problem, relaxed = sought_problem(study, plain, start, given)
        limit = budget or options.budget
        settings = MethodSettings(
            seed=study.seed,
            budget=limit,
            batch=options.batch,
            first=options.first,
            gradients=options.gradients,
        )
        run = run_method(
            problem,
            chosen(problem, settings),
            ask(f"correlate:{chosen.id}"),
            budget=limit,
            proposals=refit_proposal(problem, adoption),
            known=sampled(campaign, problem) if options.sampled else (),
            until_feasible=options.until == "feasible",
            watch=watch,
        )
        twin = twin_agreement(problem, run.evaluated, run.evaluated[run.best])
        believed = twin is None or twin.usable
        at_best = expansion_at(problem, run.evaluated[run.best]) if believed else None
    return Correlation(
        method=chosen.id,
        problem=problem,
        run=run,
        steps=(*steps, *(adoption.sentences if adoption is not None else ())),
        notes=notes_on(problem, run, at_best, relaxed),
        posterior=posterior_at(
            problem, at_best, run.evaluated[run.best], () if adoption is None else adoption.size_steps
        ),
        seconds=time.perf_counter() - started,
        relaxation=relaxed,
        given=None if given is None else problem.judged(-1, Candidate(space.start, "given axle"), given),
        twin=twin,
    )


def study_method(study: Study, name: str | None = None) -> type[Method]:
    """The method of that id, by default the study's; InputError where there is none or the solver cannot
    serve it."""
    options = study.correlation
    chosen = method_class(
        name or options.method, source="--method" if name else f"{study.source}: correlation.method"
    )
    if study.solver.command and chosen.needs_exact:
        raise InputError(
            f"{study.source}: {chosen.id} needs exact sensitivities, which an outside solver does not give; "
            "choose --method ego."
        )
    if study.solver.command and options.gradients is True:
        raise InputError(
            f"{study.source}: correlation.gradients = true needs exact sensitivities, which an outside "
            'solver does not give; leave it at "auto".'
        )
    return chosen
