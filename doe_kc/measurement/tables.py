"""Raw tables of text or numbers, from CSV bytes, with the row numbers that messages need."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from doe_kc.ground.errors import InputError
from doe_kc.ground.typing import FloatArray

Cell = str | float | None

ZIP_MAGIC = b"PK\x03\x04"
OLE_MAGIC = b"\xd0\xcf\x11\xe0"
_DECIMAL = r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?"
_NUMBER = re.compile(_DECIMAL)
_NUMBERS = re.compile(rf"(?:{_DECIMAL}\n)*+")


@dataclass(frozen=True)
class RecordTable:
    """Heading texts, rows of cells, and the number (counted from 1) of each row in its file."""

    label: str
    headings: tuple[str, ...]
    rows: tuple[Sequence[Cell], ...]
    numbers: tuple[int, ...]
    decimal_comma: bool = False


def read_bytes(path: Path) -> bytes:
    """Contents of `path`; InputError when it cannot be read or is empty."""
    try:
        data = path.read_bytes()
    except FileNotFoundError:
        raise InputError(
            f"{path}: no such file; expected a record there, so copy it or correct [records]."
        ) from None
    except (OSError, ValueError) as error:
        raise InputError(f"{path}: cannot be read ({error}); expected a readable record file.") from None
    if not data.strip():
        raise InputError(f"{path}: the file is empty; expected a heading row and samples, export it again.")
    return data


def read_csv_table(path: Path) -> RecordTable:
    """Table of a UTF-8 CSV file, comma separated, or semicolon separated with decimal commas.

    Raises InputError for Excel files in disguise, binary data, and rows unlike the heading.
    """
    data = read_bytes(path)
    lines = _decode(path, data).replace("\r\n", "\n").replace("\r", "\n").split("\n")
    filled = [(i + 1, line) for i, line in enumerate(lines) if line.strip()]
    separator = _separator(path, filled[0][1])
    cells = [(number, _cells(line, separator)) for number, line in filled]
    headings = cells[0][1]
    _refuse_ragged(path, headings, cells[1:])
    return RecordTable(
        label=str(path),
        headings=tuple(headings),
        rows=tuple(row for _, row in cells[1:]),
        numbers=tuple(number for number, _ in cells[1:]),
        decimal_comma=separator == ";",
    )


def _cells(line: str, separator: str) -> list[str]:
    if '"' not in line and len(line.split()) == 1:  # nothing to strip
        return line.split(separator)
    return [cell.strip().strip('"').strip() for cell in line.split(separator)]


def _decode(path: Path, data: bytes) -> str:
    if data.startswith((ZIP_MAGIC, OLE_MAGIC)):
        raise InputError(
            f"{path}: is an Excel workbook named {path.suffix or 'without suffix'}; expected CSV text, "
            "so rename it to .xlsx or save it as CSV (UTF-8)."
        )
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise InputError(
            f"{path}: byte {error.start} is not UTF-8 text; expected a CSV file, save it as CSV (UTF-8)."
        ) from None
    if "\x00" in text:
        raise InputError(f"{path}: contains binary data; expected CSV text, export the record again.")
    if not text.strip():
        raise InputError(f"{path}: the file is empty; expected a heading row and samples, export it again.")
    return text


def _separator(path: Path, heading: str) -> str:
    if heading.count(";") > heading.count(","):
        return ";"
    if "," in heading:
        return ","
    what = "tabs" if "\t" in heading else "neither commas nor semicolons"
    raise InputError(
        f"{path}: the heading row is separated by {what}; expected commas, "
        "or semicolons with a decimal comma; export the record as CSV."
    )


def _refuse_ragged(path: Path, headings: Sequence[str], rows: Sequence[tuple[int, list[str]]]) -> None:
    for number, row in rows:
        if len(row) == len(headings):
            continue
        if number == rows[-1][0] and len(row) < len(headings):
            raise InputError(
                f"{path}: row {number}, the last one, ends after {len(row)} of {len(headings)} columns: "
                "the file is truncated; copy or export it again."
            )
        raise InputError(
            f"{path}: row {number} has {len(row)} columns, expected {len(headings)} as in the heading; "
            "look for a decimal comma or a missing separator there."
        )


def column_numbers(table: RecordTable, column: int) -> FloatArray:
    """(n,) finite numbers of a column; InputError as `number_at` for the first cell that holds none."""
    cells = [row[column] for row in table.rows]
    values = _plain_numbers(cells, table.decimal_comma)
    if values is not None and np.isfinite(values).all():
        return values
    return np.array([number_at(table, row, column) for row in range(len(cells))])


def _plain_numbers(cells: Sequence[Cell], decimal_comma: bool) -> FloatArray | None:
    """All cells at once where every one is a number or every one the text of a number, else None."""
    kinds = set(map(type, cells))
    if kinds <= {float, int}:
        return np.array(cells, dtype=float)
    if kinds != {str}:
        return None
    text = "\n".join([*cells, ""])  # type: ignore[list-item]  # the kinds say that they are texts
    text = text.replace(",", ".") if decimal_comma else text
    if not _NUMBERS.fullmatch(text) or text.count("\n") != len(cells):
        return None
    return np.array(text.split(), dtype=float)


def number_at(table: RecordTable, row: int, column: int) -> float:
    """The finite number in a cell; InputError naming file, row and column otherwise."""
    cell = table.rows[row][column]
    value = _number(cell, table.decimal_comma)
    if value is not None and math.isfinite(value):
        return value
    fault = "is empty" if cell is None or cell == "" else f'holds "{_short(cell)}"'
    raise InputError(
        f'{table.label}: row {table.numbers[row]}, column "{table.headings[column]}" {fault}; '
        "expected a finite number, so mend the cell or record the channel again."
    )


def _number(cell: Cell, decimal_comma: bool) -> float | None:
    if cell is None or isinstance(cell, bool):
        return None
    if isinstance(cell, str):
        text = cell.replace(",", ".") if decimal_comma else cell
        return float(text) if _NUMBER.fullmatch(text) else None
    return float(cell)


def _short(cell: Cell) -> str:
    text = str(cell)
    return text if len(text) <= 24 else text[:21] + "..."
