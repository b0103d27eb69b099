"""A workbook: a sheet of a table, a sheet of sentences, and the file."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from io import BytesIO
from pathlib import Path
from textwrap import wrap

from openpyxl.formatting.rule import ColorScaleRule, DataBarRule, FormulaRule, Rule
from openpyxl.styles import PatternFill
from openpyxl.utils import get_column_letter
from openpyxl.workbook import Workbook
from openpyxl.worksheet.worksheet import Worksheet

from doe_kc.ground.output import write_whole
from doe_kc.reports.render.cells import (
    FLAGGED,
    HEADER_FILL,
    MUTED,
    cell_alignment,
    clean,
    frame,
    page,
    put,
    title,
    widths,
)
from doe_kc.reports.table import Bar, Column, Inside, Row, Scale, Table, zero_format

TABLE_FIRST_ROW = 5
"""Row of the first entry below title, remark, gap and heads."""
INSIDE = PatternFill("solid", bgColor="D6E9F8")
OUTSIDE = PatternFill("solid", bgColor="FBDDB3")
LINE_HEIGHT = 14.5
"""Points of a line of text."""
BOLD_SHARE = 0.95
"""Bold characters to a character of a column's width."""


def new_book(name: str) -> Workbook:
    """Without a sheet; the name stands in the file's properties."""
    book = Workbook()
    book.remove(book.active)
    book.properties.title = clean(name)
    book.properties.creator = "doe_kc"
    return book


def write_book(path: Path, book: Workbook) -> Path:
    """The path, its old file whole until the new one is complete.

    RunError naming path and remedy when the place is locked, read-only or full.
    """
    # Into memory first: a full disk then meets plain bytes, not a half-made archive.
    content = BytesIO()
    book.save(content)
    return write_whole(path, lambda beside: beside.write_bytes(content.getvalue()))


def table_sheet(book: Workbook, table: Table[Row], study: str) -> Worksheet:
    """A sheet with the table alone: title, remark, rows; heads that can be filtered, also in print."""
    ws, layout, columns = book.create_sheet(table.name), table.sheet, table.sheet_columns
    title(ws, f"{table.title or table.name}: {study}", table.remark)
    last = put_table(ws, table)
    at = {c.key: get_column_letter(i) for i, c in enumerate(columns, start=1)}
    for color in table.colors if table.rows else ():
        _color(ws, color, at, last)
    if layout.frozen:
        ws.freeze_panes = f"{at[layout.frozen]}{TABLE_FIRST_ROW}"
    widths(ws, [c.width for c in columns])
    if layout.wrapped:
        _wrap(ws, columns, range(TABLE_FIRST_ROW, last + 1))
    heads = TABLE_FIRST_ROW - 1
    page(ws, study, repeat=f"1:{heads}", single=layout.single)
    ws.page_setup.fitToWidth = layout.pages_wide
    if layout.repeat_columns:
        ws.print_title_cols = layout.repeat_columns
    if layout.printed_to:
        printed = len(table.rows) if layout.printed is None else layout.printed
        ws.print_area = f"A1:{at[layout.printed_to]}{heads + printed}"
    return ws


def put_table(ws: Worksheet, table: Table[Row], *, start: int = TABLE_FIRST_ROW - 1) -> int:
    """Heads in the row `start`, rows below, text to the left, numbers and their heads to the right; returns
    the last row. The sheet's filter is that of the table in the usual place."""
    columns = table.sheet_columns
    numeric = [any(isinstance(c.in_sheet(row), float | int) for row in table.rows) for c in columns]
    for c, column in enumerate(columns, start=1):
        head = put(ws, start, c, column.head, bold=True, fill=HEADER_FILL)
        head.alignment = cell_alignment(
            horizontal="right" if numeric[c - 1] else "left",
            vertical="bottom",
            wrap_text=True,
            indent=int(not numeric[c - 1]),
        )
    for r, row in enumerate(table.rows, start=start + 1):
        _put_row(ws, r, row, table, columns)
    last = start + len(table.rows)
    frame(ws, range(start, last + 1), range(1, len(columns) + 1))
    if start == TABLE_FIRST_ROW - 1:
        ws.auto_filter.ref = f"A{start}:{get_column_letter(len(columns))}{last}"
    if not table.rows and table.empty:
        put(ws, start + 1, 1, table.empty, color=MUTED)
    ws.row_dimensions[start].height = max(30.0, LINE_HEIGHT * max(map(_head_lines, columns), default=1))
    return last


