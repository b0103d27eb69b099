"""Correlate: from a study to the tuned axle, every true-solver evaluation into the store."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from functools import partial

from doe_kc.campaign.runner import Campaign
from doe_kc.correlation.advice import conflict_sentences, level_sentences, reach_sentences
from doe_kc.correlation.likelihood import build_likelihood
from doe_kc.correlation.linearization import Linearization
from doe_kc.correlation.loop import Evaluate, Run, run_method
from doe_kc.correlation.methods import Method, Settings, method_class
from doe_kc.correlation.posterior import Posterior, posterior
from doe_kc.correlation.problem import Candidate, Evaluated, Problem
from doe_kc.correlation.result import Correlation
from doe_kc.errors import InputError
from doe_kc.measurement import Measurement
from doe_kc.solver.result import NotConverged
from doe_kc.study import Study
from doe_kc.targets import build_targets
from doe_kc.threads import one_thread
from doe_kc.true_solver.make import solver_for
from doe_kc.true_solver.outcome import Outcome
from doe_kc.variables import Space, build_space
from doe_kc.variables.build import Advice
from doe_kc.workflow.influence import study_influence
from doe_kc.workflow.measure import Reduced
from doe_kc.workflow.set_first import set_first

Watch = Callable[[Sequence[Evaluated]], None]


@one_thread()
def correlate(
    study: Study,
    reduced: Reduced | None,
    *,
    method: str | None = None,
    budget: int | None = None,
    workers: int | None = None,
    scheduler: str | None = None,
    watch: Watch = lambda _: None,
) -> Correlation:
    """Run the study's correlation method (or another) against the records and the typed targets.

    method, budget: in place of the study's own. watch: told of each round of evaluations. InputError for
    an unknown method, or sensitivities asked of a solver that gives none.
    """
    started = time.perf_counter()
    options, chosen = study.correlation, study_method(study, method)
    solver = solver_for(study.axle, study.solver, study.windows, study.folder)
    with Campaign(solver, study.store, workers=workers, scheduler=scheduler) as campaign:

        def ask(origin: str) -> Evaluate:
            return partial(campaign.evaluate, origin=origin)

        values, steps = set_first(study, reduced, ask("set_first"))
        problem = study_problem(study, reduced, space=study_space(study, reduced, workers).started(values))
        limit = budget or options.budget
        settings = Settings(
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
            known=sampled(campaign, problem) if options.sampled else (),
            until_feasible=options.until == "feasible",
            watch=watch,
        )
    at_best = expansion_at(problem, run.evaluated[run.best])
    return Correlation(
        method=chosen.id,
        problem=problem,
        run=run,
        steps=steps,
        notes=notes_on(problem, run, at_best),
        posterior=posterior_at(problem, at_best),
        seconds=time.perf_counter() - started,
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


@one_thread()
def study_problem(study: Study, reduced: Reduced | None, *, space: Space | None = None) -> Problem:
    """The correlation problem of a study, with its own variables or others."""
    measurement = reduced.measurement if reduced is not None else None
    targets = build_targets(
        study.axle, measurement, study.characteristics, study.curves, source=str(study.source)
    )
    only_targets = study.correlation.data == "targets"
    return Problem(
        axle=study.axle,
        space=space or study.space,
        targets=targets,
        likelihood=build_likelihood(study.axle, measurement, targets, only_targets=only_targets),
        windows=study.windows,
        exact=not study.solver.command,
    )


def study_space(study: Study, reduced: Reduced | None, workers: int | None = None) -> Space:
    """The study's variables; for `use = "selection"` those that the influence study advises.

    InputError when it is asked for without records.
    """
    if study.variables.use != "selection":
        return study.space
    measurement: Measurement | None = reduced.measurement if reduced is not None else None
    if measurement is None:
        raise InputError(
            f'{study.source}: variables: use = "selection" needs a measurement for the influence study to '
            'choose for; name one, or use = ["*"].'
        )
    selection = study_influence(study, measurement, workers=workers).selection
    used = selection.variables if selection is not None else ()
    bounds = {v.parameter.path: (v.lower, v.upper) for v in used if v.used}
    return build_space(study.axle, study.variables, str(study.source), advice=Advice(bounds))


def sampled(campaign: Campaign, problem: Problem) -> list[tuple[Candidate, Outcome]]:
    """Stored designs of sampling campaigns that lie in the problem's space."""
    found = []
    for record in campaign.store.records("sample:*"):
        point = inside(problem.space, record.parameters)
        if point is not None:
            found.append((point, campaign.store.read(record, campaign.solver.windows)))
    return found


def inside(space: Space, values: Mapping[str, float]) -> Candidate | None:
    """The design as a point of the space; None when it is not one of it."""
    if not set(space.paths) <= set(values):
        return None
    point = space.unit(values)
    same = space.values(point)
    if set(same) != set(values) or any(abs(same[p] - v) > 1e-9 * max(1.0, abs(v)) for p, v in values.items()):
        return None
    return Candidate(point, "sample") if bool(((point >= 0.0) & (point <= 1.0)).all()) else None


def expansion_at(problem: Problem, design: Evaluated) -> Linearization | None:
    """Exact first-order expansion at a design; None where there is none."""
    if not problem.exact:
        return None
    try:
        return problem.linearize(design.point)
    except NotConverged:
        return None


@one_thread()
def posterior_at(problem: Problem, expansion: Linearization | None) -> Posterior | None:
    """What the data say of each variable; None without exact sensitivities."""
    if expansion is None:
        return None
    jacobian = problem.likelihood.jacobian(expansion.curves, expansion.characteristics)
    return posterior(jacobian, problem.space.prior_sd)


@one_thread()
def notes_on(problem: Problem, run: Run, at_best: Linearization | None) -> tuple[str, ...]:
    """Targets out of reach, constraints in conflict and levels too coarse, in sentences."""
    best, at_start = run.evaluated[run.best], expansion_at(problem, run.evaluated[0])
    if at_best is None or at_start is None:
        return ()
    return (
        *reach_sentences(problem, run.evaluated[0], at_start),
        *conflict_sentences(problem, best, at_best),
        *level_sentences(problem, best, at_best),
    )
