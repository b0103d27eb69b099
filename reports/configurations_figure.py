"""Best rating so far over the evaluations, median and band of the seeds of each configuration."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from axes import figure, label
from correlation_runs import Trace
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, LogLocator, MaxNLocator, NullFormatter, NullLocator
from report_figures import legend, title

from doe_kc.ground.typing import FloatArray
from doe_kc.reports.drawing.style import COLOUR_CYCLE, PALETTE

Runs = Mapping[str, Sequence[Trace]]
PLAIN = FuncFormatter(lambda v, _: f"{v:,.0f}" if v >= 100.0 else f"{v:.3g}")


def convergence_figure(runs: Runs, what: str, budget: int, standard: str) -> Figure:
    """Left: the whole search, right: its second half. standard: the one that is black in every figure."""
    fig, axes = figure(1, 2, size=(9.5, 3.7), share_x=False, width_ratios=(1.4, 1.0))
    left, right = axes[0]
    for ax in (left, right):
        colours = iter(COLOUR_CYCLE)
        for name, traces in runs.items():
            _curve(ax, name, traces, PALETTE["black"] if name == standard else next(colours), budget)
        ax.set_yscale("log")
        ax.yaxis.set_major_formatter(PLAIN)
        label(ax, "true-solver evaluation (1 = baseline) [-]", "minus best rating so far [-]")
    left.yaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    left.yaxis.set_minor_formatter(NullFormatter())
    seeds = max(len(t) for t in runs.values())
    title(left, f"Performance influence of {what}: median and range of {seeds} seeds")
    title(right, "the second half, enlarged")
    legend(left, "best")
    _zoom(right, [padded(t, budget)[:, budget // 2 :] for t in runs.values()], budget)
    return fig


def padded(traces: Sequence[Trace], length: int) -> FloatArray:
    """(runs, length) minus the best rating so far; a run that stopped early keeps its last."""
    return -np.array([t.best[:length] + [t.best[-1]] * (length - len(t.best)) for t in traces])


def _curve(ax: Axes, name: str, traces: Sequence[Trace], colour: str, budget: int) -> None:
    rows, x = padded(traces, budget), np.arange(1, budget + 1)
    early = max(len(t.best) for t in traces) < budget
    style = "--" if early and len(traces) == 1 else "-"
    ax.step(x, np.median(rows, axis=0), where="post", color=colour, label=name, lw=1.4, ls=style)
    ax.fill_between(x, rows.min(axis=0), rows.max(axis=0), step="post", color=colour, alpha=0.18, lw=0)


def _zoom(ax: Axes, tails: Sequence[FloatArray], budget: int) -> None:
    """Limits that hold every median which comes within a factor of four of the best one."""
    ends = [np.median(t, axis=0) for t in tails]
    best = min(float(e[-1]) for e in ends)
    low = min(float(t.min()) for t in tails)
    high = max(float(e.max()) for e in ends if e[-1] < 4.0 * best)
    ax.set_xlim(budget // 2, budget)
    ax.set_ylim(low / 1.05, min(high, 6.0 * best) * 1.05)
    ax.yaxis.set_minor_locator(NullLocator())
    bottom, top = ax.get_ylim()
    ticks = MaxNLocator(7, steps=[1, 2, 5, 10]).tick_values(bottom, top)
    ax.set_yticks([t for t in ticks if bottom < t < top])
    ax.set_ylim(bottom, top)
