"""`doe-kc check`: everything that a study names, nothing run."""

from __future__ import annotations

import typer

from doe_kc.cli._app import app
from doe_kc.cli.options import MeasurementOption, OutOption, StudyArgument
from doe_kc.correlation.methods import check_method
from doe_kc.study import read_study
from doe_kc.workflow.measure import check_measurement


@app.command("check")
def check(study: StudyArgument, measurement: MeasurementOption = None, out: OutOption = None) -> None:
    """Validate the study, its axle and its rig records; run nothing."""
    found = read_study(study, measurement=measurement, out=out)
    axle = found.axle
    typer.echo(f"study        {found.name} ({found.source})")
    typer.echo(f"axle         {axle.name} ({found.axle_path})")
    typer.echo(f"load cases   {', '.join(axle.load_cases)}")
    typer.echo(f"effects      {', '.join(axle.effects) or 'none'}")
    typer.echo(f"parameters   {len(found.parameters)} selected")
    typer.echo(f"variables    {found.space.dimension}, method {found.correlation.method}")
    check_method(found.correlation.method, source=f"{found.source}: correlation.method")
    if found.measurement is None:
        typer.echo("measurement  none named")
    else:
        manifest, count = check_measurement(found.measurement)
        typer.echo(f"measurement  {manifest.name}: {count} records, {len(manifest.records)} load cases")
    typer.echo(f"results      {found.out}")
    typer.echo("all sound")
