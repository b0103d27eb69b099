"""How large the gap is for each load case and response: nominal, re-tuned, with effect, with the best
other one, noise."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import groupby

import numpy as np
from matplotlib.lines import Line2D

from doe_kc.curves import response_name
from doe_kc.discovery.result import Gap
from doe_kc.load_cases import case_label
from doe_kc.reports.discovery.tables import GapRow
from doe_kc.reports.discovery.words import MODEL_LABELS
from doe_kc.reports.drawing import style
from doe_kc.reports.drawing.panel import Panel
from doe_kc.reports.drawing.sheet import Sheet, sheet

MODEL_COLOURS = {
    "nominal": "#555555",
    "tuned": style.PALETTE["orange"],
    "with_effect": style.PALETTE["blue"],
    "best_decoy": style.PALETTE["purple"],
}
"""Of the four models, in every picture."""
MARKS = {"nominal": "|", "tuned": "o", "with_effect": "D", "best_decoy": "x"}
GAP_ROW = 0.165
LOWEST = 0.7


def gap_figure(rows: Sequence[GapRow], study: str) -> Sheet:
    """A row a load case and response, whitened RMS on a logarithmic axis; 1 is noise."""
    lines: list[GapRow | str] = []
    for case, members in groupby(rows, key=lambda r: r.case):
        lines += [case_label(case) if case else "All records", *members]
    second = _break(lines)
    deep = max(second, len(lines) - second)
    height = GAP_ROW * deep + 1.5
    margins = {"left": 0.18, "right": 0.985, "wspace": 0.5, "top": 1 - 0.55 / height, "bottom": 0.95 / height}
    page, panels = sheet(1, 2, size=(8.27, height), margins=margins)
    highest = 1.4 * max(np.nanmax([getattr(r.gap, m) for m in MODEL_LABELS]) for r in rows)
    for panel, part in zip(panels[0], (lines[:second], lines[second:]), strict=True):
        _column(panel, part, deep, highest)
    _legend(page, rows[0].gap)
    page.set_heading(f"Gap between model and records: {study}", 1 - 0.12 / height)
    return page


def _break(lines: Sequence[GapRow | str]) -> int:
    """Where the second column begins, with a load case: the longer of the two is the shortest there."""
    heads = [i for i, line in enumerate(lines) if isinstance(line, str)]
    return min(heads[1:] or [len(lines)], key=lambda i: max(i, len(lines) - i))


def _column(panel: Panel, lines: Sequence[GapRow | str], deep: int, highest: float) -> None:
    panel.x.set_logarithmic()
    panel.x.set_limits(LOWEST, max(highest, 3.0))
    panel.y.set_limits(deep, 0)
    ticks = [t for t in (1, 2, 5, 10, 20, 50, 100, 200, 500) if t <= max(highest, 3.0)]
    panel.x.set_ticks(ticks, [f"{t:g}" for t in ticks])
    panel.spines["left"] = panel.grid["y"] = panel.marks["y"] = False
    panel.vline(1.0, (0, (4, 2)), color="black", lw=0.9, zorder=1)
    panel.set_labels("RMS of model − measured, times the noise", None)
    places = [i + 0.5 for i in range(len(lines))]
    panel.y.set_ticks(places, [_name(line) for line in lines], [isinstance(line, str) for line in lines])
    panel.number_size["y"] = 6.5
    for line, y in zip(lines, places, strict=True):
        if not isinstance(line, str):
            _row(panel, y, line.gap)


def _name(line: GapRow | str) -> str:
    if isinstance(line, str):
        return line
    return response_name(line.response) if line.response else "all responses"


def _row(panel: Panel, y: float, gap: Gap) -> None:
    known = {m: float(getattr(gap, m)) for m in MODEL_LABELS if np.isfinite(getattr(gap, m))}
    panel.plot([min(known.values()), max(known.values())], [y, y], color="#C9CED3", lw=1.0, zorder=2)
    for model, value in known.items():
        face = "white" if model == "tuned" else MODEL_COLOURS[model]
        panel.plot(
            max(value, LOWEST), y, "", marker=MARKS[model], color=MODEL_COLOURS[model], mfc=face,
            ms=4.2, mew=1.2, zorder=3 + list(MODEL_LABELS).index(model) % 3,
        )  # fmt: skip


def _legend(page: Sheet, gap: Gap) -> None:
    handles = [
        Line2D([], [], color=MODEL_COLOURS[m], ls="", marker=MARKS[m], ms=4.5, mew=1.2, label=MODEL_LABELS[m],
               mfc="white" if m == "tuned" else MODEL_COLOURS[m])
        for m in MODEL_LABELS if np.isfinite(getattr(gap, m))
    ]  # fmt: skip
    handles.append(Line2D([], [], color="black", ls="--", lw=0.9, label="noise floor"))
    page.add_legend(handles, 5)
