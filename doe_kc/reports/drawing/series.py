"""Draws a series of figures over all cores, those that the disk does not have already."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import BrokenExecutor
from contextlib import contextmanager
from pathlib import Path

from doe_kc.campaign.executors import processes
from doe_kc.campaign.processes import available_cores
from doe_kc.ground.errors import RunError
from doe_kc.ground.picture_format import PNG, PictureFormat
from doe_kc.reports.drawing import style
from doe_kc.reports.drawing.picture_digest import PictureDigests, shows

Job = tuple[Path, Callable[[], style.Picture]]
FEW = 3
"""Pictures that are drawn in this process: they take 0.1 s each, the start of the others as much."""


def draw_series(
    jobs: Sequence[Job], workers: int | None = None, *, pictures: PictureFormat = PNG
) -> list[Path]:
    """A picture of every (path without suffix, picklable maker); the paths in order, none with "none".

    A file that shows the same numbers already is left as it is. workers: processes for
    more than a few, default one per core. Raises RunError when one cannot be written.
    """
    with series_beside(jobs, workers, pictures=pictures) as paths:
        return paths


@contextmanager
def series_beside(
    jobs: Sequence[Job], workers: int | None = None, *, pictures: PictureFormat = PNG
) -> Iterator[list[Path]]:
    """As `draw_series`, while this process does something else; at its end all are drawn."""
    if pictures == "none":
        yield []
        return
    digests = PictureDigests()
    paths = [style.picture_path(path, pictures) for path, _ in jobs]
    marks = [digests.of(make) for _, make in jobs]
    missing = [
        (*job, pictures, mark or "")
        for job, path, mark in zip(jobs, paths, marks, strict=True)
        if mark is None or not shows(path, mark)
    ]
    count = 1 if len(missing) <= FEW else min(workers or available_cores(), len(missing))
    with processes(count) as executor:
        try:
            begun = [executor.submit(_draw, *job) for job in missing]
            yield paths
            for done in begun:
                done.result()
        except BrokenExecutor:
            raise RunError(
                "a process that drew pictures was ended from outside; use fewer --workers."
            ) from None


def _draw(path: Path, make: Callable[[], style.Picture], pictures: PictureFormat, mark: str) -> None:
    style.save(make(), path, pictures, mark=mark)
