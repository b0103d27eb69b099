"""The study: read, and where its evaluations are kept while a function computes."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from os import PathLike
from pathlib import Path
from tempfile import TemporaryDirectory

from doe_kc import study as study_file
from doe_kc.axle_types import DEFAULT_TYPE
from doe_kc.examples import copy_example
from doe_kc.ground.picture_format import PictureFormat
from doe_kc.study import Study

Progress = Callable[[str, int, int], None]
"""Told what is under way, how many steps are done, and of how many (about, where nobody knows before)."""


def read_study(
    path: str | PathLike[str],
    *,
    measurement: str | PathLike[str] | Sequence[str | PathLike[str]] | None = None,
    out: str | PathLike[str] | None = None,
    seed: int | None = None,
    pictures: PictureFormat | None = None,
) -> Study:
    """The study of a file, or of a folder that holds `study.toml`; see docs/study.md.

    measurement (folder of one car, or of each of several), out, seed, pictures ("png", "svg" or "none"): in
    place of the study's own.

    Raises InputError naming file and key for anything wrong.

    >>> study = kc.read_study("examples/front_axle", seed=2)
    >>> study.axle.name, study.seed
    ('Front axle, McPherson', 2)
    """
    return study_file.read_study(
        Path(path),
        measurement=_folders(measurement),
        out=None if out is None else Path(out),
        seed=seed,
        pictures=pictures,
    )


def _folders(
    measurement: str | PathLike[str] | Sequence[str | PathLike[str]] | None,
) -> tuple[Path, ...] | None:
    if measurement is None:
        return None
    several = isinstance(measurement, Sequence) and not isinstance(measurement, str)
    return tuple(map(Path, measurement)) if several else (Path(measurement),)  # type: ignore[arg-type]


def init(folder: str | PathLike[str], axle_type: str = DEFAULT_TYPE) -> Study:
    """Write the example study of an axle type (axle, rig records if it has any, study file), and read it.

    folder: new or empty. axle_type: of `kc.types()`.

    Raises InputError for a folder that holds something or an unknown type, RunError where it cannot be
    written.

    >>> study = kc.init("my_study")
    >>> study.axle, study.source.name
    (Axle('Front axle, McPherson', effects: none), 'study.toml')
    """
    copy_example(Path(folder), axle_type)
    return read_study(folder)


def as_study(study: Study | str | PathLike[str]) -> Study:
    """A study, read where a path stands for it."""
    return study if isinstance(study, Study) else read_study(study)


@contextmanager
def stored(study: Study, out: str | PathLike[str] | None) -> Iterator[Study]:
    """The study with its store in `out`; without one in a folder that is removed at the end.

    Evaluations of an outside solver cost hours: without `out` they go to the study's own store.
    """
    if out is not None:
        yield replace(study, out=Path(out))
    elif study.solver.command:
        yield study
    else:
        with TemporaryDirectory(prefix="doe_kc_") as folder:
            yield replace(study, out=Path(folder))


def step_counter(progress: Progress | None, what: str, total: int) -> Callable[[int], None]:
    """A function that is told how many steps more are done."""
    done = 0

    def advance(steps: int) -> None:
        nonlocal done
        done += steps
        if progress is not None:
            progress(what, done, total)

    return advance
