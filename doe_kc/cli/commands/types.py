"""`doe-kc types`: the axle types that the package describes."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from doe_kc.axle_types import BUILT_IN, DEFAULT_TYPE, AxleType, read_axle_type
from doe_kc.axle_types.read import FOLDER
from doe_kc.cli._app import app
from doe_kc.cli.options import PictureChoice


@app.command("types")
def types(
    out: Annotated[
        Path | None, typer.Option(help="Folder for pictures: all types on one page, each from three sides.")
    ] = None,
    pictures: Annotated[
        PictureChoice, typer.Option(help="Format of the pictures that --out asks for.")
    ] = PictureChoice.PNG,
) -> None:
    """List the axle types: what each is made of, and the files that describe them."""
    for name in BUILT_IN:
        typer.echo(_line(name, read_axle_type(name, Path(), source=name)))
    typer.echo(f'Type files: {FOLDER}. A type of your own: type = "own.toml" in the axle file, beside it.')
    if out is not None:
        _draw(out, pictures)


def _line(name: str, axle_type: AxleType) -> str:
    s = axle_type.structure
    parts = [(len(s.bushings), "bushing"), (len(s.balls), "ball joint"), (len(s.rods), "rod")]
    counts = ", ".join(f"{n} {word}{'s' if n > 1 else ''}" for n, word in parts if n)
    rack = ", rack" if s.rack is not None else ""
    bodies = ", ".join(body.replace("_", " ") for body in (*s.single_bodies, *s.bodies))
    default = " (an axle file without type)" if name == DEFAULT_TYPE else ""
    return f"{name:24}{axle_type.label}{default}: {bodies}; {counts}{rack}"


def _draw(out: Path, pictures: PictureChoice) -> None:
    from doe_kc.axle_file import read_axle
    from doe_kc.examples import example_folder
    from doe_kc.ground.output import make_folder
    from doe_kc.reports.axle.type_figures import TypeExample, write_type_figures

    examples = []
    for name in BUILT_IN:
        label = read_axle_type(name, Path(), source=name).label
        examples.append(TypeExample(name, label, read_axle(example_folder(name) / "axle.toml")))
    written = write_type_figures(examples, make_folder(out), pictures=pictures.value)
    typer.echo(f"{len(written)} pictures in {out}")
