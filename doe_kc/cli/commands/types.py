"""`doe-kc types`: the axle types that the package describes."""

from __future__ import annotations

from pathlib import Path

import typer

from doe_kc.axle_types import BUILT_IN, DEFAULT_TYPE, read_axle_type
from doe_kc.axle_types.read import FOLDER
from doe_kc.cli._app import app


@app.command("types")
def types() -> None:
    """List the axle types: what each is made of, and the files that describe them."""
    for name in BUILT_IN:
        axle_type = read_axle_type(name, Path(), source=name)
        s = axle_type.structure
        parts = [(len(s.bushings), "bushing"), (len(s.balls), "ball joint"), (len(s.rods), "rod")]
        counts = ", ".join(f"{n} {word}{'s' if n > 1 else ''}" for n, word in parts if n)
        rack = ", rack" if s.rack is not None else ""
        bodies = ", ".join(body.replace("_", " ") for body in (*s.single_bodies, *s.bodies))
        default = " (an axle file without type)" if name == DEFAULT_TYPE else ""
        typer.echo(f"{name:24}{axle_type.label}{default}: {bodies}; {counts}{rack}")
    typer.echo(f'Type files: {FOLDER}. A type of your own: type = "own.toml" in the axle file, beside it.')
