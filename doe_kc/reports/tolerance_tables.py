"""The tables of a tolerance study: characteristics, contributions, what to tighten, scatter, bands."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from doe_kc.characteristics import Characteristic
from doe_kc.curves import RESPONSE_UNITS, SIDE_WORDS, SIDES, response_name
from doe_kc.ground.numbers import at_sd, number
from doe_kc.ground.typing import FloatArray
from doe_kc.load_cases import case_label
from doe_kc.reports.characteristic_columns import CHARACTERISTIC_COLUMNS
from doe_kc.reports.table import (
    Bar,
    Column,
    PageCell,
    PageLayout,
    SheetLayout,
    Table,
    TerminalCell,
    Value,
    row_digits,
    three_digits,
)
from doe_kc.reports.tolerance_words import ranked_tightenings, share_words
from doe_kc.tolerance.bands import CurveBand
from doe_kc.tolerance.model import Scatter
from doe_kc.tolerance.result import CharacteristicScatter, MeasuredCar, Tolerance
from doe_kc.tolerance.statistics import PERCENTILES, CarShare
from doe_kc.tolerance.tightening import Tightening

if TYPE_CHECKING:
    import pandas as pd

OUTSIDE_COLOUR = "F2A23C"
ON_PAGE = (1.0, 99.0)
"""Percentiles that the page shows."""


def _digits(row: CharacteristicScatter) -> str:
    return row_digits(row.moments.sd, row.nominal)


def _at(row: CharacteristicScatter, value: float) -> str:
    return at_sd(value, row.moments.sd) if math.isfinite(value) else "–"


def _limit(row: CharacteristicScatter, name: str) -> float:
    value = math.nan if row.requirement is None else float(getattr(row.requirement, name))
    return value if math.isfinite(value) else math.nan


def _outside(row: CharacteristicScatter) -> float:
    return math.nan if row.outside is None else row.outside.share


def _percentile(place: int) -> Column[CharacteristicScatter]:
    p = PERCENTILES[place]

    def value(row: CharacteristicScatter) -> float:
        return row.moments.percentiles[place]

    shown = (
        PageCell[CharacteristicScatter](f"{p:g} %", text=lambda r: _at(r, value(r))) if p in ON_PAGE else None
    )
    return Column(f"p{p:g}", f"{p:g} % of the cars below", value, _digits, json=f"p{p:g}", page=shown)


SCATTER_COLUMNS: tuple[Column[CharacteristicScatter], ...] = (
    Column("characteristic", None, lambda s: s.entry.id, csv=False,
           terminal=TerminalCell("characteristic", "34")),
    Column("nominal", "Nominal", lambda s: s.nominal, _digits, json="nominal",
           page=PageCell(text=lambda s: _at(s, s.nominal)), terminal=TerminalCell("nominal", ">11", ".4g")),
    Column("mean", "Mean", lambda s: s.moments.mean, _digits, json="mean",
           page=PageCell(text=lambda s: _at(s, s.moments.mean)), terminal=TerminalCell("mean", ">11", ".4g")),
    Column("sd", "Standard deviation", lambda s: s.moments.sd, _digits, json="sd",
           page=PageCell("sd", digits=3, strong=lambda s: True), terminal=TerminalCell("sd", ">10", ".3g")),
    Column("sd_error", "Its standard error", lambda s: s.moments.sd_error, _digits, json="sd_error"),
    Column("first_order_sd", "By slopes alone", lambda s: s.first_order_sd, _digits, json="first_order_sd",
           page=PageCell("sd by slopes", digits=3), terminal=TerminalCell("by slopes", ">10", ".3g")),
    Column("explained", "Variance that slopes explain", lambda s: s.explained, "0.0%", json="explained",
           page=PageCell("explained by slopes", layout=".1%",
                         attributes=lambda s: {"class": "" if s.linear else "flag"})),
    Column("linear", "Linear", lambda s: s.linear, json="linear"),
    Column("skewness", "Skewness", lambda s: s.moments.skewness, "0.00", json="skewness",
           page=PageCell(layout=".2f")),
    *(_percentile(k) for k in range(len(PERCENTILES))),
    Column("low", "Low", lambda s: _limit(s, "low"), _digits, json="low",
           page=PageCell(text=lambda s: _at(s, _limit(s, "low")))),
    Column("high", "High", lambda s: _limit(s, "high"), _digits, json="high",
           page=PageCell(text=lambda s: _at(s, _limit(s, "high")))),
    Column("outside", "Cars outside", _outside, "0.0%", json="outside",
           page=PageCell("Cars outside (95 % interval)",
                         text=lambda s: "–" if s.outside is None else share_words(s.outside)),
           terminal=TerminalCell("outside", ">10", text=lambda s: _percent_words(_outside(s)))),
    Column("outside_low", "At least", lambda s: math.nan if s.outside is None else s.outside.low, "0.0%",
           json="outside_low"),
    Column("outside_high", "At most", lambda s: math.nan if s.outside is None else s.outside.high, "0.0%",
           json="outside_high"),
    Column("marked_unit", None, lambda s: s.entry.unit, csv=False,
           terminal=TerminalCell("  unit", text=lambda s: f"  {s.entry.unit}")),
)  # fmt: skip


def _percent_words(share: float) -> str:
    return f"{100.0 * share:.1f} %" if math.isfinite(share) else "–"


def tolerance_table(tolerance: Tolerance) -> Table[CharacteristicScatter]:
    """One row a characteristic: its scatter, how linear it is, the cars outside, where measured cars lie."""
    own = [c for car in tolerance.cars for c in _car_columns(car)]
    layout = PageLayout[CharacteristicScatter](
        "scatter-of-characteristics",
        "Scatter of characteristics",
        filtered=True,
        choices={"outside": "with cars outside only", "curved": "not linear only"},
        tags=lambda s: " ".join(
            [
                *(["outside"] if s.outside is not None and s.outside.count else []),
                *([] if s.linear else ["curved"]),
            ]
        ),
    )
    return Table(
        "Characteristics",
        f"Over {tolerance.n} cars solved by the true solver; limits of shares with 95 % confidence (Wilson). "
        f"By slopes: {tolerance.first_order.source}. Shaded: not linear over the scatter.",
        (*CHARACTERISTIC_COLUMNS, *SCATTER_COLUMNS, *own),
        tolerance.scatters,
        title="Production scatter",
        flagged=lambda s: not s.linear,
        colors=(Bar("outside", OUTSIDE_COLOUR, 1.0),),
        sheet=SheetLayout(frozen="load_case", pages_wide=2, repeat_columns="A:A"),
        page=layout,
    )


def _car_columns(car: MeasuredCar) -> Iterator[Column[CharacteristicScatter]]:
    def place(row: CharacteristicScatter) -> tuple[float, float]:
        return row.measured.get(car.name, (math.nan, math.nan))

    key = f"measured_{car.name}"
    yield Column(key, f"Measured: {car.name}", lambda s: place(s)[0], _digits, 14, json=key,
                 page=PageCell(f"Measured: {car.name}", text=lambda s: _at(s, place(s)[0])))  # fmt: skip
    yield Column(f"{key}_percent", "Cars below it, %", lambda s: place(s)[1], "0.0", 12, json=f"{key}_percent",
                 page=PageCell("cars below it, %", layout=".1f"))  # fmt: skip


@dataclass(frozen=True)
class ParameterContribution:
    """first, total: (k,) shares of one parameter in the variances of all characteristics."""

    scatter: Scatter
    first: FloatArray
    total: FloatArray


@dataclass(frozen=True)
class ContributionRow:
    """Shares of one parameter in the variance of one characteristic, both sides together, and of each side in
    that of first order (nan where it has none)."""

    scatter: Scatter
    entry: Characteristic
    first: float
    left: float
    right: float
    total: float


def contribution_rows(tolerance: Tolerance) -> list[ParameterContribution]:
    """In the order of the parameters."""
    first, total = tolerance.first_shares, tolerance.totals.shares
    return [ParameterContribution(s, first[i], total[i]) for i, s in enumerate(tolerance.model.scatters)]


def contribution_table(tolerance: Tolerance) -> Table[ContributionRow]:
    """One row a parameter and characteristic."""
    shares, owner = tolerance.first_order.shares.T, tolerance.model.owner
    rows = []
    for i, line in enumerate(contribution_rows(tolerance)):
        own = shares[owner == i]
        sides = own if len(own) == 2 else np.full((2, own.shape[1]), math.nan)
        rows += [
            ContributionRow(line.scatter, entry, *map(float, (line.first[k], *sides[:, k], line.total[k])))
            for k, entry in enumerate(tolerance.characteristics)
        ]
    columns: tuple[Column[ContributionRow], ...] = (
        Column("parameter", "Path", lambda r: r.scatter.parameter.path),
        Column("name", "Characteristic", lambda r: r.entry.id),
        Column("first_order", "First order", lambda r: r.first, "0.0%"),
        Column("first_order_left", "of the left side", lambda r: r.left, "0.0%"),
        Column("first_order_right", "of the right side", lambda r: r.right, "0.0%"),
        Column("total", "Total", lambda r: r.total, "0.0%"),
    )
    return Table("Contributions", "Shares of the variance of each characteristic.", columns, rows)


def contribution_matrix(tolerance: Tolerance, kind: str) -> Table[ParameterContribution]:
    """Parameters down, characteristics across, percent of the variance. kind: "first" or "total"."""
    words = {
        "first": ("First order", "Percent of each variance by slopes (" + tolerance.first_order.source + "); the "
                  "columns add up to 100, a negative share makes up for others that it is correlated with."),
        "total": ("Total", "Percent of each variance from the cars themselves: slopes, curvature and interactions; "
                  "an interaction counts for each of its partners."),
    }[kind]  # fmt: skip

    def column(k: int, entry: Characteristic) -> Column[ParameterContribution]:
        return Column(entry.id, f"{case_label(entry.load_case)}: {entry.label}",
                      lambda r: 100.0 * float(getattr(r, kind)[k]), "0", 5.2)  # fmt: skip

    columns = [column(k, e) for k, e in enumerate(tolerance.characteristics)]
    heads: tuple[Column[ParameterContribution], ...] = (
        Column("path", "Path", lambda r: r.scatter.parameter.path, width=12),
        Column("parameter", "Parameter", lambda r: r.scatter.parameter.label, width=36),
    )
    return Table(words[0], words[1], (*heads, *columns), contribution_rows(tolerance),
                 title=f"Contributions, {words[0].lower()}", sheet=SheetLayout(frozen=columns[0].key))  # fmt: skip


def reduction_matrix(tolerance: Tolerance) -> Table[Tightening]:
    """Parameters down, characteristics across: percent off the standard deviation with the tolerance halved."""

    def column(k: int, entry: Characteristic) -> Column[Tightening]:
        return Column(entry.id, f"{case_label(entry.load_case)}: {entry.label}",
                      lambda t: 100.0 * (1.0 - float(t.sd_ratio[k])), "0", 5.2)  # fmt: skip

    columns = [column(k, e) for k, e in enumerate(tolerance.characteristics)]
    heads: tuple[Column[Tightening], ...] = (
        Column("path", "Path", lambda t: t.scatter.parameter.path, width=12),
        Column("parameter", "Parameter", lambda t: t.scatter.parameter.label, width=36),
    )
    return Table("Reduction", "Percent off the standard deviation of each characteristic when one scatter is halved.",
                 (*heads, *columns), tolerance.tightenings, title="Halved scatter",
                 sheet=SheetLayout(frozen=columns[0].key))  # fmt: skip


def tightening_table(tolerance: Tolerance, *, ranked: bool = True) -> Table[Tightening]:
    """One row a parameter, the one that brings most first: cars outside now, halved and doubled; what gains
    most. ranked: False keeps the order of the parameters."""
    now, some = tolerance.any_outside, bool(tolerance.required)

    def share(of: CarShare) -> float:
        return of.share if some else math.nan

    def best(t: Tightening) -> int:
        return int(np.argmin(t.sd_ratio))

    def entry(t: Tightening) -> Characteristic:
        return tolerance.characteristics[best(t)]

    def gain(t: Tightening) -> float:
        return now.share - t.any_outside.share if some else math.nan

    columns: tuple[Column[Tightening], ...] = (
        Column("path", "Path", lambda t: t.scatter.parameter.path, width=14, json="path",
               page=PageCell("Code", style="first")),
        Column("parameter", "Parameter", lambda t: t.scatter.parameter.label, width=36,
               page=PageCell(style="wrap")),
        Column("unit", "Unit", lambda t: t.scatter.parameter.unit, width=8, json="unit", page=PageCell()),
        Column("sd", "Scatter now, sd", lambda t: t.scatter.sd, lambda t: three_digits(t.scatter.sd), json="sd",
               page=PageCell("Scatter, sd", digits=3)),
        Column("outside_now", "Cars outside now", lambda t: share(now), "0.0%", json="outside_now"),
        Column("outside_halved", "with half the scatter", lambda t: share(t.any_outside), "0.0%", 12,
               json="outside_halved",
               page=PageCell("Cars outside, halved (95 % interval)",
                             text=lambda t: share_words(t.any_outside) if some else "–")),
        Column("gain", "Gain", gain, "0.0%", json="gain",
               page=PageCell("Gain, points", text=lambda t: f"{100.0 * gain(t):.1f}" if some else "–",
                             order=gain, strong=lambda t: True)),
        Column("outside_doubled", "with twice the scatter", lambda t: share(t.doubled), "0.0%", 12,
               json="outside_doubled",
               page=PageCell("doubled", text=lambda t: _percent_words(share(t.doubled)))),
        Column("characteristic", "Gains most", lambda t: entry(t).id, width=30, json="characteristic",
               page=PageCell("Gains most", text=lambda t: f"{case_label(entry(t).load_case)}: {entry(t).label}")),
        Column("sd_reduction", "off its sd, halved", lambda t: 1.0 - float(t.sd_ratio[best(t)]), "0.0%", 12,
               json="sd_reduction", page=PageCell("off its sd, halved", layout=".1%")),
        Column("sd_slope", "its sd per unit of scatter", lambda t: float(t.sd_slope[best(t)]),
               lambda t: three_digits(float(t.sd_slope[best(t)])), 14, json="sd_slope",
               page=PageCell("its sd per unit of scatter",
                             text=lambda t: f"{number(float(t.sd_slope[best(t)]))} {entry(t).unit} per "
                                            f"{t.scatter.parameter.unit.replace('-', '1')}",
                             order=lambda t: float(t.sd_slope[best(t)]))),
    )  # fmt: skip
    rows = ranked_tightenings(tolerance) if ranked else list(tolerance.tightenings)
    return Table(
        "Tightening",
        "The same cars with the scatter of one parameter halved or doubled, by first order on top of what the true "
        "solver gave. Outside: beyond any requirement.",
        columns,
        rows,
        title="What to tighten",
        colors=(Bar("gain", "5AA5DC"),) if some else (),
        sheet=SheetLayout(frozen="unit", single=True),
        page=PageLayout("tightening", "What to tighten", filtered=True),
    )


def scatter_table(tolerance: Tolerance) -> Table[Scatter]:
    """One row a parameter: nominal value, standard deviation, distribution, how alike its sides are."""

    def alike(s: Scatter) -> Value:
        return s.common if s.both_sides else None

    columns: tuple[Column[Scatter], ...] = (
        Column("path", "Path", lambda s: s.parameter.path, width=14, page=PageCell("Code", style="first")),
        Column("parameter", "Parameter", lambda s: s.parameter.label, width=36, page=PageCell(style="wrap")),
        Column("unit", "Unit", lambda s: s.parameter.unit, width=8, page=PageCell()),
        Column("nominal", "Nominal", lambda s: s.parameter.nominal, "0.000", page=PageCell()),
        Column("sd", "Standard deviation", lambda s: s.sd, lambda s: three_digits(s.sd), 12,
               page=PageCell("sd", digits=3)),
        Column("distribution", "Distribution", lambda s: s.law.id, width=18, words=lambda s: s.law.label,
               page=PageCell()),
        Column("reach", "Largest deviation", lambda s: s.reach if math.isfinite(s.reach) else None, "0.000", 12,
               page=PageCell(digits=3)),
        Column("common", "Variance that the sides share", alike, "0%", 14,
               page=PageCell(text=lambda s: f"{100.0 * s.common:.0f} %" if s.both_sides else "one for the axle")),
    )  # fmt: skip
    return Table("Scatter", "What was assumed of each parameter; correlations are in the study.", columns,
                 tolerance.model.scatters, title="Scatter of the parameters",
                 sheet=SheetLayout(frozen="unit", single=True),
                 page=PageLayout("scatter", "Scatter of the parameters", filtered=True))  # fmt: skip


@dataclass(frozen=True)
class BandRow:
    """One curve of one wheel. width: largest distance of the outer percentiles; at: input there. inside: name of
    each measured car -> share of its points within them, nan where it has none."""

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
    """One row a curve and wheel: how wide the band of 95 % of the cars is, and how much of each measured car's
    curve lies in it."""

    def inside(car: MeasuredCar) -> Column[BandRow]:
        return Column(f"inside_{car.name}", f"Within it: {car.name}", lambda r: r.inside[car.name], "0%", 14,
                      page=PageCell(f"Within it: {car.name}", layout=".0%"))  # fmt: skip

    columns: tuple[Column[BandRow], ...] = (
        Column("load_case", "Load case", lambda r: r.band.load_case, width=26,
               words=lambda r: case_label(r.band.load_case), page=PageCell(style="first")),
        Column("response", "Response", lambda r: r.response, width=20, words=lambda r: response_name(r.response),
               page=PageCell()),
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
                 band_rows(tolerance), title="Bands of the curves", sheet=SheetLayout(frozen="unit", single=True),
                 page=PageLayout("bands", "Bands of the curves", filtered=True))  # fmt: skip


def car_columns(tolerance: Tolerance) -> pd.DataFrame:
    """One row a car: its deviations in the parameters' units, by path, and its characteristics."""
    import pandas as pd

    deviations = pd.DataFrame(tolerance.deviations, columns=[f"deviation.{p}" for p in tolerance.model.paths])
    values = pd.DataFrame(tolerance.values, columns=[c.id for c in tolerance.characteristics])
    return pd.concat([deviations, values], axis=1)
