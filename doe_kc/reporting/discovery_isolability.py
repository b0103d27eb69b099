"""Which effects these records can tell apart, and from which size on they would show each."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import BoundaryNorm, ListedColormap
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from doe_kc.correlation.likelihood import rewhitened
from doe_kc.discovery.result import Discovery
from doe_kc.discovery.standing import Status
from doe_kc.effects import EFFECTS
from doe_kc.reporting import style
from doe_kc.reporting.discovery_words import hypothesis_label
from doe_kc.typing import FloatArray

VISIBLE = 1.0
"""Standard deviations that an effect must leave after re-tuning for its direction to mean anything."""
LEVELS = (0.0, 0.3, 0.5, 0.7, 0.8, 0.9, 0.95, 0.99, 1.0)
COLOURS = ListedColormap(
    ["#FFFFFF", "#F3F6F8", "#DCE7EF", "#B7D0E3", "#86B4D5", "#4C93C2", "#0F6BA6", "#08335C"]
)
BARS: dict[Status, str] = {
    "found": style.PALETTE["blue"],
    "trace": style.PALETTE["sky"],
    "excluded": style.PALETTE["green"],
    "unresolved": style.PALETTE["yellow"],
    "not testable": style.PALETTE["orange"],
    "no solution": style.PALETTE["grey"],
}
ROW = 0.148
SMALLEST, LARGEST = 1e-3, 100.0


@dataclass(frozen=True)
class Isolability:
    """labels, statuses: (k,) of every hypothesis. detectable: (k,) smallest size that would be found, in
    typical sizes. correlation: (k, k) |correlation| of the changes that re-tuning leaves, nan where it leaves
    nothing."""

    labels: tuple[str, ...]
    statuses: tuple[Status, ...]
    detectable: FloatArray
    correlation: FloatArray


def isolability(found: Discovery) -> Isolability:
    """In the order of the library; the axle re-tuned about the final model, sizes of its effects known."""
    order = list(EFFECTS)
    stands = sorted(found.standings, key=lambda s: (order.index(s.hypothesis.effect), s.hypothesis.name))
    changes = _changes(found)
    remaining = found.fitted.tuning_projection(np.array([changes[s.hypothesis.name] for s in stands]).T)
    length = np.linalg.norm(remaining, axis=0)
    scaled = remaining / np.where(length > 0.0, length, 1.0)
    correlation = np.clip(np.abs(scaled.T @ scaled), 0.0, 1.0)
    hidden = length < VISIBLE
    correlation[hidden, :] = correlation[:, hidden] = np.nan
    return Isolability(
        tuple(hypothesis_label(s.hypothesis) for s in stands),
        tuple(s.status for s in stands),
        np.array([s.detectable for s in stands]),
        correlation,
    )


def _changes(found: Discovery) -> dict[str, FloatArray]:
    """(M,) change of each hypothesis as screened last, in units of the final model's errors."""
    final = found.fitted.model.likelihood
    last = {s.hypothesis.name: (s, step) for step in found.search.steps for s in step.screened}
    return {
        name: rewhitened(s.change, step.before.model.likelihood, final) for name, (s, step) in last.items()
    }


def isolability_figure(table: Isolability, study: str) -> Figure:
    """Matrix of |correlation| on the left, detectable sizes on the right, one row a hypothesis."""
    count = len(table.labels)
    deep = ROW * count
    height, width = deep + 2.2, 3.25 + deep + 2.6
    margins = {"left": 3.0 / width, "right": 1 - 0.25 / width, "top": 1 - 0.7 / height}
    margins |= {"bottom": 1.5 / height, "wspace": 0.03}
    fig, axes = style.figure(1, 2, size=(width, height), margins=margins, share_x=False,
                             width_ratios=(deep, 2.4))  # fmt: skip
    _matrix(axes[0, 0], table)
    _sizes(axes[0, 1], table)
    _scale(fig, width, height)
    present = [s for s in BARS if s in table.statuses]
    handles: list[Line2D | Patch] = [Patch(color=BARS[s], label=s) for s in present]
    handles.append(Line2D([], [], color="black", ls="--", lw=0.9, label="typical size"))
    fig.legend(handles=handles, loc="lower right", ncols=len(handles), fontsize=7, frameon=False)
    fig.suptitle(f"What these records can tell apart: {study}", fontsize=11, y=1 - 0.12 / height, va="top",
                 parse_math=False)  # fmt: skip
    return fig


def _matrix(ax: Axes, table: Isolability) -> None:
    count = len(table.labels)
    ax.set_facecolor("#E4E7EA")
    norm = BoundaryNorm(LEVELS, COLOURS.N)
    ax.pcolormesh(np.arange(count + 1), np.arange(count + 1), np.ma.masked_invalid(table.correlation),
                  cmap=COLOURS, norm=norm, edgecolors="#ECEFF1", linewidth=0.3)  # fmt: skip
    ax.set_xlim(0, count)
    ax.set_ylim(count, 0)
    ax.grid(visible=False)
    ax.tick_params(length=0)
    places = np.arange(count) + 0.5
    ax.set_yticks(places, [f"{label}  {i}" for i, label in enumerate(table.labels, start=1)], fontsize=6.5)
    ax.set_xticks(places, [str(i) for i in range(1, count + 1)], fontsize=5.5)
    for text, status in zip(ax.get_yticklabels(), table.statuses, strict=True):
        text.set_fontweight("bold" if status == "found" else "normal")
    ax.set_title("|correlation| of the changes that re-tuning leaves", fontsize=8.5)


def _sizes(ax: Axes, table: Isolability) -> None:
    ax.set_xscale("log")
    ax.set_xlim(SMALLEST, LARGEST)
    ax.set_ylim(len(table.labels), 0)
    ax.set_yticks([])
    ax.minorticks_off()
    ticks = (0.001, 0.01, 0.1, 1.0, 10.0, 100.0)
    ax.set_xticks(ticks, [f"{t:g}" for t in ticks])
    ax.grid(visible=False, axis="y")
    for i, (size, status) in enumerate(zip(table.detectable, table.statuses, strict=True)):
        shown = float(np.clip(size, SMALLEST, LARGEST))
        ax.barh(i + 0.5, shown - SMALLEST, left=SMALLEST, height=0.7, color=BARS[status], zorder=2)
        if size > LARGEST:
            ax.plot([LARGEST * 0.8], [i + 0.5], ">", color="white", ms=2.6, zorder=3)
    ax.axvline(1.0, color="black", lw=0.9, ls=(0, (4, 2)), zorder=4)
    ax.set_xlabel("smallest size that would be found,\nas a multiple of the typical one")
    ax.set_title("Detectable size", fontsize=8.5)


def _scale(fig: Figure, width: float, height: float) -> None:
    norm = BoundaryNorm(LEVELS, COLOURS.N)
    place = (3.0 / width, 0.95 / height, 2.6 / width, 0.12 / height)
    bar = fig.colorbar(ScalarMappable(norm, COLOURS), cax=fig.add_axes(place), orientation="horizontal")
    bar.set_ticks(LEVELS, labels=[f"{v:g}" for v in LEVELS])
    bar.set_label("|correlation|; near 1: cannot be told apart", fontsize=6.5)
    bar.ax.tick_params(labelsize=5.5)
    fig.text(3.0 / width, 0.42 / height, "grey: re-tuning absorbs the effect (nearly) wholly", fontsize=6.5)
