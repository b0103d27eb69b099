"""Where each variable went between its bounds, and how well the measurement knows it."""

from __future__ import annotations

from itertools import groupby

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, Rectangle

from doe_kc.correlation.result import Correlation
from doe_kc.reporting import style
from doe_kc.reporting.correlation_parameters import ParameterRow, parameter_rows
from doe_kc.rounding import with_sd

SINGLE = 30
"""Variables that stand in one column; more are split over two."""
ROW = 0.2
SEEN, UNSEEN, BOUND = style.PALETTE["blue"], "#B9BEC3", style.PALETTE["vermillion"]


def parameter_figure(found: Correlation, study: str) -> Figure:
    """Bar from baseline to final between lower and upper bound, whisker ± sd of the posterior."""
    rows = [r for r in parameter_rows(found) if r.role == "variable"]
    parts = _columns(_lines(rows))
    columns, deep = len(parts), max(map(len, parts))
    height = ROW * deep + 1.6
    margins = {
        "left": 0.105 if columns == 2 else 0.2,
        "right": 0.86 if columns == 2 else 0.82,
        "wspace": 0.98,
    }
    margins |= {"top": 1 - 0.72 / height, "bottom": 0.85 / height}
    fig, axes = style.figure(1, columns, size=(8.27, height), margins=margins)
    for ax, part in zip(axes[0], parts, strict=True):
        _column(ax, part, deep)
    _legend(fig, found.posterior is not None)
    fig.suptitle(f"Parameter changes: {study}", fontsize=11, y=1 - 0.15 / height, va="top", parse_math=False)
    return fig


def _lines(rows: list[ParameterRow]) -> list[ParameterRow | str]:
    out: list[ParameterRow | str] = []
    for group, members in groupby(rows, key=lambda r: r.group):
        out += [group, *members]
    return out


def _columns(lines: list[ParameterRow | str]) -> list[list[ParameterRow | str]]:
    """One column or two; a group that goes on in the second one is named there again."""
    if len(lines) <= SINGLE:
        return [lines]
    deep = -(-len(lines) // 2)
    first, second = lines[:deep], lines[deep:]
    if isinstance(first[-1], str):
        return [first[:-1], [first[-1], *second]]
    top = second[0]
    return [first, second if isinstance(top, str) else [top.group, *second]]


def _column(ax: Axes, lines: list[ParameterRow | str], deep: int) -> None:
    ax.set_xlim(-0.02, 1.02)
    ax.set_ylim(deep, 0)
    ax.set_xticks([0.0, 0.5, 1.0], ["lower", "middle", "upper"])
    ax.set_yticks([])
    ax.spines["left"].set_visible(False)
    ax.set_xlabel("place between the bounds")
    for y, line in enumerate(lines):
        if isinstance(line, str):
            ax.text(
                -0.04, y + 0.55, line.capitalize(), fontsize=7.2, fontweight="bold", va="center", ha="right"
            )
        else:
            _bar(ax, y + 0.5, line)


def _bar(ax: Axes, y: float, row: ParameterRow) -> None:
    ax.add_patch(Rectangle((0, y - 0.3), 1, 0.6, fc="#F1F3F4", ec="none", zorder=0))
    hidden = row.visible is False
    colour = UNSEEN if hidden else SEEN
    low, wide = min(row.start, row.place), abs(row.place - row.start)
    ax.add_patch(
        Rectangle((low, y - 0.26), wide, 0.52, fc="white" if hidden else colour, ec=colour, lw=0.5,
                  hatch="/////" if hidden else None, zorder=2)
    )  # fmt: skip
    if np.isfinite(row.spread):
        ends = np.clip([row.place - row.spread, row.place + row.spread], 0, 1)
        ax.plot(ends, [y, y], color="#444444", lw=0.7, zorder=3)
    ax.plot([row.start, row.start], [y - 0.36, y + 0.36], color="black", lw=0.8, zorder=3)
    ax.plot([row.place], [y], "o", color=colour, ms=2.8, zorder=4)
    if row.at_bound:
        mark = ">" if row.at_bound == "upper" else "<"
        ax.plot([row.place], [y], mark, color=BOUND, ms=5.5, clip_on=False, zorder=5)
    _texts(ax, y, row, "#777777" if hidden else "black")


def _texts(ax: Axes, y: float, row: ParameterRow, colour: str) -> None:
    ax.text(-0.04, y, row.path, fontsize=6.2, va="center", ha="right", color=colour)
    unit = "" if row.unit == "-" else f" {row.unit}"
    ax.text(1.05, y, f"{with_sd(row.final, row.sd)}{unit}", fontsize=6.2, va="center", color=colour)


def _legend(fig: Figure, known: bool) -> None:
    handles: list[Line2D | Patch] = [
        Line2D([], [], color="black", ls="", marker="|", ms=7, label="baseline"),
        Line2D([], [], color=SEEN, ls="", marker="o", ms=3.5, label="final"),
        Line2D([], [], color=BOUND, ls="", marker=">", ms=5.5, label="at its bound"),
    ]
    if known:
        handles += [
            Line2D([], [], color="#444444", lw=0.8, label="± sd (posterior)"),
            Patch(fc="white", ec=UNSEEN, hatch="/////", label="not visible in these measurements"),
        ]
    fig.legend(handles=handles, loc="lower center", ncols=5, fontsize=7, frameon=False)
