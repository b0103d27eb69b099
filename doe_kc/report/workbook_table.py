"""A table in a sheet: heads, rows, filter; text to the left, numbers and their heads to the right."""

from __future__ import annotations

from collections.abc import Sequence

from openpyxl.utils import get_column_letter
from openpyxl.worksheet.worksheet import Worksheet

from doe_kc.report.render.cells import HEADER_FILL, MUTED, cell_alignment, frame, put

TABLE_FIRST_ROW = 5
"""Row of the first entry below title, remark, gap and heads."""
Value = str | float | int | None


def table(
    ws: Worksheet,
    heads: Sequence[str],
    rows: Sequence[Sequence[Value]],
    *,
    formats: Sequence[str] | str = "0.00",
    start: int = TABLE_FIRST_ROW - 1,
    filtered: bool = True,
    muted: Sequence[bool] = (),
) -> int:
    """Heads in the row `start`, rows below; returns the last row.

    formats: number format by column, or the one of all floats. filtered: whether the sheet's filter is this
    table's. muted: rows in grey.
    """
    numeric = [any(len(r) > c and not isinstance(r[c], str) for r in rows) for c in range(len(heads))]
    for c, text in enumerate(heads, start=1):
        head = put(ws, start, c, text, bold=True, fill=HEADER_FILL)
        head.alignment = cell_alignment(
            horizontal="right" if numeric[c - 1] else "left",
            vertical="bottom",
            wrap_text=True,
            indent=int(not numeric[c - 1]),
        )
    for r, values in enumerate(rows):
        color = MUTED if r < len(muted) and muted[r] else None
        for c, value in enumerate(values, start=1):
            if isinstance(value, str):
                put(ws, start + 1 + r, c, value, horizontal="left", indent=1, color=color)
            else:
                put(ws, start + 1 + r, c, value, number=_format(formats, c, value), color=color)
    last = start + len(rows)
    frame(ws, range(start, last + 1), range(1, len(heads) + 1))
    if filtered:
        ws.auto_filter.ref = f"A{start}:{get_column_letter(len(heads))}{last}"
    ws.row_dimensions[start].height = 30
    return last


def _format(formats: Sequence[str] | str, column: int, value: Value) -> str | None:
    if isinstance(formats, str):
        return formats if isinstance(value, float) else None
    return (formats[column - 1] or None) if column <= len(formats) else None
