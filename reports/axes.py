"""Figures of the published reports: Matplotlib's own axes and layout, as they are few and drawn once."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from numpy.typing import NDArray

from doe_kc.ground.typing import FloatArray
from doe_kc.reports.drawing.style import A4, COLOUR_CYCLE, DPI
from doe_kc.reports.influence.figures import ANNOTATE, LINE_COLOUR, diverging

RC: Mapping[str, object] = {
    "font.size": 8.0,
    "axes.titlesize": 9.0,
    "axes.labelsize": 8.0,
    "xtick.labelsize": 7.0,
    "ytick.labelsize": 7.0,
    "legend.fontsize": 7.0,
    "legend.frameon": False,
    "axes.grid": True,
    "axes.axisbelow": True,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "grid.color": "#DDDDDD",
    "grid.linewidth": 0.5,
    "lines.linewidth": 1.2,
}


def figure(
    rows: int,
    columns: int,
    *,
    size: tuple[float, float] = A4,
    width_ratios: Sequence[float] | None = None,
    share_x: bool = True,
    margins: Mapping[str, float] | None = None,
) -> tuple[Figure, NDArray[Any]]:
    """A figure and its (rows, columns) axes in the product's style, laid out so that nothing is cut off.

    size: inches. share_x: one horizontal axis for all panels. margins: of `subplots_adjust`, for equal
        panels that need no solver for their layout, which takes longer than drawing them.
    """
    with rc_context(dict(RC)):  # type: ignore[arg-type]  # matplotlib types the keys as literals
        fig = Figure(figsize=size, dpi=DPI, layout="constrained" if margins is None else None)
        if margins is not None:
            fig.subplots_adjust(**margins)
        FigureCanvasAgg(fig)
        axes = fig.subplots(rows, columns, squeeze=False, sharex=share_x, width_ratios=width_ratios)
    for ax in axes.flat:
        ax.set_prop_cycle(color=COLOUR_CYCLE)
    return fig, axes


def label(ax: Axes, x: str | None, y: str | None) -> None:
    """Axis labels; None leaves one out."""
    if x is not None:
        ax.set_xlabel(x)
    if y is not None:
        ax.set_ylabel(y)


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
            j + 0.5, i + 0.5, f"{values[i, j]:.0f}", fontsize=5.5, color=LINE_COLOUR, ha="center", va="center"
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
