"""Draws a series of figures over all cores: a sheet takes a second or two."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

from matplotlib.figure import Figure

from doe_kc.reporting import style
from doe_kc.sampling.batch import available_cores, start_context

Job = tuple[Path, Callable[[], Figure]]


def draw_series(jobs: Sequence[Job]) -> list[Path]:
    """PNG of every (path without suffix, picklable maker); returns the paths in order.

    Raises RunError when one cannot be written.
    """
    workers = min(available_cores(), len(jobs))
    if workers <= 1:
        return [_draw(job) for job in jobs]
    with ProcessPoolExecutor(workers, mp_context=start_context()) as pool:
        return list(pool.map(_draw, jobs))


def _draw(job: Job) -> Path:
    path, make = job
    return style.save_png(make(), path)
