"""Draws a series of figures over all cores: a sheet takes a second or two."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from pathlib import Path

from matplotlib.figure import Figure

from doe_kc.campaign.processes import available_cores, start_context
from doe_kc.reporting import style

Job = tuple[Path, Callable[[], Figure]]


def draw_series(jobs: Sequence[Job], workers: int | None = None, *, vector: bool = False) -> list[Path]:
    """PNG, and SVG when `vector`, of every (path without suffix, picklable maker); the paths in order.

    workers: processes, default one per core. Raises RunError when one cannot be written.
    """
    count = min(workers or available_cores(), len(jobs))
    draw = partial(_draw, vector)
    if count <= 1:
        drawn = [draw(job) for job in jobs]
    else:
        with ProcessPoolExecutor(count, mp_context=start_context()) as pool:
            drawn = list(pool.map(draw, jobs))
    return [path for paths in drawn for path in paths]


def _draw(vector: bool, job: Job) -> tuple[Path, ...]:
    path, make = job
    return style.save(make(), path) if vector else (style.save_png(make(), path),)
