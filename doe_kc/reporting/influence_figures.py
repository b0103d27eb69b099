"""Pictures of an influence study: the whole matrix as a heat map, and the ten strongest of each column."""

from __future__ import annotations

from functools import partial
from itertools import groupby
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import Colormap, LinearSegmentedColormap
from matplotlib.figure import Figure
from matplotlib.ticker import FixedFormatter

from doe_kc.characteristics import Characteristic
from doe_kc.influence.result import Influence
from doe_kc.pictures import PNG, PictureFormat
from doe_kc.reporting.names import case_label
from doe_kc.reporting.plain_axes import draw_plain_axes
from doe_kc.reporting.series import draw_series
from doe_kc.reporting.style import PALETTE, figure, label
from doe_kc.reporting.workbook_cells import NEGATIVE, NEUTRAL, POSITIVE
from doe_kc.reporting.workbook_matrix import Layout, layout
from doe_kc.typing import FloatArray

ANNOTATE = 5.0
"""Percent from which a cell shows its number."""
TOP = 10
PANELS = 3
"""Columns of small multiples."""
ROW, COLUMN = 0.165, 0.36
"""Inches of a cell of the heat map."""
LINE = PALETTE["black"]


def diverging() -> Colormap:
    """Blue, white, orange: the colours of the workbook."""
    colors = [f"#{c}" for c in (NEGATIVE, NEUTRAL, POSITIVE)]
    return LinearSegmentedColormap.from_list("influence", colors)


def influence_heat_map(influence: Influence, *, study: str) -> Figure:
    """Percent of each column's largest entry, colours fixed at -100 to 100, numbers from 5 % on."""
    at = layout(influence)
    values = np.where(np.isfinite(influence.absolute), influence.percent, np.nan)
    values = values[np.ix_(at.rows, at.columns)]
    size = (max(8.0, 3.2 + COLUMN * len(at.columns)), max(5.0, 3.0 + ROW * len(at.rows)))
    fig, axes = figure(1, 1, size=size)
    ax = axes[0, 0]
    draw_matrix(ax, values)
    ax.set_xticks(np.arange(len(at.columns)) + 0.5)
    ax.set_xticklabels([_name(influence.characteristics[j]) for j in at.columns], rotation=90)
    ax.set_yticks(np.arange(len(at.rows)) + 0.5)
    ax.set_yticklabels([influence.parameters[i].path for i in at.rows], rotation=0)
    _case_names(ax, influence, at)
    _lines(ax, influence, at)
    fig.suptitle(
        f"Parameter influence, percent of each column's largest entry: {study}", fontsize=11, parse_math=False
    )
    return fig


def draw_matrix(ax: Axes, values: FloatArray, *, bar: bool = True) -> None:
    """A percent matrix on `ax` with fixed colours and numbers from 5 % on; nan is grey."""
    mesh = ax.pcolormesh(
        np.ma.masked_invalid(values),
        vmin=-100.0,
        vmax=100.0,
        cmap=diverging(),
        linewidths=0.3,
        edgecolors="#E3E6E9",
    )
    rows, columns = values.shape
    ax.set(xlim=(0.0, columns), ylim=(rows, 0.0), xticks=[], yticks=[])
    for i, j in np.argwhere(np.abs(np.nan_to_num(values)) >= ANNOTATE):
        number = ax.text(
            j + 0.5, i + 0.5, f"{values[i, j]:.0f}", fontsize=5.5, color=LINE, ha="center", va="center"
        )
        number.set_in_layout(False)  # it lies within its cell; the layout would measure it with the rest
    if bar and ax.figure is not None:
        scale = ax.figure.colorbar(mesh, ax=ax, shrink=0.4, pad=0.01)
        scale.set_label("percent of the column's largest", fontsize=8)
        scale.ax.tick_params(labelsize=7)
        scale.outline.set_linewidth(0.0)
    for spine in ax.spines.values():
        spine.set_visible(False)
    ax.set_facecolor("#D9DCDF")
    ax.grid(visible=False)
    ax.tick_params(length=0)


