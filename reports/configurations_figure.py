"""Best rating so far over the evaluations, median and band of the seeds of each configuration."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from correlation_runs import Trace
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, NullLocator
from report_figures import legend, title

from doe_kc.reporting.style import CYCLE, figure, label
from doe_kc.typing import FloatArray

TICKS = (0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 1000.0, 10000.0)


def convergence_figure(runs: Mapping[str, Sequence[Trace]], what: str) -> Figure:
    """Left: the whole search, right: its second half, where the scale shows who ends best."""
    fig, axes = figure(1, 2, size=(9.5, 3.7), share_x=False, width_ratios=(1.4, 1.0))
    for ax in axes[0]:
        for k, (name, traces) in enumerate(runs.items()):
            _curve(ax, name, traces, CYCLE[k])
        ax.set_yscale("log")
        label(ax, "true-solver evaluation (1 = baseline) [-]", "minus best rating so far [-]")
    title(axes[0, 0], f"Performance influence of {what}: median and range of {_most(runs)} seeds")
    legend(axes[0, 0], "upper right")
    _zoom(axes[0, 1], runs)
    return fig


def _most(runs: Mapping[str, Sequence[Trace]]) -> int:
    return max(len(t) for t in runs.values())


def padded(traces: Sequence[Trace], length: int) -> FloatArray:
    """(runs, length) best rating so far; a run that stopped early keeps its last."""
    return np.array([t.best[:length] + [t.best[-1]] * (length - len(t.best)) for t in traces])


def _curve(ax: Axes, name: str, traces: Sequence[Trace], colour: str) -> None:
    length = max(len(t.best) for t in traces)
    rows, x = -padded(traces, length), np.arange(1, length + 1)
    dashed = "--" if len(traces) == 1 and length < 40 else "-"
    ax.step(x, np.median(rows, axis=0), where="post", color=colour, label=name, lw=1.4, ls=dashed)
    ax.fill_between(x, rows.min(axis=0), rows.max(axis=0), step="post", color=colour, alpha=0.18, lw=0)
    ends = [t.feasible_at for t in traces if t.feasible_at]
    if ends:
        at = int(np.median(ends))
        ax.plot(at, np.median(rows[:, at - 1]), "o", ms=4.5, color=colour, mec="black", zorder=4)


def _zoom(ax: Axes, runs: Mapping[str, Sequence[Trace]]) -> None:
    length = max(len(t.best) for traces in runs.values() for t in traces)
    tails = [
        -padded(t, length)[:, length // 2 :]
        for t in runs.values()
        if max(len(r.best) for r in t) > length // 2
    ]
    low, high = min(t.min() for t in tails), max(np.median(t, axis=0).max() for t in tails)
    ax.set_xlim(length // 2, length)
    ax.set_ylim(low / 1.08, high * 1.08)
    ax.yaxis.set_minor_locator(NullLocator())
    ax.set_yticks(np.geomspace(low, high, 5))
    ax.yaxis.set_major_formatter(FuncFormatter(lambda v, _: f"{v:.3g}"))
    title(ax, "second half")
