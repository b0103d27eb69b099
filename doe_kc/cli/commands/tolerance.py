"""`doe-kc tolerance`: production scatter of the parameters and what it does to the characteristics."""

from __future__ import annotations

from typing import Annotated

import typer

from doe_kc.cli._app import app
from doe_kc.cli.options import SchedulerOption, StudyOptions, takes_study
from doe_kc.cli.progress import progress_bar
from doe_kc.ground.output import write_json
from doe_kc.production_scatter.options import FEWEST_CARS, MOST_CARS
from doe_kc.workflow.tolerance import (
    study_tolerance,
    tolerance_document,
    tolerance_lines,
    tolerance_store,
    write_tolerance,
)


@app.command("tolerance")
@takes_study
def tolerance(
    study_options: StudyOptions,
    samples: Annotated[
        int | None,
        typer.Option(min=FEWEST_CARS, max=MOST_CARS, help="Cars to solve, in place of the study's."),
    ] = None,
    scheduler: SchedulerOption = None,
) -> None:
    """Production scatter by Monte Carlo: cars outside requirements, contributions, what to tighten."""
    study = study_options.read()
    cars = samples or study.tolerance.samples
    with progress_bar("tolerance", cars + 1) as advance:
        result = study_tolerance(
            study, samples=samples, workers=study_options.workers, scheduler=scheduler, progress=advance
        )
    if study_options.json is not None:
        write_json(study_options.json, tolerance_document(result))
    written = write_tolerance(study, result, study.out / "tolerance", workers=study_options.workers)
    for line in tolerance_lines(result):
        typer.echo(line)
    typer.echo(f"{len(written)} files in {study.out / 'tolerance'}; store {tolerance_store(study)}", err=True)
