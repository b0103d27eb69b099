"""One rig record: a load case's channels over time, read from CSV or an Excel sheet and checked."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from doe_kc.curves import RIG_RESPONSES, SIDES
from doe_kc.ground.errors import InputError
from doe_kc.ground.typing import FloatArray
from doe_kc.load_cases import LoadCase
from doe_kc.measurement.channels import TIME, locate
from doe_kc.measurement.tables import RecordTable, column_numbers, read_csv_table
from doe_kc.measurement.workbook import read_sheet_table

MIN_SAMPLES = 64
"""Fewer samples per loop leave under 32 points a branch: gradients in the fit window become guesses."""

WORKBOOK_SUFFIXES = (".xlsx", ".xlsm")


@dataclass(frozen=True)
class RigRecord:
    """Samples of one run, as recorded.

    label: file (and sheet), for messages. case: the load case as the rig ran it.
    time: (n,) s, strictly increasing. input: (n,) in `case.unit`.
    channels: response (`RIG_RESPONSES`) -> (2, n), left and right; deg, mm, N; changes from static
        for angles and wheel centre, tyre load absolute.
    """

    label: str
    case: LoadCase
    time: FloatArray
    input: FloatArray
    channels: Mapping[str, FloatArray]


def read_record(path: Path, load_case: str, *, sheet: str | None = None) -> RigRecord:
    """Read and check one record; every fault is an InputError naming file, place, expectation, remedy.

    load_case: id in `LOAD_CASES`. sheet: of an Excel workbook; None = the only one or the one
    named like the load case.
    """
    return record_from_table(_read_table(path, sheet, load_case), load_case)


def _read_table(path: Path, sheet: str | None, load_case: str) -> RecordTable:
    suffix = path.suffix.lower()
    if suffix in WORKBOOK_SUFFIXES:
        return read_sheet_table(path, sheet, load_case)
    if suffix == ".xls":
        raise InputError(f"{path}: is in the old Excel format .xls; expected .xlsx or .csv, save it as such.")
    if sheet is not None:
        raise InputError(
            f'{path}: a sheet ("#{sheet}") is named of a file that is no .xlsx; '
            "remove the part from # or name a workbook."
        )
    return read_csv_table(path)


def record_from_table(table: RecordTable, load_case: str) -> RigRecord:
    """Check the columns, numbers and sweep of a raw table."""
    case, columns = locate(table.label, table.headings, load_case)
    if len(table.rows) < MIN_SAMPLES:
        raise InputError(
            f"{table.label}: has {len(table.rows)} samples, expected at least {MIN_SAMPLES} in a loop; "
            "record at a higher rate or export the whole loop."
        )
    values = {role: column_numbers(table, column) for role, column in columns.items()}
    _check_time(table, values[TIME])
    _check_sweep(table.label, case, values["input"])
    channels = {r: np.stack([values[f"{r}_{s}"] for s in SIDES]) for r in RIG_RESPONSES}
    return RigRecord(table.label, case, values[TIME], values["input"], channels)


def _check_time(table: RecordTable, time: FloatArray) -> None:
    late = np.flatnonzero(np.diff(time) <= 0.0)
    if late.size:
        raise InputError(
            f"{table.label}: row {table.numbers[late[0] + 1]}, time does not increase; expected samples "
            "in the order of recording, so sort or export the record again."
        )


def _check_sweep(label: str, case: LoadCase, values: FloatArray) -> None:
    low, high = float(values.min()), float(values.max())
    if high == low:
        raise InputError(
            f'{label}: column "{case.channel} [{case.unit}]" is constant at {low:g}; expected a loop '
            f"through ±{case.window:g} {case.unit} at least: is it the right file for {case.id}?"
        )
    if min(high, -low) < case.window:
        raise InputError(
            f'{label}: column "{case.channel} [{case.unit}]" covers {low:g} to {high:g}, expected '
            f"at least ±{case.window:g}, the fit window of {case.id}; record a larger loop "
            "or check the unit."
        )
    if high - low > 1e3 * case.amplitude:
        raise InputError(
            f'{label}: column "{case.channel} [{case.unit}]" covers {low:g} to {high:g}, expected about '
            f"±{case.amplitude:g}; check the unit."
        )
