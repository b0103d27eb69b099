"""How often names were right over how sure the analyser was of them."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from benchmarks.discovery.statistics import Believed, Bin, reliability
from doe_kc.ground.typing import FloatArray

EDGES = (0.0, 0.5, 0.7, 0.8, 0.9, 0.95, 0.97, 0.98, 0.99, 1.0)
"""Narrow where most probabilities are."""
LEAST_DOUBT = 2e-3
"""Least 1 - probability on the axis: no more is ever stated."""
HONEST, SEEN = "#555555", "#0072B2"


def draw_reliability(believed: Believed, path: Path) -> None:
    """Share of right names in bins of their stated probability, with Wilson's interval of 95 % and the number
    of names; on the line they would be honest. The axis is stretched towards 1."""
    bins = reliability(believed, EDGES)
    figure = Figure(figsize=(6.4, 4.4), layout="constrained")
    FigureCanvasAgg(figure)
    axes = figure.subplots()
    line = np.linspace(0.0, 1.0 - LEAST_DOUBT, 400)
    axes.plot(_places(line), 100 * line, color=HONEST, lw=1.0, ls="--", label="honest")
    _draw_bins(axes, bins)
    ticks = (0.0, 0.5, 0.8, 0.9, 0.95, 0.98, 0.99, 0.995)
    axes.set_xticks(_places(np.array(ticks)), [f"{100 * p:g}" for p in ticks])
    axes.set(xlabel="stated probability of a name, %", ylabel="names that are right, %", ylim=(-3, 114))
    axes.set_title(f"{len(believed)} names: how sure, and how often right", loc="left")
    axes.grid(color="0.9", lw=0.6)
    figure.legend(loc="outside lower center", ncols=2, frameon=False)
    figure.savefig(path, dpi=150)


def _draw_bins(axes: Axes, bins: Sequence[Bin]) -> None:
    if not bins:
        return
    stated = _places(np.array([b.stated for b in bins]))
    right = np.array([b.right.value for b in bins])
    low, high = np.array([b.right.interval for b in bins]).T
    reach = 100 * np.array([right - low, high - right])
    axes.errorbar(
        stated,
        100 * right,
        yerr=reach,
        fmt="o",
        color=SEEN,
        capsize=3,
        label="benchmark: 95 % interval, number of names",
    )
    for x, y, b in zip(stated, high, bins, strict=True):
        axes.annotate(
            str(b.right.total), (x, 100 * y), (0, 7), textcoords="offset points", ha="center", fontsize=8
        )


def _places(probability: FloatArray) -> FloatArray:
    """Decades of doubt: 0 at 0 %, 1 at 90 %, 2 at 99 %."""
    return np.asarray(-np.log10(np.maximum(1.0 - probability, LEAST_DOUBT)))
