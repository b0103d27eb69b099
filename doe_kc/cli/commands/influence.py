"""`doe-kc influence`: the normalized parameter-influence matrix."""

from __future__ import annotations

from dataclasses import replace
from typing import Annotated

import typer

from doe_kc.cli._app import app
from doe_kc.cli.options import SchedulerOption, StudyOptions, takes_study
from doe_kc.cli.progress import progress_bar
from doe_kc.ground.output import write_json
from doe_kc.measurement import Measurement
from doe_kc.parameter_influence.global_sensitivity import global_runs
from doe_kc.reports.influence.global_words import global_sentences
from doe_kc.study import Study
from doe_kc.workflow.influence import (
    StudyInfluence,
    influence_document,
    influence_lines,
    influence_runs,
    study_global,
    study_influence,
    study_methods,
    write_influence,
)
from doe_kc.workflow.measure import study_measurement


@app.command("influence")
@takes_study
def influence(
    study_options: StudyOptions,
    methods: Annotated[
        str | None,
        typer.Option(
            "--global", help="Also global sensitivities over the ranges: morris, sobol, pawn, with commas."
        ),
    ] = None,
    scheduler: SchedulerOption = None,
) -> None:
    """One-at-a-time study: normalized influence matrix (workbook, pictures), exact sensitivities beside."""
    study = study_options.read()
    asked = None if methods is None else [m.strip() for m in methods.split(",") if m.strip()]
    chosen = study_methods(study, asked)
    measurement = None if study.measurement is None else study_measurement(study)
    result = influence_shown(study, measurement, workers=study_options.workers)
    if chosen:
        with progress_bar("global", global_runs(chosen, study.space.dimension)) as advance:
            overall = study_global(
                study, chosen, workers=study_options.workers, scheduler=scheduler, progress=advance
            )
        result = replace(result, overall=overall)
    if study_options.json is not None:
        write_json(study_options.json, influence_document(result.matrix, result.overall))
    written = write_influence(study, result, study.out / "influence", workers=study_options.workers)
    for line in influence_lines(result.matrix):
        typer.echo(line)
    for line in [] if result.overall is None else global_sentences(result.overall):
        typer.echo(line)
    typer.echo(f"{len(written)} files in {study.out / 'influence'}", err=True)


def influence_shown(
    study: Study, measurement: Measurement | None, *, workers: int | None = None
) -> StudyInfluence:
    """The influence study, its progress shown."""
    with progress_bar("one at a time", influence_runs(study)) as advance:
        return study_influence(study, measurement, workers=workers, progress=advance)
