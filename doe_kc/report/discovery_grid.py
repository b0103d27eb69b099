"""A map of disagreement as a grid: the largest statistic of each load case and response, and its shape."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from doe_kc.curves import RIG_RESPONSES
from doe_kc.discovery.result import Discovery
from doe_kc.discovery.screening.contrasts import Contrast
from doe_kc.discovery.screening.disagreement import Map
from doe_kc.load_cases import CASE_ORDER

CASES = ("static", *CASE_ORDER)


@dataclass(frozen=True)
class GridCell:
    """The contrast with the largest |z| of one load case and response; z keeps its sign."""

    contrast: Contrast
    z: float


@dataclass(frozen=True)
class MapGrid:
    """One map: what it is of, its cells, and the largest |z| that noise alone passes in 5 % of maps."""

    name: str
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


def map_grid(name: str, title: str, disagreement: Map) -> MapGrid:
    """Largest |z| over shapes and wheels; what re-tuning absorbs wholly is left out."""
    cells: dict[tuple[str, str], GridCell] = {}
    for contrast, z in zip(disagreement.names, disagreement.z, strict=True):
        key = (contrast.load_case, contrast.response)
        if np.isfinite(z) and (key not in cells or abs(z) > abs(cells[key].z)):
            cells[key] = GridCell(contrast, float(z))
    return MapGrid(name, title, disagreement.threshold, cells)


def discovery_grids(discovery: Discovery) -> list[MapGrid]:
    """Nominal, re-tuned and, where there is any, with the effects."""
    grids = [
        map_grid("nominal", "Nominal axle", discovery.nominal_map),
        map_grid("tuned", "Re-tuned without an effect", discovery.tuned_map),
    ]
    if discovery.fitted.model.members:
        grids.append(map_grid("with_effect", "Re-tuned with the effect", discovery.residual_map))
    return grids
