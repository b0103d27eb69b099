"""What is said of a correlation's best design: certainty of its parameters, conflicts, reach and levels."""

from __future__ import annotations

from doe_kc.correlation.advice import conflict_sentences, level_sentences, reach_sentences
from doe_kc.correlation.linearization import Linearization
from doe_kc.correlation.loop import Run
from doe_kc.correlation.posterior import ParameterPosterior, posterior
from doe_kc.correlation.problem import Evaluated, Problem
from doe_kc.correlation.reach import Relaxation
from doe_kc.ground.threads import one_thread
from doe_kc.solver.result import NotConverged


def expansion_at(problem: Problem, design: Evaluated) -> Linearization | None:
    """Exact first-order expansion at a design; None where there is none."""
    if not problem.exact:
        return None
    try:
        return problem.linearize(design.point)
    except NotConverged:
        return None


@one_thread()
def posterior_at(
    problem: Problem, expansion: Linearization | None, best: Evaluated
) -> ParameterPosterior | None:
    """What the data say of each variable; None without exact sensitivities."""
    if expansion is None or best.outcome.failed or not problem.likelihood.size:
        return None
    jacobian = problem.likelihood.jacobian(expansion.curves, expansion.characteristics)
    residual = problem.likelihood.residual(best.outcome.curves, best.outcome.characteristics)
    return posterior(jacobian, problem.space.prior_sd, residual=residual, point=best.point)


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
