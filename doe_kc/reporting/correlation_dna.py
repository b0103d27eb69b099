"""The correlation DNA: where baseline and final stand between target and constraint interval (Appendix D)."""

from __future__ import annotations

from itertools import groupby
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, Rectangle

from doe_kc.correlation.result import Correlation
from doe_kc.reporting import style
from doe_kc.reporting.correlation_characteristics import CharacteristicRow, characteristic_rows
from doe_kc.rounding import short

REACH = 0.6
"""Normalised distance from the target at which a value is cut off and drawn as an arrow."""
BAND, SOFT = "#C9CED3", "#EDEFF1"
BASELINE, FINAL, WORSE = style.PALETTE["orange"], style.PALETTE["blue"], style.PALETTE["vermillion"]
ROW = 0.235
"""Inches."""
X0, X1 = 0.475, 0.79
"""Place of the bars across the sheet; text columns around them."""
COLUMNS = {"unit": 0.235, "target": 0.345, "baseline": 0.405, "final": 0.462, "improvement": 0.865}


def dna_figure(found: Correlation, study: str) -> Figure:
    """One row a characteristic, normalised to its target; true numbers beside, improvement at the right."""
    rows = characteristic_rows(found)
    groups = [(name, list(members)) for name, members in groupby(rows, key=lambda r: r.load_case)]
    lines = len(rows) + len(groups)
    height = ROW * lines + 1.9
    margins = {"left": X0, "right": X1, "top": 1 - 1.0 / height, "bottom": 0.9 / height}
    fig, axes = style.figure(1, 1, size=(8.27, height), margins=margins)
    ax = axes[0, 0]
    _frame(ax, lines)
    at = 0
    for name, members in groups:
        ax.text(_across(0.02), at + 0.62, name, fontsize=8, fontweight="bold", va="center", clip_on=False)
        for k, row in enumerate(members, start=at + 1):
            _row(ax, k + 0.5, row)
        at += len(members) + 1
    _heads(ax)
    _legend(fig)
    fig.suptitle(f"Correlation DNA: {study}", fontsize=11, y=1 - 0.18 / height, va="top", parse_math=False)
    fig.text(0.5, 1 - 0.42 / height, _summary(found), ha="center", va="top", fontsize=7.5, color="#555555")
    return fig


def _summary(found: Correlation) -> str:
    mean = found.mean_improvement
    words = f"mean improvement {mean:.1f} %" if np.isfinite(mean) else "no characteristic counts"
    state = "every constraint met" if found.feasible else "constraints violated"
    return f"{words}, rating {found.rating:.4g}, {state}"


def _across(x: float) -> float:
    """Data coordinate of a place across the sheet."""
    return float(1 - REACH + (x - X0) / (X1 - X0) * 2 * REACH)


def _frame(ax: Axes, lines: int) -> None:
    ax.set_xlim(1 - REACH, 1 + REACH)
    ax.set_ylim(lines, 0)
    ax.set_yticks([])
    ax.grid(visible=False, axis="y")
    ax.spines["left"].set_visible(False)
    ax.axvline(1.0, color=style.PALETTE["black"], lw=1.0, ls=(0, (4, 2)))
    ax.set_xlabel("normalised to the target (1); default interval 1 ± 0.15")


def _heads(ax: Axes) -> None:
    for name, x in COLUMNS.items():
        ha = "left" if name == "unit" else "right"
        ax.text(_across(x), -0.15, name, fontsize=7, ha=ha, va="bottom", color="#555555")


def _row(ax: Axes, y: float, row: CharacteristicRow) -> None:
    entry, (low, high) = row.entry, row.interval
    ends = sorted(row.normalized(v) for v in (low, high))
    ends = [float(np.clip(v, 1 - REACH, 1 + REACH)) for v in ends]
    fill: dict[str, Any] = (
        {"fc": BAND} if row.constraint else {"fc": "none", "ec": BAND, "ls": ":", "lw": 0.7}
    )
    ax.add_patch(Rectangle((ends[0], y - 0.36), ends[1] - ends[0], 0.72, **fill, zorder=0))
    places = [row.normalized(v) for v in (entry.baseline, entry.final)]
    if np.isfinite(places).all():
        shown = np.clip(places, 1 - REACH, 1 + REACH)
        ax.plot(shown, [y, y], color="#8A9199", lw=0.8, zorder=1)
        _marker(ax, places[0], y, BASELINE, "o")
        _marker(ax, places[1], y, FINAL if row.inside or not row.constraint else WORSE, "D")
    _texts(ax, y, row)


def _marker(ax: Axes, place: float, y: float, colour: str, shape: str) -> None:
    """The value, or an arrow at the edge that it lies beyond."""
    beyond = abs(place - 1) > REACH
    shown = float(np.clip(place, 1 - REACH, 1 + REACH))
    mark = shape if not beyond else ">" if place > 1 else "<"
    face = "white" if shape == "o" and not beyond else colour
    ax.plot([shown], [y], mark, color=colour, mfc=face, mew=1.1, ms=4.4, clip_on=False, zorder=3)


def _texts(ax: Axes, y: float, row: CharacteristicRow) -> None:
    entry = row.entry
    muted = "#000000" if entry.target.active or entry.sought else "#777777"
    ax.text(_across(0.035), y, row.label, fontsize=7, va="center", color=muted, clip_on=False)
    ax.text(_across(COLUMNS["unit"]), y, row.unit, fontsize=6.5, va="center", color="#555555")
    for name, value in (
        ("target", entry.target.value),
        ("baseline", entry.baseline),
        ("final", entry.final),
    ):
        ax.text(_across(COLUMNS[name]), y, short(value), fontsize=6.5, va="center", ha="right", color=muted)
    words = f"{entry.percent:.1f} %" if np.isfinite(entry.percent) else "on target"
    weight, colour = ("bold", muted) if entry.counts else ("normal", "#777777")
    ax.text(
        _across(COLUMNS["improvement"]), y, words, fontsize=6.5, va="center", ha="right", color=colour,
        fontweight=weight,
    )  # fmt: skip
    ax.text(_across(0.88), y, note(row), fontsize=6, va="center", color="#555555")


def note(row: CharacteristicRow) -> str:
    """Why a row is special, in two words."""
    if not row.entry.target.active and not row.entry.sought:
        return row.role
    if row.constraint and not row.inside:
        return "outside"
    return "" if row.entry.counts else "baseline within 3 sd"


def _legend(fig: Figure) -> None:
    line: dict[str, Any] = {"ls": "", "ms": 4.4}
    handles = [
        Line2D([], [], marker="o", color=BASELINE, mfc="white", label="baseline", **line),
        Line2D([], [], marker="D", color=FINAL, label="final", **line),
        Line2D([], [], marker="D", color=WORSE, label="final, constraint violated", **line),
        Line2D([], [], color="black", ls="--", lw=1, label="target"),
        Patch(color=BAND, label="constraint interval"),
        Patch(fc="none", ec=BAND, ls=":", label="interval, not a constraint"),
        Line2D([], [], marker=">", color="#555555", label="beyond the axis", **line),
    ]
    fig.legend(
        handles=handles,
        loc="lower center",
        ncols=7,
        fontsize=6.5,
        handletextpad=0.4,
        columnspacing=1.2,
        frameon=False,
    )
