"""Which effects these records can tell apart, and from which size on they would show each."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from matplotlib.collections import QuadMesh
from matplotlib.colors import BoundaryNorm, ListedColormap
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from doe_kc.correlation.likelihood import rewhitened
from doe_kc.discovery.result import Discovery
from doe_kc.discovery.verdict.exclusion import Status
from doe_kc.effects import EFFECTS
from doe_kc.ground.typing import FloatArray
from doe_kc.report import style
from doe_kc.report.color_scale import draw_color_scale, outline
from doe_kc.report.discovery_words import hypothesis_label
from doe_kc.report.panel import PageBox, Panel
from doe_kc.report.sheet import Sheet, sheet
from doe_kc.report.words import POINTS

VISIBLE_LEVEL = 1.0
"""Standard deviations that an effect must leave after re-tuning for its direction to mean anything."""
LEVELS = (0.0, 0.3, 0.5, 0.7, 0.8, 0.9, 0.95, 0.99, 1.0)
CORRELATION_MAP = ListedColormap(
    ["#FFFFFF", "#F3F6F8", "#DCE7EF", "#B7D0E3", "#86B4D5", "#4C93C2", "#0F6BA6", "#08335C"]
)
BAR_COLOURS: dict[Status, str] = {
    "found": style.PALETTE["blue"],
    "trace": style.PALETTE["sky"],
    "excluded": style.PALETTE["green"],
    "unresolved": style.PALETTE["yellow"],
    "not testable": style.PALETTE["orange"],
    "no solution": style.PALETTE["grey"],
}
ISOLABILITY_ROW = 0.148
SMALLEST_MULTIPLE, LARGEST_MULTIPLE = 1e-3, 100.0


@dataclass(frozen=True)
class Isolability:
    """labels, statuses: (k,) of every hypothesis. detectable: (k,) smallest size that would be found, in
    typical sizes. correlation: (k, k) |correlation| of the changes that re-tuning leaves, nan where it leaves
    nothing."""

    labels: tuple[str, ...]
    statuses: tuple[Status, ...]
    detectable: FloatArray
    correlation: FloatArray


def isolability(discovery: Discovery) -> Isolability:
    """In the order of the library; the axle re-tuned about the final model, sizes of its effects known."""
    order = list(EFFECTS)
    stands = sorted(discovery.statuses, key=lambda s: (order.index(s.hypothesis.effect), s.hypothesis.name))
    changes = _changes(discovery)
    remaining = discovery.fitted.tuning_projection(np.array([changes[s.hypothesis.name] for s in stands]).T)
    length = np.linalg.norm(remaining, axis=0)
    scaled = remaining / np.where(length > 0.0, length, 1.0)
    correlation = np.clip(np.abs(scaled.T @ scaled), 0.0, 1.0)
    hidden = length < VISIBLE_LEVEL
    correlation[hidden, :] = correlation[:, hidden] = np.nan
    return Isolability(
        tuple(hypothesis_label(s.hypothesis) for s in stands),
        tuple(s.status for s in stands),
        np.array([s.detectable for s in stands]),
        correlation,
    )


def _changes(discovery: Discovery) -> dict[str, FloatArray]:
    """(M,) change of each hypothesis as screened last, in units of the final model's errors."""
    final = discovery.fitted.model.likelihood
    last = {s.hypothesis.name: (s, step) for step in discovery.search.steps for s in step.screened}
    return {
        name: rewhitened(s.change, step.before.model.likelihood, final) for name, (s, step) in last.items()
    }


