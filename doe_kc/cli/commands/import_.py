"""`doe-kc import`: an axle file from another program's files."""

from __future__ import annotations

from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

from doe_kc.adams.import_axle import AdamsSource
from doe_kc.cli._app import app
from doe_kc.ground.errors import InputError
from doe_kc.workflow.import_adams import import_lines, write_import


class ImportFormat(StrEnum):
    """Programs whose files are read."""

    ADAMS = "adams"


SetOption = Annotated[
    list[str] | None,
    typer.Option("--set", metavar="PATH=VALUE", help="What no file says, as tyre.static_load=4300."),
]
TypeOption = Annotated[str, typer.Option("--type", help="Axle type; told by the hardpoints when left out.")]
MapOption = Annotated[
    Path | None, typer.Option("--map", help="Name map (TOML), in place of the package's own.")
]


@app.command("import")
def import_(
    program: Annotated[ImportFormat, typer.Argument(metavar="FORMAT", help="adams.")],
    paths: Annotated[
        list[Path], typer.Argument(metavar="PATH...", help="Subsystems, an assembly, or a database's folder.")
    ],
    out: Annotated[Path, typer.Option(help="Folder for axle.toml and name_map.toml.")],
    axle_type: TypeOption = "",
    map: MapOption = None,
    settings: SetOption = None,
) -> None:
    """Make an axle file from ADAMS/Car subsystems, with their property files; say what was inferred."""
    del program
    source = AdamsSource(tuple(paths), axle_type, map, values_of(settings or []))
    result, files = write_import(source, out)
    for line in import_lines(result):
        typer.echo(line)
    for path in files:
        typer.echo(f"wrote {path}", err=True)


def values_of(settings: list[str]) -> tuple[tuple[str, float], ...]:
    """PATH=VALUE as pairs; InputError for anything else."""
    pairs = []
    for text in settings:
        path, equals, number = text.partition("=")
        try:
            pairs.append((path.strip(), float(number)))
        except ValueError:
            equals = ""
        if not equals or not path.strip():
            raise InputError(f"--set {text}: expected PATH=VALUE, as in tyre.static_load=4300.")
    return tuple(pairs)
