"""The correlation problem of a study: its variables, targets, data and reach, before any search."""

from __future__ import annotations

from dataclasses import replace

from doe_kc.axle.model import Axle
from doe_kc.correlation.least_squares import PRIOR_RIDGE, RIDGE_MEASURED
from doe_kc.correlation.likelihood import build_likelihood
from doe_kc.correlation.linearization import Linearization, linearize
from doe_kc.correlation.problem import Problem
from doe_kc.correlation.reach import Relaxation, answers_alike, relaxation
from doe_kc.correlation.search_targets import all_measured, misfit_term, relaxed_places, search_targets
from doe_kc.correlation.twin import Twin
from doe_kc.ground.errors import InputError, RunError
from doe_kc.ground.threads import one_thread
from doe_kc.measurement import Measurement
from doe_kc.parameter_influence.selection_result import Selection
from doe_kc.solver.result import NotConverged
from doe_kc.study import Study
from doe_kc.targets import build_targets, score
from doe_kc.true_solver.outcome import Outcome
from doe_kc.true_solver.own import AxleSolver
from doe_kc.variables import Space, build_space
from doe_kc.variables.build import Advice
from doe_kc.workflow.adopt import Adoption
from doe_kc.workflow.discover import discovery_space
from doe_kc.workflow.influence import study_influence
from doe_kc.workflow.measure import Reduced


def correlation_space(
    study: Study,
    reduced: Reduced | None,
    adoption: Adoption | None,
    selection: Selection | None = None,
    workers: int | None = None,
) -> Space:
    """The variables of a run: the study's, on the axle with the effects adopted.

    After a discovery a parameter that is an effect in other words stays as it is, unless the study names it:
    whether the car differs in it has been decided.
    """
    if adoption is None or study.variables.use == "selection":
        return study_space(study, reduced, selection, workers)
    return discovery_space(adoption.axle, study.variables, str(study.source))


def study_space(
    study: Study, reduced: Reduced | None, selection: Selection | None = None, workers: int | None = None
) -> Space:
    """The study's variables; for `use = "selection"` those that the influence study advises.

    selection: its advice; None makes the study. InputError when it is asked for without records.
    """
    if study.variables.use != "selection":
        return study.space
    measurement: Measurement | None = reduced.measurement if reduced is not None else None
    if measurement is None:
        raise InputError(
            f'{study.source}: variables: use = "selection" needs a measurement for the influence study to '
            'choose for; name one, or use = ["*"].'
        )
    advice = selection or study_influence(study, measurement, workers=workers).selection
    used = advice.variables if advice is not None else ()
    bounds = {v.parameter.path: (v.lower, v.upper) for v in used if v.used}
    return build_space(study.axle, study.variables, str(study.source), advice=Advice(bounds))


@one_thread()
def study_problem(
    study: Study,
    reduced: Reduced | None,
    *,
    space: Space | None = None,
    adoption: Adoption | None = None,
) -> Problem:
    """The correlation problem of a study, with its own variables or others; its search not yet prepared."""
    measurement = reduced.measurement if reduced is not None else None
    axle = answered_axle(study, study.axle if adoption is None else adoption.axle)
    targets = build_targets(
        axle,
        measurement,
        study.characteristics,
        study.curves,
        source=str(study.source),
        without=() if adoption is None else adoption.without,
    )
    only_targets = study.correlation.data == "targets"
    return Problem(
        axle=axle,
        space=space or study.space,
        targets=targets,
        likelihood=build_likelihood(axle, measurement, targets, only_targets=only_targets),
        windows=study.windows,
        exact=not study.solver.command,
        twin=None if study.twin is None else Twin(study.twin, study.windows),
    )


def answered_axle(study: Study, axle: Axle) -> Axle:
    """The axle with the load cases that the study's solver answers; all of them by default."""
    answered = study.solver.load_cases if study.solver.command else []
    if not answered:
        return axle
    return replace(axle, load_cases={k: c for k, c in axle.load_cases.items() if k in answered})


def given_outcome(study: Study) -> Outcome:
    """The study's axle as it is, by the package's own solver; RunError when it has no equilibrium."""
    outcome = AxleSolver(study.axle, study.windows).evaluate({})
    if outcome.failed:
        raise RunError(f"{study.axle_path}: the axle cannot be solved: {outcome.reason}")
    return outcome


def sought_problem(
    study: Study, problem: Problem, start: Outcome, reference: Outcome | None = None
) -> tuple[Problem, Relaxation | None]:
    """The problem with the targets of its search, and the targets out of reach (None: not known).

    start: answer to the design that the run starts from. reference: answer of the axle whose distances hold,
    where that is another one. Without sensitivities of the study's solver those of the twin serve, and say
    what is out of reach where it answers alike; without a twin those of the package's own, where it does.
    """
    curves = start.curves is not None
    wide = all_measured(problem.targets, curves=curves)
    before = reference or start
    baseline = score(wide, before.characteristics, before.curves)
    expansion = start_expansion(problem, start)
    sure = expansion is not None and (problem.twin is None or twin_alike(problem, start))
    relaxed = reach_of(problem, start, expansion) if expansion is not None and sure else None
    likelihood = problem.likelihood.without(relaxed_places(problem.targets, relaxed))
    sought = search_targets(
        problem.targets,
        baseline,
        objective=study.correlation.objective,
        relaxation=relaxed,
        misfit=None if expansion is None else misfit_term(likelihood, problem.space, start, expansion),
        curves=curves,
    )
    ridge = RIDGE_MEASURED if study.correlation.objective == "measured" else PRIOR_RIDGE
    return replace(problem, sought=sought, likelihood=likelihood, ridge=ridge), relaxed


def start_expansion(problem: Problem, start: Outcome) -> Linearization | None:
    """First-order expansion at the start; None where there is none. For an outside solver that of its twin,
    without one that of the package's own, if both say the same of the start."""
    space = problem.space
    try:
        if problem.has_slopes:
            return problem.linearize(space.start)
        own = AxleSolver(problem.axle, problem.windows).evaluate(space.values(space.start))
        if not answers_alike(problem.targets, own, start):
            return None
        return linearize(problem.axle, space, space.start, problem.windows)
    except NotConverged:
        return None


def twin_alike(problem: Problem, start: Outcome) -> bool:
    """Whether the twin says of the start what the outside solver says."""
    twin = problem.twin
    return twin is not None and answers_alike(
        problem.targets, twin.answer(problem.space, problem.space.start), start
    )


def reach_of(problem: Problem, start: Outcome, expansion: Linearization) -> Relaxation:
    """Targets that the bounds do not reach from the start, to first order."""
    space, rows = problem.space, problem.targets.rows
    return relaxation(
        problem.targets.characteristics,
        start.characteristics[rows],
        expansion.characteristics[rows],
        space.start,
        space.prior_sd,
        space.paths,
    )
