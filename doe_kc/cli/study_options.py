"""What every command that works on a whole study is told, declared once."""

from __future__ import annotations

import functools
import inspect
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Concatenate, ParamSpec

from doe_kc.cli.options import (
    JsonOption,
    MeasurementOption,
    OutOption,
    PicturesOption,
    SeedOption,
    StudyArgument,
    WorkersOption,
)
from doe_kc.study import Study, read_study

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
