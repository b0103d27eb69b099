"""The tables of a tolerance study: characteristics, contributions, what to tighten, scatter, bands."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from doe_kc.characteristics import Characteristic
from doe_kc.ground.numbers import at_sd, number
from doe_kc.load_cases import case_label
from doe_kc.production_scatter.result import CharacteristicScatter, MeasuredCar, Tolerance
from doe_kc.production_scatter.statistics import PERCENTILES, CarShare
from doe_kc.production_scatter.tightening import Tightening
from doe_kc.reports.characteristic_columns import CHARACTERISTIC_COLUMNS
from doe_kc.reports.table import (
    Bar,
    Column,
    PageCell,
    PageLayout,
    SheetLayout,
    Table,
    TerminalCell,
    row_digits,
    three_digits,
)
from doe_kc.reports.tolerance.words import ranked_tightenings, share_words

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
        first=("name", "load_case", "unit", "outside", "nominal", "mean", "sd"),
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
    yield Column(f"{key}_percent", "Cars below it, %", lambda s: place(s)[1], "0.0", 12,
                 json=f"{key}_percent", page=PageCell("cars below it, %", layout=".1f"))  # fmt: skip


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

    def missed(t: Tightening) -> float:
        return t.missed if some else math.nan

    def gain(t: Tightening) -> float:
        return now.share - t.any_outside.share if some else math.nan

    columns: tuple[Column[Tightening], ...] = (
        Column("path", "Path", lambda t: t.scatter.parameter.path, width=14, json="path",
               page=PageCell("Code", style="first")),
        Column("parameter", "Parameter", lambda t: t.scatter.parameter.label, width=46,
               page=PageCell(style="wide")),
        Column("unit", "Unit", lambda t: t.scatter.parameter.unit, width=8, json="unit", page=PageCell()),
        Column("sd", "Scatter now, sd", lambda t: t.scatter.sd, lambda t: three_digits(t.scatter.sd),
               json="sd", page=PageCell("Scatter, sd", digits=3)),
        Column("outside_now", "Cars outside now", lambda t: share(now), "0.0%", json="outside_now"),
        Column("outside_halved", "Outside with half the scatter", lambda t: share(t.any_outside), "0.0%", 12,
               json="outside_halved",
               page=PageCell("Cars outside, halved (95 % interval)",
                             text=lambda t: share_words(t.any_outside) if some else "–")),
        Column("gain", "Gain", gain, "0.0%", json="gain",
               page=PageCell("Gain, points", text=lambda t: f"{100.0 * gain(t):.1f}" if some else "–",
                             order=gain, strong=lambda t: True)),
        Column("outside_doubled", "Outside with twice the scatter", lambda t: share(t.doubled), "0.0%", 12,
               json="outside_doubled",
               page=PageCell("doubled", text=lambda t: _percent_words(share(t.doubled)))),
        Column("missed_halved", "Requirements that a car misses, halved", missed, "0.00", 14,
               json="missed_halved",
               page=PageCell(f"Missed by a car, halved (now {tolerance.missed:.2f})", layout=".2f")),
        Column("characteristic", "Gains most", lambda t: entry(t).id, width=30, json="characteristic",
               page=PageCell(text=lambda t: f"{case_label(entry(t).load_case)}: {entry(t).label}",
                             style="wrap")),
        Column("sd_reduction", "Off its sd, halved", lambda t: 1.0 - float(t.sd_ratio[best(t)]), "0.0%", 12,
               json="sd_reduction", page=PageCell("off its sd, halved", layout=".1%")),
        Column("sd_slope", "Its sd per unit of scatter", lambda t: float(t.sd_slope[best(t)]),
               lambda t: three_digits(float(t.sd_slope[best(t)])), 14, json="sd_slope",
               page=PageCell("its sd per unit of scatter",
                             text=lambda t: f"{number(float(t.sd_slope[best(t)]))} {entry(t).unit} per "
                                            f"{t.scatter.parameter.unit.replace('-', '1')}",
                             order=lambda t: float(t.sd_slope[best(t)]))),
    )  # fmt: skip
    rows = ranked_tightenings(tolerance) if ranked else list(tolerance.tightenings)
    return Table(
        "Tightening",
        "The same cars with the scatter of one parameter halved or doubled, by first order on top of what "
        "the true solver gave. Outside: beyond any requirement.",
        columns,
        rows,
        title="What to tighten",
        colors=(Bar("gain", "5AA5DC"),) if some else (),
        sheet=SheetLayout(frozen="unit", single=True),
        page=PageLayout("tightening", "What to tighten", filtered=True),
    )


def car_columns(tolerance: Tolerance) -> pd.DataFrame:
    """One row a car: its deviations in the parameters' units, by path, and its characteristics."""
    import pandas as pd

    deviations = pd.DataFrame(tolerance.deviations, columns=[f"deviation.{p}" for p in tolerance.model.paths])
    values = pd.DataFrame(tolerance.values, columns=[c.id for c in tolerance.characteristics])
    return pd.concat([deviations, values], axis=1)
