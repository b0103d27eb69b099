"""`doe-kc identify`: the axle that has an influence matrix."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from doe_kc.axle_file import read_axle
from doe_kc.cli._app import app
from doe_kc.cli.options import JsonOption, PictureChoice, WorkersOption
from doe_kc.cli.progress import described_bar
from doe_kc.ground.errors import InputError
from doe_kc.ground.output import write_json
from doe_kc.identification.identification import CELL_NOISE, IDENTIFICATION_STARTS, USUAL_STEPS
from doe_kc.workflow.identify import (
    IdentifyOptions,
    identification_document,
    identification_lines,
    identify_axle,
    read_matrix,
    write_identification,
)


def free_parameters(texts: list[str]) -> dict[str, float | None] | None:
    """PATH, GLOB or GLOB=SD to globs and their prior standard deviations; None without any."""
    out: dict[str, float | None] = {}
    for text in texts:
        glob, equals, number = text.partition("=")
        try:
            out[glob.strip()] = float(number) if equals else None
        except ValueError:
            raise InputError(
                f"--free {text}: {number!r} is not a number; expected GLOB or GLOB=SD, as in LLF.*=5."
            ) from None
    return out or None


def masked_cells(texts: list[str]) -> list[tuple[str, str]]:
    """PARAMETER:CHARACTERISTIC, globs both."""
    out = []
    for text in texts:
        row, colon, column = text.partition(":")
        if not (row.strip() and colon and column.strip()):
            raise InputError(
                f"--mask {text}: expected PARAMETER:CHARACTERISTIC, as in upb.Tz:* or *:drive.*."
            )
        out.append((row.strip(), column.strip()))
    return out


@app.command("identify")
def identify(
    matrix: Annotated[
        Path,
        typer.Argument(
            metavar="MATRIX",
            help="CSV or Excel: a row a parameter, its path first; a column a characteristic.",
        ),
    ],
    axle: Annotated[
        Path, typer.Argument(metavar="AXLE", help="Axle file of the same layout, to start from.")
    ],
    free: Annotated[
        list[str] | None,
        typer.Option(help="GLOB, or GLOB=SD in mm or as a ratio; default all hardpoints and bushings."),
    ] = None,
    mask: Annotated[
        list[str] | None, typer.Option(help="PARAMETER:CHARACTERISTIC, globs both: cells left out.")
    ] = None,
    starts: Annotated[int, typer.Option(min=1, help="Fits from as many starts.")] = IDENTIFICATION_STARTS,
    seed: Annotated[int, typer.Option(min=0, help="Seed of the starts.")] = 0,
    noise: Annotated[
        float, typer.Option(help="Standard deviation of a cell, share of its column's length.")
    ] = CELL_NOISE,
    own_signs: Annotated[
        bool, typer.Option("--own-signs", help="The columns have the signs of docs/conventions.md.")
    ] = False,
    wheel_radius_held: Annotated[
        bool,
        typer.Option("--wheel-radius-held", help="WLC.z moves the contact point along, as in ADAMS/Car."),
    ] = False,
    out: Annotated[Path | None, typer.Option(help="Folder for axle, tables and picture.")] = None,
    json: JsonOption = None,
    pictures: Annotated[PictureChoice, typer.Option(help="Format of the picture.")] = PictureChoice.PNG,
    workers: WorkersOption = None,
) -> None:
    """Find the axle that has an influence matrix, such as a supplier's."""
    options = IdentifyOptions(starts, seed, noise, not own_signs, wheel_radius_held)
    wanted, cells = free_parameters(free or []), masked_cells(mask or [])
    frame, model = read_matrix(matrix), read_axle(axle)
    with described_bar("identifying", starts * USUAL_STEPS) as watch:
        result = identify_axle(
            frame, model, wanted, cells, options, source=str(matrix), workers=workers, watch=watch
        )
    if json is not None:
        write_json(json, identification_document(result))
    if out is not None:
        for path in write_identification(result, out, axle_path=axle, pictures=pictures.value):
            typer.echo(f"wrote {path}", err=True)
    for line in identification_lines(result):
        typer.echo(line)
