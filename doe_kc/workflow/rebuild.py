"""A finished correlation or run kept beside its results, read back, and written anew without solving."""

from __future__ import annotations

import json
from dataclasses import dataclass, replace
from pathlib import Path

from doe_kc.campaign.store import open_store
from doe_kc.correlation.answer_record import AnswerRecord
from doe_kc.correlation.assessment import Assessment, Objection, assess
from doe_kc.correlation.problem import Candidate
from doe_kc.correlation.record import (
    read_record,
    recalled,
    recalled_answers,
    recorded_space,
    run_document,
)
from doe_kc.correlation.result import Correlation
from doe_kc.correlation.twin_agreement import twin_agreement
from doe_kc.ground.errors import InputError
from doe_kc.ground.files import read_bytes
from doe_kc.ground.output import write_json
from doe_kc.ground.threads import one_thread
from doe_kc.measurement import Measurement
from doe_kc.study import Study
from doe_kc.targets.comparison import Comparison
from doe_kc.true_solver.make import solver_for
from doe_kc.workflow.adopt import adopted
from doe_kc.workflow.answer import Answer, answer_lines, write_answer
from doe_kc.workflow.compare import compare_model, write_comparison
from doe_kc.workflow.correlation_problem import given_outcome, sought_problem, study_problem
from doe_kc.workflow.measure import Reduced, study_records
from doe_kc.workflow.write_correlation import correlation_lines, write_correlation

RUN_FILE = "run.json"


@dataclass(frozen=True)
class Recalled:
    """A correlation that was read back, and its assessment. answer: of the chain that it was part of; None of
    one alone."""

    correlation: Correlation
    assessment: Assessment
    answer: AnswerRecord | None


def write_run(correlation: Correlation, folder: Path) -> Path:
    """run.json of a correlation alone: what `recall` needs beside the store."""
    return write_json(folder / RUN_FILE, run_document(correlation))


def write_chain(answer: Answer, record: AnswerRecord, folder: Path) -> Path:
    """run.json of a chain's correlation: that, and what else its answer is written from."""
    adoption = answer.adoption
    document = run_document(
        answer.correlation,
        discovered=adoption is not None,
        effects=() if adoption is None else adoption.records,
        without=() if adoption is None else adoption.without,
        objections=answer.further,
        misfit=None if answer.gap is None else answer.gap.final,
        answer=record,
    )
    return write_json(folder / RUN_FILE, document)


@one_thread()
def recall(study: Study, reduced: Reduced | None, folder: Path) -> Recalled:
    """The last correlation in `folder`, rated by the study's present targets and weights; nothing is run.

    InputError when there is none, its file is damaged, or the store is not that of its evaluations.
    """
    path = folder / RUN_FILE
    if not path.is_file():
        raise InputError(f"{path}: there is no correlation to report; run doe-kc correlate first.")
    try:
        document = json.loads(read_bytes(path, "record of a correlation"))
    except ValueError as error:
        raise InputError(f"{path}: is not valid JSON ({error}); run doe-kc correlate again.") from None
    if not isinstance(document, dict):
        raise InputError(f"{path}: is no record of a correlation; run doe-kc correlate again.")
    record = read_record(document, str(path))
    adoption = adopted(study, record.effects, record.without) if record.discovered else None
    axle = study.axle if adoption is None else adoption.axle
    space = recorded_space(record, axle)
    plain = study_problem(study, reduced, space=space, adoption=adoption)
    solver = solver_for(axle, study.solver, study.windows, study.folder)
    stored = study.store if axle is study.axle else study.extended_store(solver.fingerprint())
    with open_store(stored, solver) as store:
        answers = recalled_answers(record, plain, store, str(path))
    given = None if axle is study.axle else given_outcome(study)
    problem, relaxed = sought_problem(study, plain, answers[0][1], given)
    correlation = replace(recalled(record, problem, answers), relaxation=relaxed)
    run = correlation.run
    correlation = replace(correlation, twin=twin_agreement(problem, run.evaluated, run.evaluated[run.best]))
    if given is not None:
        correlation = replace(
            correlation, given=problem.judged(-1, Candidate(space.start, "given axle"), given)
        )
    same = correlation.run.best == record.best
    further = [Objection(o.sentence, o.fatal) for o in record.objections]
    assessment = assess(correlation, misfit=record.misfit if same else None, further=further)
    answer = record.answer
    if answer is not None and not same:  # the gap is that of the axle that was handed over then
        answer = answer.model_copy(update={"gap": None})
    return Recalled(correlation, assessment, answer)


@dataclass(frozen=True)
class Rebuilt:
    """recalled: correlation, its assessment with the study's present weights, and the record of its run.
    measurement: the rig records, None with typed targets only. comparison: of the correlated axle, None where
    the solver gave no curves or the correlation was no part of a run."""

    recalled: Recalled
    measurement: Measurement | None
    comparison: Comparison | None

    @property
    def is_run(self) -> bool:
        """Whether there is an answer to write at the top of the folder."""
        return self.recalled.answer is not None and self.measurement is not None

    @property
    def lines(self) -> list[str]:
        """For a terminal: the answer of a run, then the correlation; of a correlation alone that."""
        correlation, assessment = self.recalled.correlation, self.recalled.assessment
        lines = correlation_lines(correlation, assessment)
        record = self.recalled.answer
        return lines if record is None else [*answer_lines(assessment, record), *lines[1:]]


def rebuild(study: Study) -> Rebuilt:
    """What `study.out` holds of a correlation. InputError where there is none, or as `recall`."""
    reduced = study_records(study)
    recalled = recall(study, reduced, study.out / "correlate")
    measurement = None if reduced is None else reduced.measurement
    curves = recalled.correlation.best.outcome.curves
    comparison = None
    if recalled.answer is not None and measurement is not None and curves is not None:
        comparison = compare_model(study, curves, measurement)
    return Rebuilt(recalled, measurement, comparison)


def write_rebuilt(study: Study, rebuilt: Rebuilt, *, workers: int | None = None) -> list[Path]:
    """The files of `correlate`, and of a run also `compare` and the answer, in `study.out`; their paths.

    RunError when the folder cannot be written.
    """
    correlation, assessment = rebuilt.recalled.correlation, rebuilt.recalled.assessment
    record, measurement = rebuilt.recalled.answer, rebuilt.measurement
    folder = study.out / "correlate"
    written = write_correlation(
        study, correlation, measurement, folder, assessment=assessment, workers=workers
    )
    if rebuilt.comparison is not None:
        written += write_comparison(
            rebuilt.comparison, study.out / "compare", workers=workers, pictures=study.pictures
        )
    if record is not None and measurement is not None:
        written += write_answer(study, correlation, assessment, record, measurement)
    return written
