"""`doe-kc check`: everything that a study names, nothing run."""

from __future__ import annotations

import typer

from doe_kc.cli._app import app
from doe_kc.cli.options import JsonOption, MeasurementOption, OutOption, StudyArgument
from doe_kc.ground.errors import InputError
from doe_kc.ground.output import write_json
from doe_kc.workflow.check import StudyCheck, check_study


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


def check_lines(checked: StudyCheck) -> list[str]:
    """What the study names; nothing of one that cannot be read."""
    study, manifest = checked.study, checked.manifest
    if study is None:
        return []
    if manifest is not None:
        count = sum(len(files) for files in manifest.records.values())
        records = f"{manifest.name}: {count} records, {len(manifest.records)} load cases"
    else:
        records = "none named" if study.measurement is None else f"{study.measurement}: cannot be read"
    return [
        f"study        {study.name} ({study.source})",
        f"axle         {study.axle.name} ({study.axle_path})",
        f"load cases   {', '.join(study.axle.load_cases)}",
        f"effects      {', '.join(study.axle.effects) or 'none'}",
        f"parameters   {len(study.parameters)} selected",
        f"variables    {study.space.dimension}, method {study.correlation.method}",
        f"measurement  {records}",
        f"results      {study.out}",
    ]
