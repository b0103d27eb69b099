"""`doe-kc export`: a tuned axle in another program's files, or as K&C tables of a vehicle model."""

from __future__ import annotations

from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

from doe_kc.adams.import_axle import AdamsSource
from doe_kc.axle_file import read_axle
from doe_kc.cli._app import app
from doe_kc.ground.errors import InputError
from doe_kc.workflow.import_adams import MAP_NAME


class ExportFormat(StrEnum):
    """What is written."""

    ADAMS = "adams"
    KC = "kc"


@app.command("export")
def export(
    form: Annotated[ExportFormat, typer.Argument(metavar="FORMAT", help="adams or kc.")],
    axle: Annotated[Path, typer.Argument(metavar="AXLE", help="Axle file (TOML).")],
    out: Annotated[Path, typer.Option(help="Folder for the files; empty or new for adams.")],
    original: Annotated[
        list[Path] | None,
        typer.Option(
            "--from", metavar="PATH", help="adams: what the axle was imported from; may be repeated."
        ),
    ] = None,
    map: Annotated[
        Path | None, typer.Option("--map", help="adams: name map; name_map.toml beside AXLE when left out.")
    ] = None,
) -> None:
    """Write a tuned axle back into its ADAMS/Car files, or its K&C tables for CarSim and CarMaker."""
    model = read_axle(axle)
    if form is ExportFormat.KC:
        if original or map is not None:
            raise InputError("export kc: --from and --map are for adams; leave them out.")
        from doe_kc.workflow.export_kc import export_kc

        for path in export_kc(model, out):
            typer.echo(f"wrote {path}", err=True)
        return
    if not original:
        raise InputError("export adams: name by --from PATH what the axle was imported from.")
    from doe_kc.workflow.export_adams import export_adams

    own = axle.parent / MAP_NAME
    names = map if map is not None else own if own.exists() else None
    source = AdamsSource(tuple(original), model.topology.structure.type, names)
    result = export_adams(model, source, out)
    for path, count in result.changed.items():
        typer.echo(f"{path}: {count} line{'s' if count > 1 else ''} changed")
    for path in result.added:
        typer.echo(f"{path}: new")
    if not result.changed:
        typer.echo("nothing differs from the original files")
    for sentence in result.unwritten:
        typer.echo(f"not written: {sentence}")
    typer.echo(f"{len(result.files)} files in {out}", err=True)
