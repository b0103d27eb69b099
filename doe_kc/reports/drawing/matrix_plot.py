"""An influence matrix as a heat map on Matplotlib axes, for notebooks and for pictures side by side."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from doe_kc.reports.influence.figures import ANNOTATE, CELL_HEIGHT, CELL_WIDTH, diverging

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes


def matrix_size(frame: pd.DataFrame) -> tuple[float, float]:
    """Inches of a figure with one heat map."""
    rows, columns = frame.shape
    return max(6.0, 2.6 + CELL_WIDTH * columns), max(3.6, 2.4 + CELL_HEIGHT * rows)


def draw_matrix_plot(
    ax: Axes, frame: pd.DataFrame, title: str, *, scale: bool = True, full: float = 100.0
) -> None:
    """Blue negative, orange positive, colours from -full to full, numbers from 5 on; nan is grey.

    scale: with the colour scale beside it.
    """
    rows, columns = frame.shape
    values = frame.to_numpy(dtype=float)
    ax.set_facecolor("#D9DCDF")
    mesh = ax.pcolormesh(
        np.ma.masked_invalid(values),
        cmap=diverging(),
        vmin=-full,
        vmax=full,
        edgecolors="#E3E6E9",
        lw=0.3,
    )
    for i, j in np.argwhere(np.abs(np.nan_to_num(values)) >= ANNOTATE):
        number = ax.text(j + 0.5, i + 0.5, f"{values[i, j]:.0f}", ha="center", va="center", fontsize=5.5)
        number.set_in_layout(False)
    ax.set_xticks(np.arange(columns) + 0.5, list(frame.columns), rotation=90, fontsize=7)
    ax.set_yticks(np.arange(rows) + 0.5, list(frame.index), fontsize=7)
    ax.tick_params(length=0)
    ax.invert_yaxis()
    ax.set_title(title, fontsize="medium")
    if scale:
        ax.figure.colorbar(mesh, ax=ax, shrink=0.5, label="percent of the column's largest")
