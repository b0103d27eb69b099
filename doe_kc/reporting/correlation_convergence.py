"""How the merit of the search rose over the true-solver evaluations."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, MaxNLocator, SymmetricalLogLocator

from doe_kc.correlation.result import Correlation
from doe_kc.reporting import style
from doe_kc.reporting.correlation_evaluations import History, history

MARKERS = "osD^vPX"
FAILED = style.PALETTE["vermillion"]
BEYOND = 3.0
"""Half-decades kept free above the worst rating for the marks of failures."""


def convergence_figure(found: Correlation, study: str) -> Figure:
    """Minus what the search maximizes, symmetric logarithmic, over the evaluations: 0 = every target met
    exactly. With the objective "thesis" it is the rating."""
    past = history(found)
    fig, axes = style.figure(1, 1, size=(8.27, 4.6))
    ax = axes[0, 0]
    _scale(ax, past)
    ax.step(past.number, -past.best, where="post", color=style.PALETTE["black"], lw=1.2, label="best so far")
    for k, origin in enumerate(past.origins):
        _origin(ax, past, origin, style.CYCLE[k % len(style.CYCLE)], MARKERS[k % len(MARKERS)])
    _predicted(ax, past)
    _failed(ax, past)
    _feasible(ax, past)
    style.label(ax, "true-solver evaluation (1 = baseline)", "minus merit of the search [-], symmetric log")
    ax.xaxis.set_major_locator(MaxNLocator(integer=True))
    ax.set_xlim(0.4, past.number[-1] + 0.9)
    ax.legend(loc="upper left", bbox_to_anchor=(1.01, 1.0), borderaxespad=0, fontsize=7, frameon=False)
    ax.set_title(f"Convergence of {found.method}: {study}", fontsize=10, parse_math=False)
    return fig


def threshold(past: History) -> float:
    """Size below which the scale is linear: a decade under the smallest rating that was found."""
    sizes = np.abs(past.rating[np.isfinite(past.rating) & (past.rating != 0.0)])
    return float(10.0 ** np.floor(np.log10(sizes.min()))) if sizes.size else 1.0


def _scale(ax: Axes, past: History) -> None:
    linear = threshold(past)
    ax.set_yscale("symlog", linthresh=linear)
    ax.yaxis.set_major_locator(SymmetricalLogLocator(base=10, linthresh=linear))
    ax.yaxis.set_major_formatter(FuncFormatter(lambda v, _: f"{v:g}"))
    sizes = -past.rating[np.isfinite(past.rating)]
    top = max(float(sizes.max(initial=linear)), linear)
    ax.set_ylim(min(0.0, 1.3 * float(sizes.min(initial=0.0))), top * BEYOND)


def _origin(ax: Axes, past: History, origin: str, colour: str, marker: str) -> None:
    own = np.array([o == origin for o in past.origin]) & ~past.failed
    look: dict[str, Any] = {"color": colour, "ls": "", "marker": marker, "ms": 5, "mew": 1.0}
    for mask, face, word in (
        (own & past.feasible, colour, ""),
        (own & ~past.feasible, "white", ", infeasible"),
    ):
        if mask.any():
            ax.plot(
                past.number[mask], -past.rating[mask], **look, mfc=face, zorder=3, label=f"{origin}{word}",
            )  # fmt: skip


def _predicted(ax: Axes, past: History) -> None:
    known = np.isfinite(past.predicted)
    if known.any():
        ax.errorbar(
            past.number[known] + 0.28, -past.predicted[known], yerr=np.nan_to_num(past.sd[known]), fmt="_",
            color=style.PALETTE["grey"], ecolor=style.PALETTE["grey"], ms=5, elinewidth=0.8, capsize=1.5,
            zorder=2, label="predicted ± sd",
        )  # fmt: skip


def _failed(ax: Axes, past: History) -> None:
    if past.failed.any():
        ax.plot(
            past.number[past.failed], np.full(past.failed.sum(), 0.97), "x", color=FAILED,
            transform=ax.get_xaxis_transform(), ms=6, mew=1.4, label="no equilibrium",
        )  # fmt: skip


def _feasible(ax: Axes, past: History) -> None:
    first = past.first_feasible
    if first is not None:
        ax.axvspan(first - 0.5, past.number[-1] + 0.9, color="#EAF3EA", lw=0, zorder=0)
        ax.axvline(first - 0.5, color=style.PALETTE["green"], lw=1, label=f"feasible from evaluation {first}")
