"""Options that several commands share."""

from __future__ import annotations

from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer


class PictureChoice(StrEnum):
    """`--pictures`."""

    PNG = "png"
    SVG = "svg"
    NONE = "none"


StudyArgument = Annotated[
    Path, typer.Argument(metavar="STUDY", help="Study file, or the folder that holds study.toml.")
]
MeasurementOption = Annotated[
    Path | None, typer.Option(help="Folder of test.toml and its records, in place of the study's.")
]
OutOption = Annotated[Path | None, typer.Option(help="Folder for all results, in place of the study's.")]
JsonOption = Annotated[Path | None, typer.Option("--json", help="Write the figures to this JSON file.")]
WorkersOption = Annotated[int | None, typer.Option(min=1, help="Worker processes; default one per core.")]
PicturesOption = Annotated[
    PictureChoice | None,
    typer.Option(help="Format of the pictures, in place of the study's; none: draw none."),
]
SeedOption = Annotated[int | None, typer.Option(min=0, help="Seed, in place of the study's.")]
SchedulerOption = Annotated[
    str | None, typer.Option(help="Address of a Dask scheduler, such as tcp://host:8786.")
]