def _head_lines(column: Column[Row]) -> int:
    """Lines that a bold head takes in its column."""
    return len(wrap(column.head or "", max(4, int(BOLD_SHARE * column.width) - 1)))


def _put_row(ws: Worksheet, r: int, row: Row, table: Table[Row], columns: Sequence[Column[Row]]) -> None:
    color = MUTED if table.muted is not None and table.muted(row) else None
    fill = FLAGGED if table.flagged is not None and table.flagged(row) else None
    for c, column in enumerate(columns, start=1):
        value = column.in_sheet(row)
        if value is None:
            if fill is not None:
                ws.cell(r, c).fill = fill
        elif isinstance(value, str):
            put(ws, r, c, value, horizontal="left", indent=1, color=color, fill=fill)
        else:
            number = column.number if isinstance(column.number, str) else column.number(row)
            put(ws, r, c, value, number=zero_format(value, number) or None, color=color, fill=fill)


def _color(ws: Worksheet, color: Bar | Scale | Inside, at: Mapping[str, str], last: int) -> None:
    rules: list[Rule]
    if isinstance(color, Scale):
        ends = ("start", "mid", "end")
        points = zip(ends, color.colors, strict=True)
        words = {f"{end}_{k}": v for end, p in points for k, v in zip(("value", "color"), p, strict=True)}
        first, end = at[color.first], at[color.last]
        rules = [ColorScaleRule(**words, **{f"{e}_type": "num" for e in ends})]
    elif isinstance(color, Bar):
        first = end = at[color.key]
        full = ("num", color.full) if color.full is not None else ("max", None)
        rules = [DataBarRule("num", 0, *full, color=color.color, showValue=True)]
    else:
        first = end = at[color.key]
        own, low, high = (f"${at[k]}{TABLE_FIRST_ROW}" for k in (color.key, color.low, color.high))
        inside = f"AND({own}>={low},{own}<={high})"
        rules = [FormulaRule([inside], fill=INSIDE), FormulaRule([f"NOT({inside})"], fill=OUTSIDE)]
    for rule in rules:
        ws.conditional_formatting.add(f"{first}{TABLE_FIRST_ROW}:{end}{last}", rule)


def _wrap(ws: Worksheet, columns: Sequence[Column[Row]], rows: range) -> None:
    """Rows as high as their longest text needs."""
    for r in rows:
        lines = 1
        for c, column in enumerate(columns, start=1):
            cell = ws.cell(r, c)
            if isinstance(cell.value, str):
                lines = max(lines, -(-len(cell.value) // max(1, int(column.width) - 3)))
                cell.alignment = cell_alignment(horizontal="left", vertical="top", wrap_text=True, indent=1)
            else:
                cell.alignment = cell_alignment(vertical="top")
        ws.row_dimensions[r].height = 14.0 * lines + 1.0


def lines_sheet(
    book: Workbook,
    name: str,
    head: str,
    remark: str,
    lines: Sequence[tuple[str, str]],
    study: str,
    *,
    bold: int = 0,
    flagged: Collection[int] = (),
    length: int = 110,
    key_width: float = 22.0,
) -> Worksheet:
    """A sheet of terms and sentences. bold: number of first sentences in bold. flagged: indices of shaded
    ones. length: characters that fit one line of a sentence."""
    ws = book.create_sheet(name)
    title(ws, f"{head}: {study}", remark)
    for i, (key, text) in enumerate(lines):
        row = 4 + i
        put(ws, row, 1, key, bold=True, vertical="top", wrap=True)
        fill = FLAGGED if i in flagged else None
        put(ws, row, 2, text, wrap=True, vertical="top", bold=i < bold, fill=fill)
        deep = max(len(text) // length, int((len(key) - 1) // (key_width - 2.0)))
        ws.row_dimensions[row].height = LINE_HEIGHT * (1 + deep)
    frame(ws, range(4, 4 + len(lines)), range(1, 3))
    widths(ws, [key_width, 120])
    page(ws, study)
    return ws
