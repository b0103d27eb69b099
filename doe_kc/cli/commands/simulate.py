"""`doe-kc simulate`: K&C curves and characteristics of a model."""

from __future__ import annotations

import logging
import time
from pathlib import Path
from typing import Annotated

import typer

from doe_kc.axle.model import Axle
from doe_kc.axle.plausibility import axle_warnings
from doe_kc.axle.roll import with_roll
from doe_kc.axle_file import read_axle
from doe_kc.cli._app import app
from doe_kc.cli.changes import apply_effects, apply_settings
from doe_kc.cli.options import JsonOption, PictureChoice
from doe_kc.ground.errors import InputError, nearest
from doe_kc.ground.output import write_json
from doe_kc.ground.picture_format import PictureFormat
from doe_kc.report.simulation_tables import characteristics_document, write_simulation
from doe_kc.solver.result import Solution
from doe_kc.solver.suite import solve

log = logging.getLogger("doe_kc")


@app.command("simulate")
def simulate(
    axle: Annotated[Path, typer.Argument(metavar="AXLE", help="Axle file (TOML).")],
    settings: Annotated[
        list[str] | None,
        typer.Option("--set", metavar="PATH=VALUE", help="PATH=VALUE, PATH+=DELTA or PATH*=FACTOR."),
    ] = None,
    effects: Annotated[
        list[str] | None,
        typer.Option("--effect", metavar="ID:key=value,...", help="Add an optional effect."),
    ] = None,
    case: Annotated[list[str] | None, typer.Option(help="Load case; all by default.")] = None,
    roll: Annotated[str | None, typer.Option(help="Roll technique: body or counter_phase.")] = None,
    out: Annotated[
        Path | None, typer.Option(help="Folder for curves.csv, characteristics.csv and pictures.")
    ] = None,
    pictures: Annotated[
        PictureChoice, typer.Option(help="Format in which the deformed shapes are drawn, into --out.")
    ] = PictureChoice.NONE,
    json: JsonOption = None,
) -> None:
    """Solve the K&C load cases of an axle: curves (tidy CSV) and characteristics."""
    model = apply_settings(apply_effects(read_axle(axle), effects or []), settings or [])
    model = with_roll(model, roll, source="--roll")
    if pictures is not PictureChoice.NONE and out is None:
        raise InputError("--pictures: needs a folder to draw into; add --out DIR.")
    for sentence in axle_warnings(model):
        log.warning(sentence)
    started = time.perf_counter()
    solution = solve(model, checked_cases(model, case))
    seconds = time.perf_counter() - started
    document = characteristics_document(solution, seconds)
    if json is not None:
        write_json(json, document)
    if out is not None:
        for path in (*write_simulation(solution, out), *_shapes(model, solution, out, pictures.value)):
            typer.echo(f"wrote {path}", err=True)
    for name, entry in document["characteristics"].items():
        typer.echo(f"{name:36}{entry['value']:>14.6g}  {entry['unit']}")


def _shapes(axle: Axle, solution: Solution, folder: Path, pictures: PictureFormat) -> list[Path]:
    if pictures == "none":
        return []
    from doe_kc.report.axle_shapes import write_shape_figures

    return write_shape_figures(axle, solution, folder, pictures=pictures)


def checked_cases(axle: Axle, cases: list[str] | None) -> list[str] | None:
    """The load cases asked for; InputError for an unknown one."""
    for name in cases or []:
        if name not in axle.load_cases:
            raise InputError(
                f"--case {name}: is not a load case; known are {', '.join(axle.load_cases)}."
                f"{nearest(name, axle.load_cases)}"
            )
    return cases or None
