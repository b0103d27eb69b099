"""Correlate: from a study to the tuned axle, every true-solver evaluation into the store."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from functools import partial

from doe_kc.campaign.runner import Campaign
from doe_kc.correlation.loop import Evaluate, run_method
from doe_kc.correlation.methods import Method, MethodSettings, method_class
from doe_kc.correlation.problem import Candidate, Evaluated
from doe_kc.correlation.result import Correlation
from doe_kc.ground.errors import InputError, RunError
from doe_kc.ground.threads import one_thread
from doe_kc.parameter_influence.selection_result import Selection
from doe_kc.study import Study
from doe_kc.true_solver.make import solver_for
from doe_kc.workflow.adopt import Adoption
from doe_kc.workflow.correlation_diagnostics import expansion_at, notes_on, posterior_at
from doe_kc.workflow.correlation_problem import given_outcome, sought_problem, study_problem
from doe_kc.workflow.correlation_space import correlation_space
from doe_kc.workflow.known_designs import refit_proposal, sampled
from doe_kc.workflow.measure import Reduced
from doe_kc.workflow.set_first import set_first

Watch = Callable[[Sequence[Evaluated]], None]


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
        at_best = expansion_at(problem, run.evaluated[run.best])
    return Correlation(
        method=chosen.id,
        problem=problem,
        run=run,
        steps=(*steps, *(adoption.sentences if adoption is not None else ())),
        notes=notes_on(problem, run, at_best, relaxed),
        posterior=posterior_at(problem, at_best, run.evaluated[run.best]),
        seconds=time.perf_counter() - started,
        relaxation=relaxed,
        given=None if given is None else problem.judged(-1, Candidate(space.start, "given axle"), given),
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
