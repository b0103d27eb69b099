"""`doe-kc surrogates`: fast models of every characteristic, cross-validated."""

from __future__ import annotations

import math
from typing import Annotated

import typer

from doe_kc.cli._app import app
from doe_kc.cli.progress import progress_bar
from doe_kc.cli.study_options import StudyOptions, takes_study
from doe_kc.ground.output import write_json
from doe_kc.measurement import reduce_measurement
from doe_kc.study import Study
from doe_kc.workflow.surrogate_plan import plan_surrogates
from doe_kc.workflow.surrogates import run_surrogates
from doe_kc.workflow.write_surrogates import surrogate_lines, surrogates_document, write_surrogates


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
    found = study_options.read()
    plan = plan_surrogates(found, [m.strip() for m in (models or "").split(",") if m.strip()])
    targets = _targets(found)
    with progress_bar("fit", plan.steps) as advance:
        report = run_surrogates(found, plan, targets=targets, workers=study_options.workers, progress=advance)
    if study_options.json is not None:
        write_json(study_options.json, surrogates_document(report))
    written = write_surrogates(found, report, found.out / "surrogates", workers=study_options.workers)
    for line in surrogate_lines(report):
        typer.echo(line)
    typer.echo(f"{len(written)} files in {found.out / 'surrogates'}", err=True)


def _targets(study: Study) -> dict[str, float]:
    """Measured values, which the figures show; none without a measurement."""
    if study.measurement is None:
        return {}
    measured = reduce_measurement(study.measurement, windows=study.windows, half_track=study.axle.half_track)
    values = {name: estimate.value for name, estimate in measured.characteristics.items()}
    return {name: value for name, value in values.items() if math.isfinite(value)}
