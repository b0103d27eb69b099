"""A finished correlation kept beside its results, and read back for new tables or other weights."""

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
from doe_kc.study import Study
from doe_kc.true_solver.make import solver_for
from doe_kc.workflow.adopt import adopted
from doe_kc.workflow.answer import Answer
from doe_kc.workflow.correlation_problem import given_outcome, sought_problem, study_problem
from doe_kc.workflow.measure import Reduced

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
