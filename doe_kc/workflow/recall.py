"""A finished correlation kept beside its results, and read back for new tables or other weights."""

from __future__ import annotations

import json
from pathlib import Path

from doe_kc.campaign.store import open_store
from doe_kc.correlation.record import read_record, recalled, recorded_space, run_document
from doe_kc.correlation.result import Correlation
from doe_kc.errors import InputError
from doe_kc.files import read_bytes
from doe_kc.output import write_json
from doe_kc.study import Study
from doe_kc.threads import one_thread
from doe_kc.true_solver.make import solver_for
from doe_kc.workflow.correlate import study_problem
from doe_kc.workflow.measure import Reduced

RUN_FILE = "run.json"


def write_run(found: Correlation, folder: Path) -> Path:
    """run.json: what `recall` needs beside the store."""
    return write_json(folder / RUN_FILE, run_document(found))


@one_thread()
def recall(study: Study, reduced: Reduced | None, folder: Path) -> Correlation:
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
    problem = study_problem(study, reduced, space=recorded_space(record, study.axle))
    solver = solver_for(study.axle, study.solver, study.windows, study.folder)
    with open_store(study.store, solver) as store:
        return recalled(record, problem, store, str(path))
