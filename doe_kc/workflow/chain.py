"""The whole chain of `run`: simulate, reduce, influence, discover, adopt, correlate, judge; one for command
line and Python API, which differ in how they show its progress."""

from __future__ import annotations

import logging
import time
from collections.abc import Callable
from dataclasses import dataclass, replace

from doe_kc.axle.plausibility import axle_warnings
from doe_kc.campaign.runner import Campaign
from doe_kc.correlation.answer_record import AnswerRecord
from doe_kc.correlation.reach import answers_alike
from doe_kc.correlation.result import Correlation
from doe_kc.discovery.result import Discovery
from doe_kc.ground.errors import RunError
from doe_kc.measurement import Measurement
from doe_kc.parameter_influence.selection_result import Selection
from doe_kc.solver.curve_set import curve_set
from doe_kc.solver.result import Solution
from doe_kc.solver.suite import solve
from doe_kc.study import Study
from doe_kc.targets.comparison import Comparison
from doe_kc.true_solver.make import solver_for
from doe_kc.true_solver.options import SolverOptions
from doe_kc.workflow.adopt import Adoption, adopt
from doe_kc.workflow.answer import Answer, answer_record, answered
from doe_kc.workflow.compare import compare_model
from doe_kc.workflow.correlation_problem import given_outcome, study_problem
from doe_kc.workflow.influence import StudyInfluence
from doe_kc.workflow.measure import Reduced, reduce_records
from doe_kc.workflow.run_files import RunFiles
from doe_kc.workflow.twin_discovery import DiscoveryGround, twin_ground

log = logging.getLogger("doe_kc")

Discover = Callable[[Study, Measurement], Discovery]
Correlate = Callable[[Study, Reduced, Adoption | None], Correlation]

DIFFERENT = (
    "What the model lacks was not looked for: the study's axle file does not describe the car of the outside "
    "model, whose characteristics differ."
)
TWIN_ADVICE = (
    "What the outside model lacks was looked for through its twin, what differs between the two taken off "
    "the records, as advice: the outside model was correlated as it is."
)
NO_TWIN = (
    "What the outside model lacks was not looked for: its twin does not change as it does, or one of them "
    "gave no curves."
)
ADVICE = (
    "What the model lacks was looked for on the package's own model of the study's axle file, as advice: the "
    "outside model was correlated as it is."
)


HANDED_OVER = "the design handed over"


@dataclass(frozen=True)
class Steps:
    """How each long step is done, so that a caller can show its progress. correlate: with the variables that
    the influence study selected. say: called with what a short step did or begins."""

    influence: Callable[[Study, Measurement], StudyInfluence]
    discover: Discover
    correlate: Callable[[Study, Reduced, Adoption | None, Selection | None], Correlation]
    say: Callable[[str], None] = lambda _: None


@dataclass(frozen=True)
class Chain:
    """All results of a run.

    solution, solving_seconds: the axle as handed in. comparison: the correlated axle beside the records.
    record: what is kept of the answer, with the time of the whole run.
    """

    solution: Solution
    solving_seconds: float
    reduced: Reduced
    influence: StudyInfluence
    answer: Answer
    comparison: Comparison
    record: AnswerRecord


