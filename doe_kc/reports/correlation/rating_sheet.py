"""The rating as live formulas: change a weight, a target or an interval and read the new rating."""

from __future__ import annotations

import math

from openpyxl.workbook import Workbook
from openpyxl.worksheet.worksheet import Worksheet

from doe_kc.correlation.result import Correlation
from doe_kc.reports.correlation.terms import TermRow, term_rows
from doe_kc.reports.render.cells import (
    HEADER_FILL,
    MUTED,
    CellFill,
    frame,
    page,
    put,
    title,
    widths,
)
from doe_kc.reports.table import four_digits

HEADS = (
    "Kind", "Term", "Id", "Unit", "Goal", "Target", "Low", "High", "LinWt", "QuadWt", "S", "Norm",
    "Baseline", "Baseline Obj / ConViol", "Baseline term", "Final", "Final Obj / ConViol", "Final term",
)  # fmt: skip
RATING_HEAD_ROW, RATING_FIRST_ROW = 7, 8
FINAL_RATING = "R5"
INPUT = CellFill("solid", fgColor="FFF7D6")
TERM = "0.0000;-0.0000;0"
"""Number format of a term: a zero is one."""
EDITED = "FGHIJL"
"""Columns to edit: target, interval, weights, Norm."""


def rating_sheet(book: Workbook, correlation: Correlation, study: str) -> None:
    """One row a term of equation 2.2; the sums above follow every edit of the yellow cells."""
    ws = book.create_sheet("Rating terms")
    title(
        ws,
        f"Rating terms: {study}",
        "Rating = sum of S (LinWt Obj / Norm + QuadWt Obj² / Norm²), constraints with ConViol for Obj "
        "(equation 2.2). Edit the yellow cells; the true solver is not run again.",
    )
    rows = term_rows(correlation)
    last = RATING_FIRST_ROW + len(rows) - 1
    for c, text in enumerate(HEADS, start=1):
        put(ws, RATING_HEAD_ROW, c, text, bold=True, fill=HEADER_FILL, wrap=True, vertical="bottom")
    for r, row in enumerate(rows, start=RATING_FIRST_ROW):
        _row(ws, r, row)
    _sums(ws, correlation, last)
    frame(ws, range(RATING_HEAD_ROW, last + 1), range(1, len(HEADS) + 1))
    ws.auto_filter.ref = f"A{RATING_HEAD_ROW}:R{last}"
    ws.freeze_panes = ws.cell(RATING_FIRST_ROW, 4)
    ws.row_dimensions[RATING_HEAD_ROW].height = 30
    widths(ws, [11, 50, 32, 9, 10, *[11.0] * 13])
    page(ws, study, repeat=f"1:{RATING_HEAD_ROW}")


def _sums(ws: Worksheet, correlation: Correlation, last: int) -> None:
    for column, name, value in (
        ("O", "Baseline", correlation.baseline_rating),
        ("R", "Final", correlation.rating),
    ):
        at = ord(column) - ord("A") + 1
        put(ws, 4, at, name, bold=True, horizontal="right")
        cell = put(ws, 5, at, None, bold=True, number=four_digits(value))
        cell.value = f"=SUM({column}{RATING_FIRST_ROW}:{column}{last})"
        put(ws, 6, at, value, color=MUTED, number=four_digits(value))
    put(ws, 5, 2, "Rating with the cells below", bold=True)
    put(ws, 6, 2, "Rating of the correlation", color=MUTED)


def _row(ws: Worksheet, r: int, row: TermRow) -> None:
    texts = (row.kind, row.label, row.id, row.unit, row.goal)
    for c, text in enumerate(texts, start=1):
        put(ws, r, c, text)
    numbers = (row.target, row.low, row.high, row.linear, row.quadratic, row.sign, row.norm)
    for c, value in enumerate(numbers, start=6):
        put(ws, r, c, value, number="General" if c in {9, 10, 11} else four_digits(value))
    for column in EDITED:
        if ws[f"{column}{r}"].value is not None:
            ws[f"{column}{r}"].fill = INPUT
    for value, at in ((row.baseline, "MNO"), (row.final, "PQR")):
        _formulas(ws, r, row, value, at)


def _formulas(ws: Worksheet, r: int, row: TermRow, value: float, at: str) -> None:
    """Value, deviation and term; no formula for a value that is not known."""
    cells = [ws[f"{column}{r}"] for column in at]
    number = f"{four_digits(max(abs(value), row.norm))};-{four_digits(max(abs(value), row.norm))};0"
    for cell in cells:
        put(ws, r, cell.column, None, number=number)
    if not math.isfinite(value):
        return
    cells[2].number_format = TERM
    v, d, _ = (f"{column}{r}" for column in at)
    deviation = {
        "constraint": f"=MAX(G{r}-{v},{v}-H{r},0)",
        "curve": f"={v}",
        "objective": f"=ABS({v}-F{r})" if row.goal == "target" else f"={v}",
    }[row.kind]
    cells[0].value = value
    cells[1].value = deviation
    cells[2].value = f"=K{r}*(I{r}*{d}/L{r}+J{r}*({d}/L{r})^2)"
