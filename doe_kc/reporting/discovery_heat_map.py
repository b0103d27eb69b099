"""Where model and records disagree: load case by response, before, after re-tuning, with the effect."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import LinearSegmentedColormap, LogNorm
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from doe_kc.reporting import style
from doe_kc.reporting.discovery_grid import GridCell, MapGrid
from doe_kc.reporting.names import case_label, response_name

COLOURS = LinearSegmentedColormap.from_list("disagreement", ["#FFF3DC", "#F2A23C", "#D55E00", "#6B1F00"])
"""One hue from light to dark: told apart by the colour-blind and in grey."""
QUIET = "#EEF1F3"
ABSORBED = "white"
CELL = (0.92, 0.36)
"""Width and height, inches."""
LEFT, RIGHT, TOP, BOTTOM, BETWEEN = 1.75, 0.3, 0.75, 1.45, 0.62
SHORT = {"static": "angle"}
TICKS = (5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000)
NOTE = (
    "+: the model's value is above the measured one. Grey: within the noise. L−R: the wheels disagree in "
    "opposite ways.\nAfter re-tuning, only what no re-tuning within production scatter can absorb is shown."
)


def heat_map_figure(grids: Sequence[MapGrid], study: str) -> Figure:
    """One panel a map, one colour scale for all; grey cells are noise, empty ones not measured."""
    cases = max((g.cases for g in grids), key=len)
    responses = max((g.responses for g in grids), key=len)
    deep = CELL[1] * len(cases)
    width = LEFT + CELL[0] * len(responses) + RIGHT
    height = TOP + len(grids) * deep + (len(grids) - 1) * BETWEEN + BOTTOM
    margins = {"left": LEFT / width, "right": 1 - RIGHT / width, "top": 1 - TOP / height}
    margins |= {"bottom": BOTTOM / height, "hspace": BETWEEN / deep}
    fig, axes = style.figure(len(grids), 1, size=(width, height), margins=margins)
    norm = LogNorm(min(g.threshold for g in grids), max(_largest(grids), 10.0 * grids[0].threshold))
    for ax, grid in zip(axes[:, 0], grids, strict=True):
        _panel(ax, grid, cases, responses, norm)
    _scale(fig, norm, width, height)
    title = f"Disagreement of model and records: {study}"
    fig.suptitle(title, fontsize=11, y=1 - 0.12 / height, va="top", parse_math=False)
    return fig


def _largest(grids: Sequence[MapGrid]) -> float:
    return max((abs(c.z) for g in grids for c in g.cells.values()), default=1.0)


def _panel(ax: Axes, grid: MapGrid, cases: Sequence[str], responses: Sequence[str], norm: LogNorm) -> None:
    ax.set_xlim(0, len(responses))
    ax.set_ylim(len(cases), 0)
    ax.grid(visible=False)
    ax.spines[:].set_visible(False)
    ax.tick_params(length=0, labelbottom=True)
    ax.set_xticks(np.arange(len(responses)) + 0.5, [response_name(r).capitalize() for r in responses])
    ax.set_yticks(np.arange(len(cases)) + 0.5, [case_label(c) for c in cases])
    for i, case in enumerate(cases):
        for j, response in enumerate(responses):
            cell = grid.cells.get((case, response))
            _cell(ax, j, i, cell, grid.threshold, norm)
    words = (
        "noise alone explains all" if not grid.beyond else f"{grid.beyond} of {len(grid.cells)} beyond noise"
    )
    ax.set_title(f"{grid.title}: {words}", loc="left", fontsize=9, fontweight="bold")


def _cell(ax: Axes, x: int, y: int, cell: GridCell | None, threshold: float, norm: LogNorm) -> None:
    quiet = cell is None or abs(cell.z) <= threshold
    colour = ABSORBED if cell is None else QUIET if quiet else COLOURS(norm(abs(cell.z)))
    ax.add_patch(Rectangle((x, y), 1, 1, fc=colour, ec="white", lw=1.5))
    if cell is None:
        return
    ink = "#6B757E" if quiet else "white" if float(norm(abs(cell.z))) > 0.6 else "black"
    size = signed(cell.z)
    ax.text(x + 0.5, y + 0.36, size, ha="center", va="center", fontsize=7.5, color=ink)
    ax.text(x + 0.5, y + 0.74, shape_words(cell), ha="center", va="center", fontsize=6, color=ink)


def beyond_words(grid: MapGrid) -> str:
    """How much of a map noise does not explain."""
    if not grid.beyond:
        return "noise alone explains all"
    return f"{grid.beyond} of {len(grid.cells)} beyond noise"


def signed(z: float) -> str:
    """A statistic with its sign."""
    return (f"{z:+.1f}" if abs(z) < 9.95 else f"{z:+.0f}").replace("-", "−")


def shape_words(cell: GridCell) -> str:
    """Shape, with a mark where it is the difference of the wheels."""
    shape = SHORT.get(cell.contrast.shape, cell.contrast.shape)
    return shape if cell.contrast.wheels == "both" else f"{shape}, L−R"


def _scale(fig: Figure, norm: LogNorm, width: float, height: float) -> None:
    inside = (LEFT / width, 0.95 / height, 1 - (LEFT + RIGHT) / width, 0.13 / height)
    bar = fig.colorbar(ScalarMappable(norm, COLOURS), cax=fig.add_axes(inside), orientation="horizontal")
    ticks = [t for t in TICKS if norm.vmin is not None and norm.vmin <= t <= (norm.vmax or t)]
    bar.set_ticks(ticks, labels=[f"{t:g}" for t in ticks], minor=False)
    bar.minorticks_off()
    bar.set_label("largest |z| over shapes and wheels, standard deviations of the noise", fontsize=7)
    bar.ax.tick_params(labelsize=6.5)
    fig.text(0.02, 0.08 / height, NOTE, fontsize=6.5, color="#555555", va="bottom")
