"""One rig record: its columns, needed and optional, and a load case's channels over time read from them."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from doe_kc.curves import RESPONSE_UNITS, RIG_RESPONSES, SIDES
from doe_kc.ground.errors import InputError, nearest
from doe_kc.ground.typing import FloatArray
from doe_kc.load_cases import LOAD_CASES, LoadCase
from doe_kc.load_cases.roll import ROLL_TECHNIQUES
from doe_kc.measurement.tables import RecordTable, column_numbers, read_csv_table, read_sheet_table

RIG_NAMES: Mapping[str, str] = {r: "caster" if r == "spin" else r for r in RIG_RESPONSES}
"""Response -> channel name in a record; the rig's `caster` is read off the wheel, our `spin`."""

TIME = "time"
TIME_UNIT = "s"

_HEADING = re.compile(r"\s*([^\[\]]*?)\s*(?:\[\s*([^\[\]]*?)\s*\])?\s*")
_FACTORS: Mapping[tuple[str, str], str] = {
    ("rad", "deg"): "multiply by 57.2958",
    ("mrad", "deg"): "multiply by 0.0572958",
    ("min", "deg"): "divide by 60",
    ("m", "mm"): "multiply by 1000",
    ("cm", "mm"): "multiply by 10",
    ("in", "mm"): "multiply by 25.4",
    ("kN", "N"): "multiply by 1000",
    ("daN", "N"): "multiply by 10",
    ("kg", "N"): "multiply by 9.80665",
    ("lbf", "N"): "multiply by 4.44822",
    ("ms", "s"): "divide by 1000",
}


@dataclass(frozen=True)
class Heading:
    """A column heading `name [unit]`; `unit` is None when there are no brackets."""

    name: str
    unit: str | None

    def __str__(self) -> str:
        return self.name if self.unit is None else f"{self.name} [{self.unit}]"


def parse_heading(text: str) -> Heading:
    """`"toe_L [deg]"` -> Heading("toe_L", "deg"); text of another form is all name."""
    match = _HEADING.fullmatch(text)
    if match is None:
        return Heading(text.strip(), None)
    return Heading(match[1], match[2])


def needed(case: LoadCase) -> dict[str, Heading]:
    """Role -> heading of every column that a record of `case` must have.

    Roles are `time`, `input` and `response_side` (`toe_L`, `spin_R`, ...).
    """
    out = {TIME: Heading(TIME, TIME_UNIT), "input": Heading(case.channel, case.unit)}
    for side in SIDES:
        for response in RIG_RESPONSES:
            heading = Heading(f"{RIG_NAMES[response]}_{side}", RESPONSE_UNITS[response])
            out[f"{response}_{side}"] = heading
    return out


def recorded_case(load_case: str, headings: Sequence[Heading]) -> LoadCase:
    """The load case as the rig ran it: roll counts as counter-phase when its input is `pad_z`."""
    names = {h.name for h in headings}
    if load_case == "roll":
        for technique in ROLL_TECHNIQUES.values():
            if technique.channel in names:
                return technique
    return LOAD_CASES[load_case]


def locate(label: str, texts: Sequence[str], load_case: str) -> tuple[LoadCase, dict[str, int]]:
    """The load case as run and role -> column index; InputError for wrong columns.

    Wrong are missing, double and wrong-unit columns; those that nobody needs are left alone.
    label: the file (and sheet) for the message.
    """
    headings = [parse_heading(t) for t in texts]
    case = recorded_case(load_case, headings)
    roles = needed(case)
    _refuse_missing(label, roles, headings, case)
    _refuse_double(label, roles, headings)
    names = [h.name for h in headings]
    columns = {role: names.index(h.name) for role, h in roles.items()}
    for role, column in columns.items():
        _refuse_unit(label, headings[column], roles[role], column)
    return case, columns


def _refuse_missing(
    label: str, roles: Mapping[str, Heading], headings: Sequence[Heading], case: LoadCase
) -> None:
    names = [h.name for h in headings]
    missing = [h for h in roles.values() if h.name not in names]
    if not missing:
        return
    spare = [n for n in names if n and n not in {h.name for h in roles.values()}]
    wanted = ", ".join(f'"{h}"{_taken_for(h.name, spare)}' for h in missing)
    raise InputError(
        f"{label}: the heading row lacks {wanted}, needed for load case {case.id}; "
        "name the columns `channel_side [unit]` and export the missing ones from the rig."
    )


def _taken_for(name: str, spare: Sequence[str]) -> str:
    """Remark on the present column that was probably meant."""
    hint = nearest(name, spare)
    return "" if not hint else hint.replace(" Did you mean ", " (is it the column ").replace("?", "?)")


def _refuse_double(label: str, roles: Mapping[str, Heading], headings: Sequence[Heading]) -> None:
    names = [h.name for h in headings]
    for heading in roles.values():
        if names.count(heading.name) > 1:
            at = " and ".join(str(i + 1) for i, n in enumerate(names) if n == heading.name)
            raise InputError(
                f'{label}: columns {at} are both named "{heading.name}"; expected it once, '
                "so rename or delete the one that is not meant."
            )


def _refuse_unit(label: str, heading: Heading, expected: Heading, column: int) -> None:
    if heading.unit == expected.unit:
        return
    have = "no unit" if heading.unit is None else f"the unit [{heading.unit}]"
    remedy = _FACTORS.get((heading.unit or "", expected.unit or ""), "convert the values")
    raise InputError(
        f'{label}: column {column + 1} "{heading.name}" has {have}, expected [{expected.unit}]; '
        f'{remedy} where needed and head the column "{expected}".'
    )


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
