"""How large the gap is for each load case and response: nominal, re-tuned, with effect, decoy, noise."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import groupby

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from doe_kc.discovery.result import Discovery, Gap
from doe_kc.reporting import style
from doe_kc.reporting.discovery_words import MODELS
from doe_kc.reporting.names import case_label, response_name

COLOURS = {
    "nominal": "#555555",
    "tuned": style.PALETTE["orange"],
    "with_effect": style.PALETTE["blue"],
    "best_decoy": style.PALETTE["purple"],
}
"""Of the four models, in every picture."""
MARKS = {"nominal": "|", "tuned": "o", "with_effect": "D", "best_decoy": "x"}
ROW = 0.165
LOWEST = 0.7


@dataclass(frozen=True)
class GapRow:
    """One row; case is empty for all records together."""

    case: str
    response: str
    gap: Gap


def gap_rows(found: Discovery) -> list[GapRow]:
    """All records, then load case by load case; without effects the last value is left out."""
    rows = [GapRow("", "", found.gap), *(GapRow(g.load_case, g.response, g.gap) for g in found.gaps)]
    if found.fitted.model.members:
        return rows
    return [GapRow(r.case, r.response, Gap(**{**vars(r.gap), "with_effect": np.nan})) for r in rows]


def gap_figure(rows: Sequence[GapRow], study: str) -> Figure:
    """A row a load case and response, whitened RMS on a logarithmic axis; 1 is noise."""
    lines: list[GapRow | str] = []
    for case, members in groupby(rows, key=lambda r: r.case):
        lines += [case_label(case) if case else "All records", *members]
    deep = _break(lines)
    height = ROW * deep + 1.5
    margins = {"left": 0.18, "right": 0.985, "wspace": 0.5, "top": 1 - 0.55 / height, "bottom": 0.95 / height}
    fig, axes = style.figure(1, 2, size=(8.27, height), margins=margins)
    highest = 1.4 * max(np.nanmax([getattr(r.gap, m) for m in MODELS]) for r in rows)
    for ax, part in zip(axes[0], (lines[:deep], lines[deep:]), strict=True):
        _column(ax, part, deep, highest)
    _legend(fig, rows[0].gap)
    fig.suptitle(f"Gap between model and records: {study}", fontsize=11, y=1 - 0.12 / height, va="top",
                 parse_math=False)  # fmt: skip
    return fig


def _break(lines: Sequence[GapRow | str]) -> int:
    """Rows of the first column: the second begins with a load case."""
    heads = [i for i, line in enumerate(lines) if isinstance(line, str)]
    return min(heads[1:] or [len(lines)], key=lambda i: max(i, len(lines) - i))


def _column(ax: Axes, lines: Sequence[GapRow | str], deep: int, highest: float) -> None:
    ax.set_xscale("log")
    ax.set_xlim(LOWEST, max(highest, 3.0))
    ax.set_ylim(deep, 0)
    ticks = [t for t in (1, 2, 5, 10, 20, 50, 100, 200, 500) if t <= max(highest, 3.0)]
    ax.set_xticks(ticks, [f"{t:g}" for t in ticks])
    ax.minorticks_off()
    ax.spines["left"].set_visible(False)
    ax.grid(visible=False, axis="y")
    ax.axvline(1.0, color="black", lw=0.9, ls=(0, (4, 2)), zorder=1)
    ax.set_xlabel("whitened RMS of model − measured, 1 = noise")
    places = [i + 0.5 for i, line in enumerate(lines)]
    ax.set_yticks(places, [_name(line) for line in lines])
    ax.tick_params(axis="y", length=0, labelsize=6.5)
    for text, line, y in zip(ax.get_yticklabels(), lines, places, strict=True):
        if isinstance(line, str):
            text.set_fontweight("bold")
        else:
            _row(ax, y, line.gap)


def _name(line: GapRow | str) -> str:
    if isinstance(line, str):
        return line
    return response_name(line.response) if line.response else "all responses"


def _row(ax: Axes, y: float, gap: Gap) -> None:
    known = {m: float(getattr(gap, m)) for m in MODELS if np.isfinite(getattr(gap, m))}
    ax.plot([min(known.values()), max(known.values())], [y, y], color="#C9CED3", lw=1.0, zorder=2)
    for model, value in known.items():
        face = "white" if model == "tuned" else COLOURS[model]
        ax.plot(
            [max(value, LOWEST)], [y], MARKS[model], color=COLOURS[model], mfc=face, ms=4.2, mew=1.2,
            zorder=3 + list(MODELS).index(model) % 3,
        )  # fmt: skip


def _legend(fig: Figure, whole: Gap) -> None:
    handles = [
        Line2D([], [], color=COLOURS[m], ls="", marker=MARKS[m], ms=4.5, mew=1.2, label=_label(m),
               mfc="white" if m == "tuned" else COLOURS[m])
        for m in MODELS if np.isfinite(getattr(whole, m))
    ]  # fmt: skip
    handles.append(Line2D([], [], color="black", ls="--", lw=0.9, label="noise floor"))
    fig.legend(handles=handles, loc="lower center", ncols=5, fontsize=7, frameon=False)


def _label(model: str) -> str:
    words = {"tuned": "re-tuned without an effect", "with_effect": "re-tuned with the effect"}
    return words.get(model, MODELS[model] if model != "best_decoy" else "with the best other effect (decoy)")
