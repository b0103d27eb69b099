"""The table of a sample: what each characteristic spans over the designs."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from doe_kc.characteristics import CHARACTERISTICS, Characteristic
from doe_kc.ground.typing import FloatArray
from doe_kc.reports.table import Column, Table, TerminalCell


@dataclass(frozen=True)
class CharacteristicSpan:
    """Lowest, mean and highest value of a characteristic over the designs that were solved, in its unit."""

    entry: Characteristic
    low: float
    mean: float
    high: float


SPAN_COLUMNS: tuple[Column[CharacteristicSpan], ...] = (
    Column("name", "Id", lambda s: s.entry.id, terminal=TerminalCell("characteristic", "32")),
    Column("low", "Lowest", lambda s: s.low, json="low", terminal=TerminalCell("lowest", ">12", ".5g")),
    Column("mean", "Mean", lambda s: s.mean, json="mean", terminal=TerminalCell("mean", ">12", ".5g")),
    Column("high", "Highest", lambda s: s.high, json="high", terminal=TerminalCell("highest", ">12", ".5g")),
    Column("unit", "Unit", lambda s: s.entry.unit, json="unit",
           terminal=TerminalCell("", text=lambda s: f"  {s.entry.unit}")),
)  # fmt: skip


def span_table(values: FloatArray) -> Table[CharacteristicSpan]:
    """values: (n, all characteristics), nan where the solver does not answer one; those it never answers are
    left out."""
    rows = [
        CharacteristicSpan(entry, *(float(of(column)) for of in (np.nanmin, np.nanmean, np.nanmax)))
        for entry, column in zip(CHARACTERISTICS.values(), values.T, strict=True)
        if np.isfinite(column).any()
    ]
    return Table("Characteristics", "Over the designs that were solved.", SPAN_COLUMNS, rows)
