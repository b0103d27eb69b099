"""`doe-kc init`: the example study to edit."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from doe_kc.cli._app import app
from doe_kc.examples import copy_example


@app.command("init")
def init(folder: Annotated[Path, typer.Argument(metavar="DIR", help="New or empty folder.")]) -> None:
    """Write the example study (axle, rig records, study file) to edit."""
    files = copy_example(folder)
    typer.echo(f"{len(files)} files in {folder}; next: doe-kc run {folder / 'study.toml'}")
