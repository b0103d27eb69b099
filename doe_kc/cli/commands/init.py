"""`doe-kc init`: the example study of an axle type, to edit."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from doe_kc.axle_types import DEFAULT_TYPE
from doe_kc.cli._app import app
from doe_kc.examples import copy_example
from doe_kc.study import read_study


@app.command("init")
def init(
    folder: Annotated[Path, typer.Argument(metavar="DIR", help="New or empty folder.")],
    axle_type: Annotated[
        str, typer.Option("--type", metavar="TYPE", help="Axle type; doe-kc types lists them.")
    ] = DEFAULT_TYPE,
) -> None:
    """Write the example study of an axle type (axle, rig records if it has any, study file) to edit."""
    files = copy_example(folder, axle_type)
    command = "run" if read_study(folder).measurement is not None else "influence"
    typer.echo(f"{len(files)} files in {folder}; next: doe-kc {command} {folder / 'study.toml'}")