def _name(entry: Characteristic) -> str:
    return f"{entry.label} [{entry.unit}]"


def _case_names(ax: Axes, influence: Influence, at: Layout) -> None:
    cases = [influence.characteristics[j].load_case for j in at.columns]
    start = 0
    for case, members in groupby(cases):
        count = len(list(members))
        words = case_label(case).replace(" ", "\n") if count < 3 else case_label(case).replace(", ", ",\n")
        ax.text(start + count / 2, -0.6, words, ha="center", va="bottom", fontsize=7)
        start += count


def _lines(ax: Axes, influence: Influence, at: Layout) -> None:
    cases = [influence.characteristics[j].load_case for j in at.columns]
    groups = [influence.parameters[i].group for i in at.rows]
    for k in range(1, len(cases)):
        if cases[k] != cases[k - 1]:
            ax.axvline(k, color=LINE, lw=0.9)
    for k in range(1, len(groups)):
        if groups[k] != groups[k - 1]:
            ax.axhline(k, color=LINE, lw=0.9)


def influence_bars(influence: Influence, *, study: str) -> Figure:
    """The ten strongest parameters of each characteristic, signed; one small panel each."""
    at = layout(influence)
    rows = -(-len(at.columns) // PANELS)
    height = 0.8 + 1.85 * rows
    margins = {"left": 0.1, "right": 0.985, "wspace": 0.45, "hspace": 0.42}
    margins |= {"bottom": 0.5 / height, "top": 1 - 0.75 / height}
    fig, axes = figure(rows, PANELS, size=(8.27, height), margins=margins)
    for ax, j in zip(axes.flat, at.columns, strict=False):
        _bars(ax, influence, j)
    for ax in axes.flat[len(at.columns) :]:
        ax.set_visible(False)
    for k in range(max(0, len(at.columns) - PANELS), len(at.columns)):
        ax = axes.flat[k]
        ax.tick_params(labelbottom=True)
        label(ax, "percent of the largest", None)
    title = f"Strongest parameters of each characteristic: {study}"
    fig.suptitle(title, y=1 - 0.1 / height, va="top", fontsize=11, parse_math=False)
    draw_plain_axes(fig)
    return fig


def _bars(ax: Axes, influence: Influence, j: int) -> None:
    column = influence.percent[:, j]
    strongest = np.argsort(-np.abs(column), kind="stable")[:TOP]
    strongest = strongest[np.abs(column[strongest]) >= 0.5]
    entry = influence.characteristics[j]
    values = column[strongest]
    colors = [f"#{POSITIVE if v > 0 else NEGATIVE}" for v in values]
    places = np.arange(values.size)
    ax.barh(places, values, color=colors, height=0.75)
    for y, v in zip(places, values, strict=True):
        side = "left" if v > 0 else "right"
        ax.annotate(
            f"{v:+.0f}", (v, y), (2 if v > 0 else -2, 0), textcoords="offset points", ha=side,
            va="center", fontsize=5.5,
        )  # fmt: skip
    ax.axvline(0.0, color=LINE, lw=0.6)
    ax.set_xlim(-128.0, 128.0)
    ax.set_ylim(TOP - 0.4, -0.6)
    ax.set_yticks(places)
    ax.yaxis.set_major_formatter(FixedFormatter([influence.parameters[i].path for i in strongest]))
    ax.tick_params(axis="y", labelsize=6)
    ax.set_title(f"{case_label(entry.load_case)}\n{entry.label}", fontsize=7.5, y=1.0)


def write_influence_figures(
    influence: Influence,
    folder: Path,
    *,
    study: str,
    workers: int | None = None,
    pictures: PictureFormat = PNG,
) -> list[Path]:
    """Pictures `influence_heat_map` and `influence_top_ten`; returns their paths.

    Raises RunError when the folder cannot be written.
    """
    jobs = [
        (folder / "influence_heat_map", partial(influence_heat_map, influence, study=study)),
        (folder / "influence_top_ten", partial(influence_bars, influence, study=study)),
    ]
    return draw_series(jobs, workers, pictures=pictures)
