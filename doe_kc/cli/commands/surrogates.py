"""`doe-kc surrogates`: fast models of every characteristic, cross-validated."""

from __future__ import annotations

from typing import Annotated

import typer

from doe_kc.cli._app import app
from doe_kc.cli.options import StudyOptions, takes_study
from doe_kc.cli.progress import progress_bar
from doe_kc.ground.output import write_json
from doe_kc.workflow.surrogates import (
    measured_values,
    plan_surrogates,
    run_surrogates,
    surrogate_lines,
    surrogates_document,
    write_surrogates,
)


@app.command("surrogates")
@takes_study
def surrogates(
    study_options: StudyOptions,
    models: Annotated[
        str | None,
        typer.Option(help="Models to choose from, with commas: linear,rbf,gp,gp_ard,gp_slopes,quadratic,..."),
    ] = None,
) -> None:
    """Fit fast models of every characteristic to the stored designs, cross-validate and choose."""
    study = study_options.read()
    plan = plan_surrogates(study, [m.strip() for m in (models or "").split(",") if m.strip()])
    targets = measured_values(study)
    with progress_bar("fit", plan.steps) as advance:
        report = run_surrogates(study, plan, targets=targets, workers=study_options.workers, progress=advance)
    if study_options.json is not None:
        write_json(study_options.json, surrogates_document(report))
    written = write_surrogates(study, report, study.out / "surrogates", workers=study_options.workers)
    for line in surrogate_lines(report):
        typer.echo(line)
    typer.echo(f"{len(written)} files in {study.out / 'surrogates'}", err=True)
