"""CSV, TXT and TAB: whatever separator, decimal sign and encoding a rig's software and its country chose."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from pathlib import Path

from doe_kc.ground.errors import InputError
from doe_kc.measurement.layout import GridLayout, grid_layout, is_number
from doe_kc.measurement.tables import OLE_MAGIC, ZIP_MAGIC, RecordTable, read_bytes

SEPARATORS: dict[str, Callable[[str], list[str]]] = {
    "\t": lambda line: line.split("\t"),
    ";": lambda line: line.split(";"),
    ",": lambda line: line.split(","),
    "blanks": lambda line: re.split(r"\s{2,}", line.strip()),
    "blank": str.split,
}
SNIFFED_LINES = 400
"""Lines that are looked at to tell the separator: more than any head of settings has."""
_CONTROL_CHARACTER = re.compile("[\x00-\x08\x0e-\x1f]")
_PLAIN_SHARE = 0.5
"""Share of the first line of samples that must be numbers: most channels are, remarks are not."""
Line = tuple[int, str]
"""Number in the file, counted from 1, and text of a line that is not empty."""


def read_text_table(path: Path, part: str | None, load_case: str) -> RecordTable:
    """Table of a text file. part, load_case: not used, a text file holds one table.

    The separator is tab, semicolon, comma or blanks; with any but the comma, numbers may have decimal commas.
    Lines above the headings are left out, a row of units below them is read.
    Raises InputError for Excel files in disguise, binary data, and rows unlike the heading.
    """
    lines = decoded(path, read_bytes(path)).replace("\r\n", "\n").replace("\r", "\n").split("\n")
    filled = [(i + 1, line) for i, line in enumerate(lines) if line.strip()]
    separator, layout = _plain(filled) or _sniffed(path, filled)
    if layout.headings is None:
        raise InputError(
            f"{path}: row {filled[layout.first][0]}, the samples begin without a row of headings; expected "
            "the channels' names above them, export the record with its headings."
        )
    split = SEPARATORS[separator]
    headings = _cells(filled[layout.headings][1], split)
    body = _body(filled[layout.first :], split)
    _refuse_ragged(path, headings, body)
    return RecordTable(
        label=str(path),
        headings=tuple(headings),
        rows=tuple(row for _, row in body),
        row_numbers=tuple(number for number, _ in body),
        decimal_comma=separator != ",",
        units=() if layout.units is None else tuple(_cells(filled[layout.units][1], split)),
    )


def decoded(path: Path, data: bytes) -> str:
    """Text in UTF-8, UTF-16 with or without its mark, or Windows' western code page."""
    if data.startswith((ZIP_MAGIC, OLE_MAGIC)):
        raise InputError(
            f"{path}: is an Excel workbook named {path.suffix or 'without suffix'}; expected text, "
            "so rename it to .xlsx or save it as CSV (UTF-8)."
        )
    text = _text(path, data)
    control = _CONTROL_CHARACTER.search(text)
    if control is not None:
        raise InputError(f"{path}: contains binary data; expected text, export the record again.")
    if not text.strip():
        raise InputError(f"{path}: the file is empty; expected a heading row and samples, export it again.")
    return text


def _text(path: Path, data: bytes) -> str:
    try:
        if data.startswith((b"\xff\xfe", b"\xfe\xff")):
            return data.decode("utf-16")
        if data[1:200:2].count(0) > len(data[1:200:2]) / 2:
            return data.decode("utf-16-le")
        return data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        if data.startswith((b"\xff\xfe", b"\xfe\xff")) or b"\x00" in data:
            raise InputError(
                f"{path}: byte {error.start} is no text; expected UTF-8 or UTF-16, save it as CSV (UTF-8)."
            ) from None
    return data.decode("cp1252", errors="replace")


def _body(lines: Sequence[Line], split: Callable[[str], list[str]]) -> list[tuple[int, list[str]]]:
    """Cells of each line, and its number."""
    text = "\n".join(line for _, line in lines)
    if '"' not in text and len(text.split()) == len(lines):  # nothing to strip
        return [(number, split(line)) for number, line in lines]
    return [(number, _cells(line, split)) for number, line in lines]


def _cells(line: str, split: Callable[[str], list[str]]) -> list[str]:
    return [cell.strip().strip('"').strip() for cell in split(line)]


def _plain(lines: Sequence[Line]) -> tuple[str, GridLayout] | None:
    """Headings in the first line and numbers from the second on: seen without trying every separator."""
    if len(lines) < 2:
        return None
    head = lines[0][1]
    separator = ";" if head.count(";") > head.count(",") else ","
    split = SEPARATORS[separator]
    names, cells = _cells(head, split), _cells(lines[1][1], split)
    numbers = sum(map(is_number, cells))
    if len(names) != len(cells) or len(cells) < 2 or numbers < _PLAIN_SHARE * len(cells):
        return None
    return None if any(map(is_number, names)) else (separator, GridLayout(0, None, 1))


def _sniffed(path: Path, lines: Sequence[Line]) -> tuple[str, GridLayout]:
    """The separator by which most cells are numbers below a row of headings."""
    best: tuple[tuple[bool, int], str, GridLayout] | None = None
    for name, split in SEPARATORS.items():
        rows = [_cells(line, split) for _, line in lines[:SNIFFED_LINES]]
        layout = grid_layout(rows)
        if layout is None:
            continue
        score = layout.headings is not None, sum(len(row) for row in rows[layout.first :])
        if best is None or score > best[0]:
            best = score, name, layout
    if best is not None:
        return best[1], best[2]
    head = lines[0][1]
    for separator in ("\t", ";", ","):
        if separator in head:
            return separator, GridLayout(0, None, 1)
    raise InputError(
        f"{path}: no rows of numbers are found, separated by commas, semicolons, tabs or blanks; expected a "
        "row of headings and samples, export the record as CSV."
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
