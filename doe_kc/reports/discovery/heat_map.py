"""Where model and records disagree: load case by response, before, after re-tuning, with the effect."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.collections import PolyCollection
from matplotlib.colors import LinearSegmentedColormap, LogNorm
from matplotlib.typing import ColorType

from doe_kc.curves import RIG_RESPONSES, response_name
from doe_kc.discovery.result import Discovery
from doe_kc.discovery.screening.contrasts import Contrast
from doe_kc.discovery.screening.disagreement import Map
from doe_kc.load_cases import CASE_ORDER, case_label
from doe_kc.reports.discovery.words import model_head
from doe_kc.reports.drawing.color_scale import STRIPS, draw_color_scale, outline
from doe_kc.reports.drawing.panel import PageBox, Panel
from doe_kc.reports.drawing.sheet import Sheet, sheet
from doe_kc.reports.drawing.words import POINTS

CASES = ("static", *CASE_ORDER)


@dataclass(frozen=True)
class GridCell:
    """The contrast with the largest |z| of one load case and response; z keeps its sign."""

    contrast: Contrast
    z: float


@dataclass(frozen=True)
class MapGrid:
    """One map: what it is of, its cells, and the largest |z| that noise alone passes in 5 % of maps."""

    title: str
    threshold: float
    cells: dict[tuple[str, str], GridCell]

    @property
    def cases(self) -> list[str]:
        """Load cases that have a cell, static first."""
        present = {case for case, _ in self.cells}
        return [c for c in CASES if c in present]

    @property
    def responses(self) -> list[str]:
        """Responses that have a cell."""
        present = {response for _, response in self.cells}
        return [r for r in RIG_RESPONSES if r in present]

    @property
    def beyond(self) -> int:
        """Cells that noise alone does not explain."""
        return sum(abs(c.z) > self.threshold for c in self.cells.values())


def map_grid(title: str, disagreement: Map) -> MapGrid:
    """Largest |z| over shapes and wheels; what re-tuning absorbs wholly is left out."""
    cells: dict[tuple[str, str], GridCell] = {}
    for contrast, z in zip(disagreement.names, disagreement.z, strict=True):
        key = (contrast.load_case, contrast.response)
        if np.isfinite(z) and (key not in cells or abs(z) > abs(cells[key].z)):
            cells[key] = GridCell(contrast, float(z))
    return MapGrid(title, disagreement.threshold, cells)


def discovery_grids(discovery: Discovery) -> list[MapGrid]:
    """Nominal, re-tuned and, where there is any, with the effects."""
    grids = [
        map_grid(model_head("nominal"), discovery.nominal_map),
        map_grid(model_head("tuned"), discovery.tuned_map),
    ]
    if discovery.fitted.model.members:
        grids.append(map_grid(model_head("with_effect"), discovery.residual_map))
    return grids


DISAGREEMENT_MAP = LinearSegmentedColormap.from_list(
    "disagreement", ["#FFF3DC", "#F2A23C", "#D55E00", "#6B1F00"]
)
"""One hue from light to dark: told apart by the colour-blind and in grey."""
QUIET_COLOUR = "#EEF1F3"
ABSORBED_COLOUR = "white"
CELL = (0.92, 0.36)
"""Width and height, inches."""
MAP_LEFT, MAP_RIGHT, MAP_TOP, MAP_BOTTOM, MAP_GAP = 1.75, 0.3, 0.75, 1.45, 0.62
COLUMN_WORDS = {"static": "angle"}
DISAGREEMENT_TICKS = (5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000)
MAP_SIGNS = (
    "+: the model's value is above the measured one. Grey: within the noise. L−R: the wheels disagree in "
    "opposite ways."
)
MAP_RETUNED = (
    "After re-tuning, only what no re-tuning within production scatter can absorb is shown, against the "
    "smaller noise that is left of it:",
    "its numbers do not compare with those of the first map.",
)
"""What every reader of the maps must know; the second in the lines of the picture."""


def heat_map_figure(grids: Sequence[MapGrid], study: str) -> Sheet:
    """One panel a map, one colour scale for all; grey cells are noise, empty ones not measured."""
    cases = max((g.cases for g in grids), key=len)
    responses = max((g.responses for g in grids), key=len)
    deep = CELL[1] * len(cases)
    width = MAP_LEFT + CELL[0] * len(responses) + MAP_RIGHT
    height = MAP_TOP + len(grids) * deep + (len(grids) - 1) * MAP_GAP + MAP_BOTTOM
    margins = {"left": MAP_LEFT / width, "right": 1 - MAP_RIGHT / width, "top": 1 - MAP_TOP / height}
    margins |= {"bottom": MAP_BOTTOM / height, "hspace": MAP_GAP / deep}
    page, panels = sheet(len(grids), 1, size=(width, height), margins=margins)
    norm = LogNorm(min(g.threshold for g in grids), max(_largest(grids), 10.0 * grids[0].threshold))
    for panel, grid in zip(panels[:, 0], grids, strict=True):
        _panel(panel, grid, cases, responses, norm)
    _scale(page, norm)
    page.set_heading(f"Disagreement of model and records: {study}", 1 - 0.12 / height)
    return page


def _largest(grids: Sequence[MapGrid]) -> float:
    return max((abs(c.z) for g in grids for c in g.cells.values()), default=1.0)


def _panel(
    panel: Panel, grid: MapGrid, cases: Sequence[str], responses: Sequence[str], norm: LogNorm
) -> None:
    panel.x.set_limits(0, len(responses))
    panel.y.set_limits(len(cases), 0)
    panel.spines = dict.fromkeys(panel.spines, False)
    panel.grid, panel.marks = dict.fromkeys(panel.grid, False), dict.fromkeys(panel.marks, False)
    panel.numbers["x"] = True
    panel.x.set_ticks(np.arange(len(responses)) + 0.5, [response_name(r).capitalize() for r in responses])
    panel.y.set_ticks(np.arange(len(cases)) + 0.5, [case_label(c) for c in cases])
    corners, colors = [], []
    for i, case in enumerate(cases):
        for j, response in enumerate(responses):
            cell = grid.cells.get((case, response))
            corners.append([(j, i), (j + 1, i), (j + 1, i + 1), (j, i + 1)])
            colors.append(_cell(panel, j, i, cell, grid.threshold, norm))
    panel.add(PolyCollection(corners, facecolors=colors, edgecolors="white", linewidths=1.5))
    panel.set_title(f"{grid.title}: {beyond_words(grid)}", weight="bold", across="left")


def _cell(panel: Panel, x: int, y: int, cell: GridCell | None, threshold: float, norm: LogNorm) -> ColorType:
    """The colour of a cell, whose words are written."""
    if cell is None:
        return ABSORBED_COLOUR
    quiet = abs(cell.z) <= threshold
    ink = "#6B757E" if quiet else "white" if float(norm(abs(cell.z))) > 0.6 else "black"
    for down, size, word in ((0.36, 7.5, signed(cell.z)), (0.74, 6.0, shape_words(cell))):
        panel.text(x + 0.5, y + down, word, size=size, across="center", along="center", color=ink)
    return QUIET_COLOUR if quiet else DISAGREEMENT_MAP(norm(abs(cell.z)))


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
    shape = COLUMN_WORDS.get(cell.contrast.shape, cell.contrast.shape)
    return shape if cell.contrast.wheels == "both" else f"{shape}, L−R"


def _scale(page: Sheet, norm: LogNorm) -> None:
    low, high = float(norm.vmin or 1.0), float(norm.vmax or 10.0)
    box = PageBox(
        MAP_LEFT * POINTS, 0.95 * POINTS, page.width - (MAP_LEFT + MAP_RIGHT) * POINTS, 0.13 * POINTS
    )
    panel = page.add_panel(box)
    panel.x.set_logarithmic()
    draw_color_scale(
        panel, np.geomspace(low, high, STRIPS + 1), DISAGREEMENT_MAP(np.linspace(0.0, 1.0, STRIPS))
    )
    outline(panel)
    ticks = [t for t in DISAGREEMENT_TICKS if low <= t <= high]
    panel.x.set_ticks(ticks, [f"{t:g}" for t in ticks])
    panel.number_size["x"] = 6.5
    panel.set_labels("largest disagreement over shapes and wheels, times its noise", None, 7.0)
    note = "\n".join((MAP_SIGNS, *MAP_RETUNED))
    page.write(0.02, 0.08 * POINTS / page.height, note, 6.5, along="bottom", color="#555555")