def isolability_figure(table: Isolability, study: str) -> Sheet:
    """Matrix of |correlation| on the left, detectable sizes on the right, one row a hypothesis."""
    count = len(table.labels)
    deep = ISOLABILITY_ROW * count
    height, width = deep + 2.2, 3.25 + deep + 2.6
    margins = {"left": 3.0 / width, "right": 1 - 0.25 / width, "top": 1 - 0.7 / height}
    margins |= {"bottom": 1.5 / height, "wspace": 0.03}
    page, panels = sheet(1, 2, size=(width, height), margins=margins, share_x=False,
                         width_ratios=(deep, 2.4))  # fmt: skip
    _matrix(panels[0, 0], table)
    _sizes(panels[0, 1], table)
    _scale(page)
    present = [s for s in BAR_COLOURS if s in table.statuses]
    handles: list[Line2D | Patch] = [Patch(color=BAR_COLOURS[s], label=s) for s in present]
    handles.append(Line2D([], [], color="black", ls="--", lw=0.9, label="typical size"))
    page.add_legend(handles, len(handles), corner=("right", "bottom"))
    page.set_heading(f"What these records can tell apart: {study}", 1 - 0.12 / height)
    return page


def _matrix(panel: Panel, table: Isolability) -> None:
    count = len(table.labels)
    panel.background = "#E4E7EA"
    edges = np.stack(np.meshgrid(np.arange(count + 1), np.arange(count + 1)), axis=-1)
    panel.add(
        QuadMesh(edges, array=np.ma.masked_invalid(table.correlation), cmap=CORRELATION_MAP,
                 norm=BoundaryNorm(LEVELS, CORRELATION_MAP.N), edgecolors="#ECEFF1", linewidth=0.3)
    )  # fmt: skip
    panel.x.set_limits(0, count)
    panel.y.set_limits(count, 0)
    panel.grid, panel.marks = dict.fromkeys(panel.grid, False), dict.fromkeys(panel.marks, False)
    panel.number_size = {"x": 5.5, "y": 6.5}
    places = np.arange(count) + 0.5
    names = [f"{label}  {i}" for i, label in enumerate(table.labels, start=1)]
    panel.y.set_ticks(places, names, [status == "found" for status in table.statuses])
    panel.x.set_ticks(places, [str(i) for i in range(1, count + 1)])
    panel.set_title("|correlation| of the changes that re-tuning leaves", size=8.5)


def _sizes(panel: Panel, table: Isolability) -> None:
    panel.x.set_logarithmic()
    panel.x.set_limits(SMALLEST_MULTIPLE, LARGEST_MULTIPLE)
    panel.y.set_limits(len(table.labels), 0)
    panel.y.set_ticks([], [])
    ticks = (0.001, 0.01, 0.1, 1.0, 10.0, 100.0)
    panel.x.set_ticks(ticks, [f"{t:g}" for t in ticks])
    places = np.arange(len(table.labels)) + 0.5
    shown = np.clip(table.detectable, SMALLEST_MULTIPLE, LARGEST_MULTIPLE)
    panel.bars(places, SMALLEST_MULTIPLE, shown, 0.7, [BAR_COLOURS[s] for s in table.statuses], zorder=2)
    beyond = places[table.detectable > LARGEST_MULTIPLE]
    panel.plot(
        np.full(beyond.size, LARGEST_MULTIPLE * 0.8), beyond, "", marker=">", color="white", ms=2.6, zorder=3
    )
    panel.vline(1.0, (0, (4, 2)), color="black", lw=0.9, zorder=4)
    panel.set_labels("smallest size that would be found,\nas a multiple of the typical one", None)
    panel.set_title("Detectable size", size=8.5)


def _scale(page: Sheet) -> None:
    """Every level is as wide as the next."""
    panel = page.add_panel(PageBox(3.0 * POINTS, 0.95 * POINTS, 2.6 * POINTS, 0.12 * POINTS))
    edges = np.arange(float(len(LEVELS)))
    draw_color_scale(panel, edges, CORRELATION_MAP(np.arange(CORRELATION_MAP.N)))
    outline(panel)
    panel.x.set_ticks(edges, [f"{v:g}" for v in LEVELS])
    panel.number_size["x"] = 5.5
    panel.set_labels("|correlation|; near 1: cannot be told apart", None, 6.5)
    words = "grey: re-tuning absorbs the effect (nearly) wholly"
    page.write(3.0 * POINTS / page.width, 0.42 * POINTS / page.height, words, 6.5)
