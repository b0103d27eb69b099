"""The tables of what was assumed of the parameters, and of the bands of the curves."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from doe_kc.curves import RESPONSE_UNITS, SIDE_WORDS, SIDES, response_name
from doe_kc.ground.typing import FloatArray
from doe_kc.load_cases import case_label
from doe_kc.production_scatter.bands import CurveBand
from doe_kc.production_scatter.model import Scatter
from doe_kc.production_scatter.result import MeasuredCar, Tolerance
from doe_kc.reports.table import Column, PageCell, PageLayout, SheetLayout, Table, Value, three_digits


def scatter_table(tolerance: Tolerance) -> Table[Scatter]:
    """One row a parameter: nominal value, standard deviation, distribution, how alike its sides are."""

    def alike(s: Scatter) -> Value:
        return s.common if s.both_sides else None

    columns: tuple[Column[Scatter], ...] = (
        Column("path", "Path", lambda s: s.parameter.path, width=14, page=PageCell("Code", style="first")),
        Column("parameter", "Parameter", lambda s: s.parameter.label, width=50, page=PageCell(style="wrap")),
        Column("unit", "Unit", lambda s: s.parameter.unit, width=8, page=PageCell()),
        Column("nominal", "Nominal", lambda s: s.parameter.nominal, "0.000", page=PageCell()),
        Column("sd", "Standard deviation", lambda s: s.sd, lambda s: three_digits(s.sd), 12,
               page=PageCell("sd", digits=3)),
        Column("distribution", "Distribution", lambda s: s.law.id, width=18, words=lambda s: s.law.label,
               page=PageCell()),
        Column("reach", "Largest deviation", lambda s: s.reach if math.isfinite(s.reach) else None,
               "0.000", 12, page=PageCell(digits=3)),
        Column("common", "Variance that the sides share", alike, "0%", 14,
               page=PageCell(text=lambda s: f"{100.0 * s.common:.0f} %" if s.both_sides else "one value")),
    )  # fmt: skip
    return Table("Scatter", "What was assumed of each parameter; correlations are in the study.", columns,
                 tolerance.model.scatters, title="Scatter of the parameters",
                 sheet=SheetLayout(frozen="unit", single=True),
                 page=PageLayout("scatter", "Scatter of the parameters", filtered=True))  # fmt: skip


@dataclass(frozen=True)
class BandRow:
    """One curve of one wheel. width: largest distance of the outer percentiles; at: input there. inside: name
    of each measured car -> share of its points within them, nan where it has none."""

    band: CurveBand
    response: str
    side: int
    width: float
    at: float
    inside: dict[str, float]


def band_rows(tolerance: Tolerance) -> list[BandRow]:
    """Of every load case, response and side."""
    out = []
    for band in tolerance.bands:
        for response, rows in band.percentiles.items():
            inside = {c.name: _inside(band, c, response) for c in tolerance.cars}
            for side in (0, 1):
                width = rows[-1, side] - rows[0, side]
                k = int(np.argmax(width))
                own = {name: float(share[side]) for name, share in inside.items()}
                out.append(BandRow(band, response, side, float(width[k]), float(band.input[k]), own))
    return out


def _inside(band: CurveBand, car: MeasuredCar, response: str) -> FloatArray:
    case = car.curves.cases.get(band.load_case)
    if case is None or response not in case.mean or case.input_unit != band.input_unit:
        return np.full(2, math.nan)
    return band.inside(case, response)


def band_table(tolerance: Tolerance) -> Table[BandRow]:
    """One row a curve and wheel: how wide the band of 95 % of the cars is, and how much of each measured
    car's curve lies in it."""

    def inside(car: MeasuredCar) -> Column[BandRow]:
        return Column(f"inside_{car.name}", f"Within it: {car.name}", lambda r: r.inside[car.name], "0%", 14,
                      page=PageCell(f"Within it: {car.name}", layout=".0%"))  # fmt: skip

    columns: tuple[Column[BandRow], ...] = (
        Column("load_case", "Load case", lambda r: r.band.load_case, width=26,
               words=lambda r: case_label(r.band.load_case), page=PageCell(style="first")),
        Column("response", "Response", lambda r: r.response, width=20,
               words=lambda r: response_name(r.response), page=PageCell()),
        Column("side", "Side", lambda r: SIDES[r.side], width=8, words=lambda r: SIDE_WORDS[SIDES[r.side]],
               page=PageCell()),
        Column("unit", "Unit", lambda r: RESPONSE_UNITS[r.response], width=8, page=PageCell()),
        Column("width", "Width of the band", lambda r: r.width, lambda r: three_digits(r.width), 12,
               page=PageCell("Widest, 95 % of the cars", digits=3)),
        Column("at", "at input", lambda r: r.at, "0.0", page=PageCell("at input", layout=".4g")),
        Column("input_unit", "Unit of input", lambda r: r.band.input_unit, width=10, page=PageCell("")),
        *(inside(car) for car in tolerance.cars),
    )  # fmt: skip
    return Table("Bands", "Where 95 % of the cars' curves lie at each input, at its widest.", columns,
                 band_rows(tolerance), title="Bands of the curves",
                 sheet=SheetLayout(frozen="unit", single=True),
                 page=PageLayout("bands", "Bands of the curves", filtered=True))  # fmt: skip
