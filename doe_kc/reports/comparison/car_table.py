"""The model beside several measured cars: one table for CSV, workbook, page and JSON."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from doe_kc.characteristics import CHARACTERISTICS
from doe_kc.correlation.result import Correlation
from doe_kc.ground.numbers import at_sd, number, with_sd
from doe_kc.ground.output import write_columns
from doe_kc.measurement import Measurement
from doe_kc.reports.characteristic_columns import CHARACTERISTIC_COLUMNS, by_load_case
from doe_kc.reports.render.csv import table_columns
from doe_kc.reports.render.json import table_records
from doe_kc.reports.table import Column, PageCell, PageLayout, Table, row_digits
from doe_kc.targets.comparison import CarComparison, compare_cars

UNLIKE = 0.01
"""Chance below which a model is marked: no car of its kind scatters like that."""
CAR_REMARK = (
    "Scatter: standard deviation between the cars beyond the noise of their records, with its 95 % interval. "
    "Sd of the mean: noise and scatter over the root of the number of cars, how well these cars tell all of "
    "their kind; in sd: of the mean. Chance: of such a distance or more if the model were right (Student's "
    "t); shaded below 1 %."
)


def _digits(row: CarComparison) -> str:
    return row_digits(row.figures.mean_sd, row.figures.mean)


def _text(value: float, row: CarComparison) -> str:
    return at_sd(value, row.figures.mean_sd)


CAR_COLUMNS: tuple[Column[CarComparison], ...] = (
    *(replace(c, page=None) if c.key == "response" else c for c in CHARACTERISTIC_COLUMNS),
    Column("mean", "Mean", lambda r: r.figures.mean, _digits, json="mean", page=PageCell(
        "Mean ± sd", text=lambda r: with_sd(r.figures.mean, r.figures.mean_sd), strong=lambda r: True,
        order=lambda r: r.figures.mean, style="n")),
    Column("mean_sd", "Sd of the mean", lambda r: r.figures.mean_sd, _digits, 15, json="mean_sd"),
    Column("noise_of_mean", "of which noise", lambda r: r.figures.noise_of_mean, _digits, 14,
           json="noise_of_mean"),
    Column("noise_sd", "Noise sd, one car", lambda r: r.figures.noise_sd, _digits, 16, json="noise_sd",
           page=PageCell("Noise sd", text=lambda r: _text(r.figures.noise_sd, r))),
    Column("scatter_sd", "Scatter sd, one car", lambda r: r.figures.scatter_sd, _digits, 17,
           json="scatter_sd", page=PageCell("Scatter sd", text=lambda r: _text(r.figures.scatter_sd, r))),
    Column("scatter_low", "Scatter, low", lambda r: r.figures.scatter_low, _digits, 12, json="scatter_low"),
    Column("scatter_high", "Scatter, high", lambda r: r.figures.scatter_high, _digits, 12,
           json="scatter_high", page=PageCell(
               "95 %", order=lambda r: r.figures.scatter_high, style="n",
               text=lambda r: f"{number(r.figures.scatter_low, 2)} to {number(r.figures.scatter_high, 2)}")),
    Column("model", "Model", lambda r: r.value, _digits, json="model",
           page=PageCell(text=lambda r: _text(r.value, r))),
    Column("difference", "Model less mean", lambda r: r.difference, _digits, 15, json="difference",
           page=PageCell("Difference", text=lambda r: _text(r.difference, r))),
    Column("standard_errors", "in standard errors", lambda r: r.standard_errors, "0.0", 17,
           json="standard_errors", page=PageCell("in sd", layout=".1f")),
    Column("chance", "Chance", lambda r: r.chance, "0.0%", json="chance", page=PageCell(
        text=lambda r: f"{100.0 * r.chance:.1f} %", order=lambda r: r.chance, style="n",
        attributes=lambda r: {"class": "flag" if _far(r) else ""})),
)  # fmt: skip


def _far(row: CarComparison) -> bool:
    return row.chance < UNLIKE


def car_table(cars: Sequence[CarComparison]) -> Table[CarComparison]:
    """A row a characteristic; last columns: each car's own value."""
    count = cars[0].figures.values.size if cars else 0
    return Table(
        "Cars",
        CAR_REMARK,
        (*CAR_COLUMNS, *map(_car_column, range(count))),
        by_load_case(cars, lambda c: c.entry.load_case),
        flagged=_far,
        page=PageLayout[CarComparison](
            "measured-cars",
            "Cars",
            filtered=True,
            choices={"far": "far from the cars only"},
            tags=lambda c: "far" if _far(c) else "",
        ),
    )


def _car_column(i: int) -> Column[CarComparison]:
    def value(row: CarComparison) -> float:
        return float(row.figures.values[i])

    return Column(
        f"car_{i + 1}",
        f"Car {i + 1}",
        value,
        _digits,
        json=f"car_{i + 1}",
        page=PageCell(text=lambda r: _text(value(r), r)),
    )


def cars_beside(correlation: Correlation, measurement: Measurement | None) -> tuple[CarComparison, ...]:
    """The correlated axle beside the single cars; none of one car."""
    if measurement is None:
        return ()
    final = correlation.best.outcome.characteristics
    return compare_cars(measurement, dict(zip(CHARACTERISTICS, map(float, final), strict=True)))


def write_cars(cars: Sequence[CarComparison], folder: Path) -> list[Path]:
    """cars.csv; nothing of one car."""
    return [write_columns(folder / "cars.csv", table_columns(car_table(cars)))] if cars else []


def cars_entry(cars: Sequence[CarComparison]) -> dict[str, Any]:
    """`{"cars": {id: record}}` for JSON; empty of one car."""
    if not cars:
        return {}
    table = car_table(cars)
    return {"cars": dict(zip((r.entry.id for r in table.rows), table_records(table), strict=True))}
