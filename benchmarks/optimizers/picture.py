"""Best so far against evaluations: median and range over the seeds."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from _common import RESULTS
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from optimizers.figures import best_so_far
from optimizers.running import PEERS, Result

from doe_kc.ground.typing import FloatArray
from doe_kc.reports.drawing.style import PALETTE

LOOKS = {
    "ego": ("black", "-"),
    "ego_values": ("grey", "-"),
    "gauss_newton": ("purple", "-"),
    "botorch_composite": ("vermillion", "-"),
    "dfols": ("blue", "-"),
    "hybrid": ("green", "-"),
    "pareto": ("green", "--"),
    "least_squares": ("blue", ":"),
    "cma": ("orange", "--"),
    "cobyqa": ("purple", "--"),
    "botorch_scalar": ("vermillion", "--"),
    "de": ("sky", "--"),
    "random": ("grey", "-."),
}
"""Whole lines see the outputs, broken ones the rating alone or are variants of the same colour."""


def draw(found: Sequence[Result]) -> Path:
    """results/optimizers.png."""
    figure = Figure(figsize=(9.5, 4.6), layout="constrained")
    FigureCanvasAgg(figure)
    left, right = figure.subplots(1, 2)
    for peer in PEERS:
        runs = [r for r in found if r.peer == peer.id]
        if runs and peer.id in LOOKS:
            _band(left, peer.label, peer.id, [best_so_far(r) for r in runs])
            _band(right, peer.label, peer.id, [-np.maximum.accumulate(r.rating) for r in runs])
    left.set(ylabel="deviation / deviation of the start", ylim=(2e-5, 1.3))
    right.set(ylabel="- rating", ylim=(0.1, 1500.0))
    for axes in (left, right):
        axes.set(xlabel="true-solver evaluations", yscale="log", xlim=(0, 300))
        axes.grid(alpha=0.3)
    figure.legend(*left.get_legend_handles_labels(), loc="outside lower center", ncols=5, fontsize=8)
    place = RESULTS / "optimizers.png"
    figure.savefig(place, dpi=130)
    return place


def _band(axes: Axes, label: str, name: str, curves: Sequence[FloatArray]) -> None:
    length = max(len(c) for c in curves)
    held = np.array([np.pad(c, (0, length - len(c)), mode="edge") for c in curves])
    colour, line = LOOKS[name]
    n = np.arange(1, length + 1)
    marker = "o" if length < 10 else ""  # a search that stops at once is seen
    axes.plot(n, np.median(held, axis=0), line + marker, ms=3, color=PALETTE[colour], lw=1.5, label=label)
    axes.fill_between(n, held.min(axis=0), held.max(axis=0), color=PALETTE[colour], alpha=0.12, lw=0)
