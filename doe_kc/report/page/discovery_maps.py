"""Where model and records disagree, as coloured tables."""

from __future__ import annotations

from typing import Any

from matplotlib.colors import LogNorm, to_hex

from doe_kc.discovery.result import Discovery
from doe_kc.report.discovery_grid import GridCell, MapGrid, discovery_grids
from doe_kc.report.discovery_heat_map import (
    DISAGREEMENT_MAP,
    QUIET_COLOUR,
    beyond_words,
    shape_words,
    signed,
)
from doe_kc.report.discovery_words import contrast_words
from doe_kc.report.names import case_label, response_name
from doe_kc.report.render.page import Section, render

MAPS_LEAD = (
    "The largest disagreement of each load case and response in standard deviations of the noise, and its "
    "shape. +: the model's value is above the measured one; grey: within the noise; L−R: the wheels disagree "
    "in opposite ways. After re-tuning, only what no re-tuning within production scatter can absorb counts."
)
DARK = 0.6
"""Place on the colour scale from which white text is read better."""


def maps_section(discovery: Discovery) -> Section:
    """One table a map, the same colours in all."""
    grids = discovery_grids(discovery)
    largest = max((abs(c.z) for g in grids for c in g.cells.values()), default=1.0)
    norm = LogNorm(min(g.threshold for g in grids), max(largest, 10.0 * grids[0].threshold))
    html = render("discovery_maps.html", maps=[_map(g, norm) for g in grids])
    return Section("Where they disagree", html, MAPS_LEAD)


def _map(grid: MapGrid, norm: LogNorm) -> dict[str, Any]:
    return {
        "title": grid.title,
        "words": beyond_words(grid),
        "threshold": grid.threshold,
        "heads": [response_name(r) for r in grid.responses],
        "rows": [
            (case_label(case), [_cell(grid, grid.cells.get((case, r)), norm) for r in grid.responses])
            for case in grid.cases
        ],
    }


def _cell(grid: MapGrid, cell: GridCell | None, norm: LogNorm) -> dict[str, str] | None:
    if cell is None:
        return None
    quiet = abs(cell.z) <= grid.threshold
    place = float(norm(abs(cell.z)))
    return {
        "z": signed(cell.z),
        "shape": shape_words(cell),
        "title": f"{contrast_words(cell.contrast)}: {signed(cell.z)} standard deviations",
        "back": QUIET_COLOUR if quiet else to_hex(DISAGREEMENT_MAP(place)),
        "ink": "#5b6670" if quiet else "#ffffff" if place > DARK else "#000000",
    }
