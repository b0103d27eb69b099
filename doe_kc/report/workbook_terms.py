"""A sheet that says how to read the others."""

from __future__ import annotations

from collections.abc import Mapping

from openpyxl.workbook import Workbook

from doe_kc.report.render.cells import frame, page, put, title, widths


def terms_sheet(book: Workbook, study: str, legend: Mapping[str, str]) -> None:
    """Legend. legend: term -> explanation."""
    ws = book.create_sheet("Legend")
    title(ws, f"Legend: {study}", "How to read this workbook.")
    for row, (key, text) in enumerate(legend.items(), start=4):
        put(ws, row, 1, key, bold=True, vertical="top")
        put(ws, row, 2, text, wrap=True, vertical="top")
        ws.row_dimensions[row].height = 14.5 * (1 + len(text) // 110)
    frame(ws, range(4, 4 + len(legend)), range(1, 3))
    widths(ws, [22, 120])
    page(ws, study)
