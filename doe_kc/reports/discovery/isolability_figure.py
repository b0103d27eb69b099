"""Groups of effects that the records cannot tell apart, and from which size on they would show each."""

from __future__ import annotations

import numpy as np
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from doe_kc.discovery.thresholds import ALIKE_CORRELATION
from doe_kc.discovery.verdict.exclusion import Status
from doe_kc.reports.discovery.isolability import (
    HIDDEN,
    Isolability,
    IsolabilityRow,
    group_name,
    isolability_rows,
)
from doe_kc.reports.discovery.words import STATUS_WORDS
from doe_kc.reports.drawing import style
from doe_kc.reports.drawing.panel import Panel
from doe_kc.reports.drawing.sheet import Sheet, sheet
from doe_kc.reports.drawing.words import POINTS, text_width

BAR_COLOURS: dict[Status, str] = {
    "found": style.PALETTE["blue"],
    "trace": style.PALETTE["sky"],
    "excluded": style.PALETTE["green"],
    "unresolved": style.PALETTE["yellow"],
    "not testable": style.PALETTE["orange"],
    "no solution": style.PALETTE["grey"],
}
ISOLABILITY_ROW, ISOLABILITY_HEAD, ISOLABILITY_FOOT = 0.138, 0.92, 0.95
"""Inches at most of a row, and of title and key of the page."""
SMALLEST_MULTIPLE, LARGEST_MULTIPLE = 1e-3, 100.0
BARS = (0.33, 0.535)
"""Place of the bars across the page."""
SMALLEST_TEXT = 4.5
"""Points."""
GROUP_COLOURS = ("#EAF1F7", "#F6F1E4")
"""Behind the groups, in turn."""


def isolability_figure(table: Isolability, study: str) -> Sheet:
    """One row a hypothesis under the name of its group: detectable size, and what to measure. One A4 page."""
    lines = _lines(table)
    free = style.A4[1] - ISOLABILITY_HEAD - ISOLABILITY_FOOT
    row = min(ISOLABILITY_ROW, free / len(lines))
    height = row * len(lines) + ISOLABILITY_HEAD + ISOLABILITY_FOOT
    margins = {
        "left": BARS[0],
        "right": BARS[1],
        "top": 1 - ISOLABILITY_HEAD / height,
        "bottom": ISOLABILITY_FOOT / height,
    }
    page, panels = sheet(1, 1, size=(style.A4[0], height), margins=margins)
    panel = panels[0, 0]
    _frame(panel, len(lines))
    _bars(panel, lines)
    _texts(panel, lines, min(6.3, 0.62 * row * POINTS))
    _shade(panel, lines)
    present = [s for s in BAR_COLOURS if s in table.statuses]
    handles: list[Line2D | Patch] = [Patch(color=BAR_COLOURS[s], label=STATUS_WORDS[s]) for s in present]
    handles.append(Line2D([], [], color="black", ls="--", lw=0.9, label="typical size"))
    page.add_legend(handles, len(handles))
    page.set_heading(f"What these records can tell apart: {study}", 1 - 0.12 / height)
    page.write(
        0.5, 1 - 0.36 / height,
        f"Within a group, the changes that re-tuning leaves have a |correlation| of {ALIKE_CORRELATION:g} "
        "and above: the records name the group, not the member.",
        7.0, "center", "top", color="#555555",
    )  # fmt: skip
    page.write(
        BARS[1] + 0.012, 1 - (ISOLABILITY_HEAD - 0.05) / height,
        "what to measure to see it, or to tell it apart", 6.5, "left", "bottom", color="#555555",
    )  # fmt: skip
    return page


def _lines(table: Isolability) -> list[IsolabilityRow | str]:
    """Rows below the heads of their groups."""
    named = {
        group_name(k): f"{group_name(k)}  alike: |r| {_floor(table.least_correlation(group))} and above"
        for k, group in enumerate(table.groups)
    }
    heads = {**named, HIDDEN: "Hidden: re-tuning takes the place of each"}
    out: list[IsolabilityRow | str] = []
    last = ""
    for row in isolability_rows(table):
        if row.group != last:
            out.append(heads.get(row.group, "Told apart from all others"))
        out.append(row)
        last = row.group
    return out


def _floor(correlation: float) -> str:
    """Two decimals, never rounded up."""
    return f"{np.floor(100.0 * correlation) / 100.0:.2f}"


def _frame(panel: Panel, count: int) -> None:
    panel.x.set_logarithmic()
    panel.x.set_limits(SMALLEST_MULTIPLE, LARGEST_MULTIPLE)
    panel.y.set_limits(count, 0)
    panel.y.set_ticks([], [])
    ticks = (0.001, 0.01, 0.1, 1.0, 10.0, 100.0)
    panel.x.set_ticks(ticks, [f"{t:g}" for t in ticks])
    panel.number_size["x"] = 6.5
    panel.vline(1.0, (0, (4, 2)), color="black", lw=0.9, zorder=2.5)
    panel.set_labels("smallest size that would be found,\nas a multiple of the typical one", None, 7.0)


def _bars(panel: Panel, lines: list[IsolabilityRow | str]) -> None:
    rows = [(i + 0.5, line) for i, line in enumerate(lines) if isinstance(line, IsolabilityRow)]
    places = np.array([y for y, _ in rows])
    sizes = np.array([row.detectable for _, row in rows])
    shown = np.clip(sizes, SMALLEST_MULTIPLE, LARGEST_MULTIPLE)
    colours = [BAR_COLOURS[row.status] for _, row in rows]
    panel.bars(places, SMALLEST_MULTIPLE, shown, 0.7, colours, zorder=2)
    beyond = places[sizes > LARGEST_MULTIPLE]
    panel.plot(
        np.full(beyond.size, LARGEST_MULTIPLE * 0.7), beyond, "", marker=">", color="black", ms=2.6, zorder=3
    )


def _texts(panel: Panel, lines: list[IsolabilityRow | str], size: float) -> None:
    panel.number_size["y"] = size
    start = -(panel.box.left - 14.0) / panel.box.width
    for i, line in enumerate(lines):
        y = i + 0.5
        if isinstance(line, str):
            panel.text(
                start, y, line, scales=("panel", "data"), size=size + 0.2, weight="bold", along="center",
                backing="white" if i else None,
            )  # fmt: skip
            continue
        weight = "bold" if line.status == "found" else "normal"
        panel.text(
            0.0, y, line.label, scales=("panel", "data"), shift=(-5.0, 0.0), size=size, across="right",
            along="center", weight=weight,
        )  # fmt: skip
        panel.text(
            1.0, y, line.test, scales=("panel", "data"), shift=(7.0, 0.0), along="center", color="#333333",
            size=_fitting(line.test, size, panel),
        )  # fmt: skip


def _fitting(words: str, size: float, panel: Panel) -> float:
    """Points at which the words end before the edge of the page."""
    room = style.A4[0] * POINTS - panel.box.right - 16.0
    while words and size > SMALLEST_TEXT and text_width(words, size) > room:
        size -= 0.1
    return round(size, 1)


def _shade(panel: Panel, lines: list[IsolabilityRow | str]) -> None:
    heads = [i for i, line in enumerate(lines) if isinstance(line, str)]
    for k, (start, end) in enumerate(zip(heads, [*heads[1:], len(lines)], strict=True)):
        panel.hspan(start, end, color=GROUP_COLOURS[k % len(GROUP_COLOURS)], zorder=0)
