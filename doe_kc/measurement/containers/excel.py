"""Raw table of one Excel sheet."""

from __future__ import annotations

import io
import warnings
from pathlib import Path
from typing import Any

from doe_kc.ground.errors import InputError, nearest
from doe_kc.measurement.layout import GridLayout, grid_layout
from doe_kc.measurement.tables import ZIP_MAGIC, Cell, RecordTable, read_bytes


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


def parts(path: Path) -> list[str | None]:
    """Sheets; [None] for a workbook with one."""
    import openpyxl

    try:
        titles = list(openpyxl.load_workbook(io.BytesIO(read_bytes(path)), read_only=True).sheetnames)
    except InputError:
        raise
    except Exception:  # told by reading it
        return [None]
    return list(titles) if len(titles) > 1 else [None]


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
    layout = grid_layout([row for _, row in filled])
    if layout is None or layout.headings is None:
        layout = GridLayout(0, None, 1)
    headings = _trimmed(filled[layout.headings or 0][1])
    body = [(n, [_cell(c) for c in row[: len(headings)]]) for n, row in filled[layout.first :]]
    padded = [(n, row + [None] * (len(headings) - len(row))) for n, row in body]
    units = filled[layout.units][1] if layout.units is not None else ()
    return RecordTable(
        label=label,
        headings=tuple("" if h is None else str(h) for h in headings),
        rows=tuple(row for _, row in padded),
        row_numbers=tuple(n for n, _ in padded),
        decimal_comma=True,  # of numbers that a sheet holds as text
        units=tuple("" if u is None else str(u) for u in units),
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
