"""`doe-kc check`: everything that a study names, nothing run."""

from __future__ import annotations

import typer

from doe_kc.cli._app import app
from doe_kc.cli.options import JsonOption, MeasurementOption, OutOption, StudyArgument
from doe_kc.ground.errors import InputError
from doe_kc.ground.output import write_json
from doe_kc.workflow.check import check_lines, check_study


@app.command("check")
def check(
    study: StudyArgument,
    measurement: MeasurementOption = None,
    out: OutOption = None,
    json: JsonOption = None,
) -> None:
    """Find what any command would refuse of the study, its axle and its rig records; run nothing."""
    checked = check_study(study, measurement=measurement, out=out)
    if json is not None:
        write_json(json, checked.document)
    for line in check_lines(checked):
        typer.echo(line)
    for fault in checked.warnings:
        typer.echo(f"warning: {fault.message}", err=True)
    for fault in checked.errors:
        typer.echo(f"doe-kc: {fault.message}", err=True)
    if checked.errors:
        raise typer.Exit(InputError.exit_code)
    typer.echo("all sound")