def run_chain(study: Study, steps: Steps, files: RunFiles) -> Chain:
    """Every step of a run, its files written before the next one begins: an interruption loses the step that
    is under way, and of that only what the study's store does not hold.

    Raises InputError for a study without measurement or a record that is wrong, RunError when the axle cannot
    be solved or the files cannot be written.
    """
    started = time.perf_counter()
    study.measured()
    for sentence in axle_warnings(study.axle):
        log.warning(sentence)
    solution = solve(study.axle)
    solving_seconds = time.perf_counter() - started
    files.simulation(solution)
    steps.say(f"{study.axle.name}: {solution.equilibria} equilibria in {solving_seconds:.2f} s")

    reduced = reduce_records(study, solution)
    measurement = reduced.measurement
    if files.enabled:
        steps.say("drawing the rig records")
    files.reduction(reduced)

    influence = steps.influence(study, measurement)
    files.influence(influence)

    def discover(of: Study, records: Measurement) -> Discovery:
        discovery = steps.discover(of, records)
        files.discovery(discovery, DiscoveryGround(of, records))
        return discovery

    def correlate(of: Study, records: Reduced, adoption: Adoption | None) -> Correlation:
        return steps.correlate(of, records, adoption, influence.selection)

    answer = follow_chain(study, reduced, discover, correlate)
    files.correlation(answer, answer_record(answer, time.perf_counter() - started), measurement)
    model = answer.correlation.best.outcome.curves or curve_set(solution)
    comparison = compare_model(study, model, measurement)
    files.comparison(comparison)
    record = answer_record(answer, time.perf_counter() - started)
    files.answer(answer, record, measurement)
    return Chain(solution, solving_seconds, reduced, influence, answer, comparison, record)


def write_chain_files(chain: Chain, files: RunFiles) -> None:
    """What `run_chain` writes, of a chain that is finished."""
    measurement, answer = chain.reduced.measurement, chain.answer
    files.simulation(chain.solution)
    files.reduction(chain.reduced)
    files.influence(chain.influence)
    if answer.discovery is not None:
        files.discovery(answer.discovery, answer.ground or DiscoveryGround(files.study, measurement))
    files.correlation(answer, chain.record, measurement)
    files.comparison(chain.comparison)
    files.answer(answer, chain.record, measurement)


def follow_chain(study: Study, reduced: Reduced, discover: Discover, correlate: Correlate) -> Answer:
    """Discover, adopt, correlate the extended axle, and judge it. RunError when the axle cannot be solved."""
    measurement = reduced.measurement
    if study.solver.command:
        return _with_outside_solver(study, reduced, discover, correlate)
    discovery = discover(study, measurement)
    adoption = adopt(study, discovery)
    correlation = correlate(study, reduced, adoption)
    return answered(study, measurement, correlation, discovery, adoption)


def _with_outside_solver(study: Study, reduced: Reduced, discover: Discover, correlate: Correlate) -> Answer:
    """The outside model stays as it is, discovery is advice: through its twin, or without one where the
    package's own model says the same."""
    if study.twin is not None:
        return _with_twin(study, reduced, discover, correlate)
    discovery, remarks = None, (DIFFERENT,)
    if describes_the_same(study, reduced):
        own = replace(study, solver=SolverOptions())
        discovery, remarks = discover(own, reduced.measurement), (ADVICE,)
    correlation = correlate(study, reduced, None)
    return answered(study, reduced.measurement, correlation, discovery, None, remarks)


def _with_twin(study: Study, reduced: Reduced, discover: Discover, correlate: Correlate) -> Answer:
    """Correlate first: what differs between the outside model and its twin is best known where the car is."""
    correlation = correlate(study, reduced, None)
    best = correlation.best.outcome
    discovery, ground, remarks = None, None, (NO_TWIN,)
    if correlation.twin is not None and correlation.twin.usable and best.curves is not None:
        ground = twin_ground(study, reduced.measurement, best, correlation.values, HANDED_OVER)
        discovery, remarks = discover(ground.study, ground.records), (TWIN_ADVICE,)
    return answered(study, reduced.measurement, correlation, discovery, None, remarks, ground)


def describes_the_same(study: Study, reduced: Reduced) -> bool:
    """Whether the package's own model of the study's axle answers as the outside solver does."""
    problem = study_problem(study, reduced)
    solver = solver_for(study.axle, study.solver, study.windows, study.folder)
    with Campaign(solver, study.store) as campaign:
        (outside,) = campaign.evaluate([problem.space.values(problem.space.start)], "baseline")
    if outside.failed:
        raise RunError(f"the baseline axle cannot be solved: {outside.reason}")
    return answers_alike(problem.targets, given_outcome(study), outside)
