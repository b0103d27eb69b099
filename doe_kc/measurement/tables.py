"""Raw tables of text or numbers, of CSV bytes or an Excel sheet, with the row numbers that messages need."""

from __future__ import annotations

import io
import math
import re
import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from doe_kc.ground.errors import InputError, nearest
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


def read_sheet_table(path: Path, sheet: str | None, load_case: str) -> RecordTable:
    """Table of a sheet of an .xlsx file: the named, else the only one, else `load_case`.

    Values only: a formula counts by its stored result. InputError when file or sheet cannot be used.
    """
    data = read_bytes(path)
    if not data.startswith(ZIP_MAGIC):
        raise InputError(
            f"{path}: is not an Excel workbook in spite of its name; expected .xlsx contents, "
            "so save it from Excel as .xlsx, or rename it to .csv if it is text."
        )
    rows, title = _read(path, data, sheet, load_case)
    return _table(f"{path}#{title}", rows)


def _read(path: Path, data: bytes, sheet: str | None, load_case: str) -> tuple[list[tuple[Any, ...]], str]:
    import openpyxl

    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # openpyxl warns of extensions that hold no values
            book = openpyxl.load_workbook(io.BytesIO(data), read_only=True, data_only=True)
            title = _choose(path, list(book.sheetnames), sheet, load_case)
            return list(book[title].iter_rows(values_only=True)), title
    except InputError:
        raise
    except Exception as error:  # a damaged workbook fails anywhere inside zip, XML or openpyxl
        raise InputError(
            f"{path}: cannot be read as an Excel workbook ({type(error).__name__}); "
            "expected an undamaged .xlsx, save it again from Excel."
        ) from None


def _choose(path: Path, titles: list[str], sheet: str | None, load_case: str) -> str:
    if sheet is None and len(titles) == 1:
        return titles[0]
    wanted = load_case if sheet is None else sheet
    if wanted in titles:
        return wanted
    raise InputError(
        f'{path}: has no sheet "{wanted}", its sheets are {", ".join(titles)};'
        f"{nearest(wanted, titles)} Write the record as {path.name}#Sheet."
    )


def _table(label: str, rows: list[tuple[Any, ...]]) -> RecordTable:
    filled = [(i + 1, row) for i, row in enumerate(rows) if any(c is not None for c in row)]
    if not filled:
        raise InputError(f"{label}: the sheet is empty; expected a heading row and samples.")
    headings = _trimmed(filled[0][1])
    body = [(n, [_cell(c) for c in row[: len(headings)]]) for n, row in filled[1:]]
    padded = [(n, row + [None] * (len(headings) - len(row))) for n, row in body]
    return RecordTable(
        label=label,
        headings=tuple("" if h is None else str(h) for h in headings),
        rows=tuple(row for _, row in padded),
        numbers=tuple(n for n, _ in padded),
    )


def _trimmed(row: tuple[Any, ...]) -> tuple[Any, ...]:
    """Heading cells without the empty ones that Excel keeps on the right."""
    last = max(i for i, c in enumerate(row) if c is not None)
    return row[: last + 1]


def _cell(value: Any) -> Cell:
    if isinstance(value, int | float) and not isinstance(value, bool):
        try:
            return float(value)
        except OverflowError:
            return float("inf")
    return None if value is None else str(value)
