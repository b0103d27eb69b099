"""The whole chain: influence, discover, adopt, correlate what was extended, judge the answer."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

from doe_kc.campaign.runner import Campaign
from doe_kc.correlation.reach import answers_alike
from doe_kc.correlation.result import Correlation
from doe_kc.discovery.result import Discovery
from doe_kc.ground.errors import RunError
from doe_kc.measurement import Measurement
from doe_kc.study import Study
from doe_kc.true_solver.make import solver_for
from doe_kc.true_solver.options import SolverOptions
from doe_kc.workflow.adopt import Adoption, adopt
from doe_kc.workflow.answer import Answer, answered
from doe_kc.workflow.correlation_problem import given_outcome, study_problem
from doe_kc.workflow.measure import Reduced

Discover = Callable[[Study, Measurement], Discovery]
Correlate = Callable[[Study, Reduced, Adoption | None], Correlation]

DIFFERENT = (
    "What the model lacks was not looked for: the study's axle file does not describe the car of the outside "
    "model, whose characteristics differ."
)
ADVICE = (
    "What the model lacks was looked for on the package's own model of the study's axle file, as advice: the "
    "outside model was correlated as it is."
)


@dataclass(frozen=True)
class Steps:
    """How each step is done, so that a caller can show its progress."""

    discover: Discover
    correlate: Correlate


def follow_chain(study: Study, reduced: Reduced, steps: Steps) -> Answer:
    """Discover, adopt, correlate the extended axle, and judge it. RunError when the axle cannot be solved."""
    measurement = reduced.measurement
    if study.solver.command:
        return _with_outside_solver(study, reduced, steps)
    discovery = steps.discover(study, measurement)
    adoption = adopt(study, discovery)
    correlation = steps.correlate(study, reduced, adoption)
    return answered(study, measurement, correlation, discovery, adoption)


def _with_outside_solver(study: Study, reduced: Reduced, steps: Steps) -> Answer:
    """The outside model stays as it is; where the package's own says the same, discovery is advice."""
    discovery, remarks = None, (DIFFERENT,)
    if describes_the_same(study, reduced):
        own = replace(study, solver=SolverOptions())
        discovery, remarks = steps.discover(own, reduced.measurement), (ADVICE,)
    correlation = steps.correlate(study, reduced, None)
    return answered(study, reduced.measurement, correlation, discovery, None, remarks)


def describes_the_same(study: Study, reduced: Reduced) -> bool:
    """Whether the package's own model of the study's axle answers as the outside solver does."""
    problem = study_problem(study, reduced)
    solver = solver_for(study.axle, study.solver, study.windows, study.folder)
    with Campaign(solver, study.store) as campaign:
        (outside,) = campaign.evaluate([problem.space.values(problem.space.start)], "baseline")
    if outside.failed:
        raise RunError(f"the baseline axle cannot be solved: {outside.reason}")
    return answers_alike(problem.targets, given_outcome(study), outside)
