"""`doe-kc influence`: the normalized parameter-influence matrix."""

from __future__ import annotations

import typer

from doe_kc.cli._app import app
from doe_kc.cli.options import StudyOptions, takes_study
from doe_kc.cli.progress import progress_bar
from doe_kc.ground.output import write_json
from doe_kc.measurement import Measurement
from doe_kc.study import Study
from doe_kc.workflow.influence import (
    StudyInfluence,
    influence_document,
    influence_lines,
    influence_runs,
    study_influence,
    write_influence,
)
from doe_kc.workflow.measure import study_measurement


@app.command("influence")
@takes_study
def influence(study_options: StudyOptions) -> None:
    """One-at-a-time study: normalized influence matrix (workbook, pictures), exact sensitivities beside."""
    study = study_options.read()
    measurement = None if study.measurement is None else study_measurement(study)
    result = influence_shown(study, measurement, workers=study_options.workers)
    if study_options.json is not None:
        write_json(study_options.json, influence_document(result.matrix))
    written = write_influence(study, result, study.out / "influence", workers=study_options.workers)
    for line in influence_lines(result.matrix):
        typer.echo(line)
    typer.echo(f"{len(written)} files in {study.out / 'influence'}", err=True)


def influence_shown(
    study: Study, measurement: Measurement | None, *, workers: int | None = None
) -> StudyInfluence:
    """The influence study, its progress shown."""
    with progress_bar("one at a time", influence_runs(study)) as advance:
        return study_influence(study, measurement, workers=workers, progress=advance)
