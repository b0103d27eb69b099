"""Options that several commands share, and those of every command that works on a whole study."""

from __future__ import annotations

import functools
import inspect
from collections.abc import Callable
from dataclasses import dataclass
from enum import StrEnum
from pathlib import Path
from typing import Annotated, Any, Concatenate, ParamSpec

import typer

from doe_kc.study import Study, read_study


class PictureChoice(StrEnum):
    """`--pictures`."""

    PNG = "png"
    SVG = "svg"
    NONE = "none"


StudyArgument = Annotated[
    Path, typer.Argument(metavar="STUDY", help="Study file, or the folder that holds study.toml.")
]
MeasurementOption = Annotated[
    list[Path] | None,
    typer.Option(help="Folder of test.toml and its records, in place of the study's; again for each car."),
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


P = ParamSpec("P")


@dataclass(frozen=True)
class StudyOptions:
    """measurement, out, seed, pictures: in place of the study's own. json: file for the figures."""

    study: StudyArgument
    measurement: MeasurementOption = None
    out: OutOption = None
    json: JsonOption = None
    seed: SeedOption = None
    workers: WorkersOption = None
    pictures: PicturesOption = None

    def read(self) -> Study:
        """The study; InputError as `read_study`."""
        return read_study(
            self.study,
            measurement=self.measurement,
            out=self.out,
            seed=self.seed,
            pictures=self.pictures.value if self.pictures is not None else None,
        )


def takes_study(command: Callable[Concatenate[StudyOptions, P], None]) -> Callable[..., None]:
    """The command with the fields of `StudyOptions`, its first argument, beside its own options."""
    first, *common = _parameters(StudyOptions)
    own = _parameters(command)[1:]

    @functools.wraps(command)
    def told(**options: Any) -> None:
        given = StudyOptions(**{p.name: options.pop(p.name) for p in (first, *common)})
        command(given, **options)  # type: ignore[call-arg]

    # Typer reads signature and annotations, of what it is given as of what that wraps.
    shown = [p.replace(kind=inspect.Parameter.KEYWORD_ONLY) for p in (first, *own, *common)]
    told.__signature__ = inspect.Signature(shown)  # type: ignore[attr-defined]
    told.__annotations__ = {p.name: p.annotation for p in shown}
    del told.__wrapped__
    return told


def _parameters(of: Callable[..., Any]) -> list[inspect.Parameter]:
    return list(inspect.signature(of, eval_str=True).parameters.values())
