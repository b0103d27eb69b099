"""The correlation DNA: where baseline and final stand between target and constraint interval (Appendix D)."""

from __future__ import annotations

from itertools import groupby
from typing import Any

import numpy as np
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from doe_kc.correlation.result import Correlation
from doe_kc.ground.numbers import short
from doe_kc.reports.correlation.characteristics import CharacteristicRow, characteristic_rows
from doe_kc.reports.drawing import style
from doe_kc.reports.drawing.panel import Panel
from doe_kc.reports.drawing.sheet import Sheet, sheet
from doe_kc.reports.drawing.words import Across

DNA_REACH = 0.6
"""Normalised distance from the target at which a value is cut off and drawn as an arrow."""
BAND_COLOUR, SOFT_BAND_COLOUR = "#C9CED3", "#EDEFF1"
WORSE_COLOUR = style.PALETTE["vermillion"]
DNA_ROW = 0.235
"""Inches."""
X0, X1 = 0.505, 0.8
"""Place of the bars across the sheet; text columns around them."""
COLUMN_PLACES = {"unit": 0.23, "target": 0.353, "baseline": 0.421, "final": 0.489, "improvement": 0.872}


def dna_figure(correlation: Correlation, study: str) -> Sheet:
    """One row a characteristic, normalised to its target; true numbers beside, improvement at the right."""
    rows = characteristic_rows(correlation)
    groups = [(name, list(members)) for name, members in groupby(rows, key=lambda r: r.load_case)]
    lines = len(rows) + len(groups)
    height = DNA_ROW * lines + 1.9
    margins = {"left": X0, "right": X1, "top": 1 - 1.0 / height, "bottom": 0.9 / height}
    page, panels = sheet(1, 1, size=(8.27, height), margins=margins)
    panel = panels[0, 0]
    _frame(panel, lines)
    at = 0
    for name, members in groups:
        panel.text(_across(0.02), at + 0.62, name, size=8.0, weight="bold", along="center")
        for k, row in enumerate(members, start=at + 1):
            _row(panel, k + 0.5, row)
        at += len(members) + 1
    _heads(panel)
    _legend(page)
    page.set_heading(f"Correlation DNA: {study}", 1 - 0.18 / height)
    page.write(0.5, 1 - 0.42 / height, _summary(correlation), 7.5, "center", "top", color="#555555")
    return page


def _summary(correlation: Correlation) -> str:
    mean = correlation.mean_improvement
    words = f"mean improvement {mean:.1f} %" if np.isfinite(mean) else "no characteristic counts"
    state = "every constraint met" if correlation.feasible else "constraints violated"
    return f"{words}, rating {correlation.rating:.4g}, {state}"


def _across(x: float) -> float:
    """Data coordinate of a place across the sheet."""
    return float(1 - DNA_REACH + (x - X0) / (X1 - X0) * 2 * DNA_REACH)


def _frame(panel: Panel, lines: int) -> None:
    panel.x.set_limits(1 - DNA_REACH, 1 + DNA_REACH)
    panel.y.set_limits(lines, 0)
    panel.y.set_ticks([], [])
    panel.spines["left"] = False
    panel.vline(1.0, (0, (4, 2)), color=style.PALETTE["black"], lw=1.0)
    panel.set_labels("normalised to the target (1); default interval 1 ± 0.15", None)


def _heads(panel: Panel) -> None:
    for name, x in COLUMN_PLACES.items():
        side: Across = "left" if name == "unit" else "right"
        panel.text(_across(x), -0.15, name, size=7.0, across=side, along="bottom", color="#555555")


def _row(panel: Panel, y: float, row: CharacteristicRow) -> None:
    entry, (low, high) = row.entry, row.interval
    ends = sorted(row.normalized(v) for v in (low, high))
    ends = [float(np.clip(v, 1 - DNA_REACH, 1 + DNA_REACH)) for v in ends]
    fill: dict[str, Any] = (
        {"colors": [BAND_COLOUR]}
        if row.constraint
        else {"colors": ["none"], "edgecolors": BAND_COLOUR, "linestyles": ":", "linewidths": 0.7}
    )
    panel.bars(y, ends[0], ends[1], 0.72, **fill, zorder=0)
    places = [row.normalized(v) for v in (entry.baseline, entry.final)]
    if np.isfinite(places).all():
        shown = np.clip(places, 1 - DNA_REACH, 1 + DNA_REACH)
        panel.plot(shown, [y, y], color="#8A9199", lw=0.8, zorder=1)
        _marker(panel, places[0], y, style.BASELINE_COLOUR, "o")
        met = row.inside or not row.constraint
        _marker(panel, places[1], y, style.FINAL_COLOUR if met else WORSE_COLOUR, "D")
    _texts(panel, y, row)


def _marker(panel: Panel, place: float, y: float, colour: str, shape: str) -> None:
    """The value, or an arrow at the edge that it lies beyond."""
    beyond = abs(place - 1) > DNA_REACH
    shown = float(np.clip(place, 1 - DNA_REACH, 1 + DNA_REACH))
    mark = shape if not beyond else ">" if place > 1 else "<"
    face = "white" if shape == "o" and not beyond else colour
    panel.plot(shown, y, "", marker=mark, color=colour, mfc=face, mew=1.1, ms=4.4, clip=False, zorder=3)


def _texts(panel: Panel, y: float, row: CharacteristicRow) -> None:
    entry = row.entry
    muted = "#000000" if entry.target.active or entry.sought else "#777777"
    panel.text(_across(0.035), y, row.label, size=7.0, along="center", color=muted)
    panel.text(_across(COLUMN_PLACES["unit"]), y, row.unit, size=6.5, along="center", color="#555555")
    for name, value in (
        ("target", entry.target.value),
        ("baseline", entry.baseline),
        ("final", entry.final),
    ):
        panel.text(
            _across(COLUMN_PLACES[name]),
            y,
            short(value),
            size=6.5,
            across="right",
            along="center",
            color=muted,
        )
    words = f"{entry.percent:.1f} %" if np.isfinite(entry.percent) else "on target"
    weight, colour = ("bold", muted) if entry.counts else ("normal", "#777777")
    panel.text(
        _across(COLUMN_PLACES["improvement"]), y, words, size=6.5, across="right", along="center",
        color=colour, weight=weight,
    )  # fmt: skip
    panel.text(_across(0.878), y, row.note, size=5.4, along="center", color="#555555")


def _legend(page: Sheet) -> None:
    line: dict[str, Any] = {"ls": "", "ms": 4.4}
    handles: list[Line2D | Patch] = [
        Line2D([], [], marker="o", color=style.BASELINE_COLOUR, mfc="white", label="baseline", **line),
        Line2D([], [], marker="D", color=style.FINAL_COLOUR, label="final", **line),
        Line2D([], [], marker="D", color=WORSE_COLOUR, label="final, constraint violated", **line),
        Line2D([], [], color="black", ls="--", lw=1, label="target"),
        Patch(color=BAND_COLOUR, label="constraint interval"),
        Patch(fc="none", ec=BAND_COLOUR, ls=":", label="interval, not a constraint"),
        Line2D([], [], marker=">", color="#555555", label="beyond the axis", **line),
    ]
    page.add_legend(handles, 7, 6.5, handletextpad=0.4, columnspacing=1.2)
