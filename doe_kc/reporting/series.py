"""Draws a series of figures over all cores: a sheet takes a second or two."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

from matplotlib.figure import Figure

from doe_kc.reporting import style
from doe_kc.sampling.batch import available_cores, start_context

Job = tuple[Path, Callable[[], Figure]]


def draw_series(jobs: Sequence[Job], workers: int | None = None) -> list[Path]:
    """PNG of every (path without suffix, picklable maker); returns the paths in order.

    workers: processes, default one per core. Raises RunError when one cannot be written.
    """
    count = min(workers or available_cores(), len(jobs))
    if count <= 1:
        return [_draw(job) for job in jobs]
    with ProcessPoolExecutor(count, mp_context=start_context()) as pool:
        return list(pool.map(_draw, jobs))


def _draw(job: Job) -> Path:
    path, make = job
    return style.save_png(make(), path)
