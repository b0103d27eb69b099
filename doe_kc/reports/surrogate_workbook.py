"""surrogates.xlsx: quality of every model, influence, variance shares, and how to read them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from openpyxl.utils import get_column_letter
from openpyxl.workbook import Workbook
from openpyxl.worksheet.worksheet import Worksheet

from doe_kc.parameter_influence.study import percent_of_column
from doe_kc.reports.render.cells import cell_alignment, colour_scale, put
from doe_kc.reports.render.workbook import TABLE_FIRST_ROW, new_book, table_sheet, write_book
from doe_kc.reports.surrogate_tables import MatrixRow, chosen_table, matrix_table
from doe_kc.reports.table import Column, Table
from doe_kc.surrogate_models.report import SurrogateReport
from doe_kc.surrogate_models.selection import ERROR_MARGIN, EXACT

SURROGATE_LEGEND = (
    ("Q2", "1 - left-out squared error / squares about the mean: 1 = perfect, 0 = no better than the mean."),
    ("RMSE", "Root mean square left-out error, in the characteristic's unit."),
    ("Coverage", "Share of left-out designs inside the 95 % interval, as predicted and after calibration; "
     "the latter with 95 % limits of what it is on new designs, as its scale is known from so few."),
    ("Sharpness", "Half width of the 95 % interval over the characteristic's standard deviation."),
    ("Chosen", f"The simplest model whose left-out squared error is within {ERROR_MARGIN:.0%} of the "
     f"best one's, or whose 1 - Q2 is at most {EXACT:g}."),
    ("Left out", "Models with many hyper-parameters are refitted to each fold; linear and radial ones leave "
     "one design out in closed form; the quadratic one chooses its terms anew in each fold."),
    ("Influence", "Gradient of the chosen model at the unchanged axle times the parameter's step, percent of "
     "the column's largest entry; one at a time: the same by the true solver."),
    ("Shares", "Total effect: share of the characteristic's variance over the variables' ranges that the "
     "parameter takes part in, percent."),
)  # fmt: skip


def write_surrogate_workbook(path: Path, report: SurrogateReport, *, study: str, date: str) -> Path:
    """Sheets Quality, Influence, Shares and Legend; RunError as `write_book`."""
    book = new_book(f"Surrogates: {study}")
    table_sheet(book, chosen_table(report), study)
    remark = "Percent of each column's largest entry, at the unchanged axle; + = both grow together."
    percent = percent_of_column(report.changes)
    ws = _matrix_sheet(book, matrix_table(report, "Influence", remark, percent), study)
    _put_agreement(ws, report)
    remark = "Total effects over the ranges, percent."
    _matrix_sheet(book, matrix_table(report, "Shares", remark, 100.0 * report.shares), study)
    ws = table_sheet(book, _legend_table(report, date), study)
    ws.auto_filter.ref = None
    return write_book(path, book)


def _matrix_sheet(book: Workbook, table: Table[MatrixRow], study: str) -> Worksheet:
    """Heads upright, as the columns are narrow."""
    ws, columns = table_sheet(book, table, study), table.sheet_columns
    heads = TABLE_FIRST_ROW - 1
    for c in range(3, len(columns) + 1):
        ws.cell(heads, c).alignment = cell_alignment(textRotation=90, horizontal="center", vertical="bottom")
    ws.row_dimensions[heads].height = 6.0 * max(len(c.head or "") for c in columns)
    ws.auto_filter.ref = None
    colour_scale(ws, f"C{TABLE_FIRST_ROW}:{get_column_letter(len(columns))}{heads + len(table.rows)}")
    return ws


def _put_agreement(ws: Worksheet, report: SurrogateReport) -> None:
    """How well the surrogates' influence is that of the true solver, below the matrix."""
    row = ws.max_row + 2
    a = report.agreement
    lines = (
        ("Correlation with one at a time", a.correlation, "0.000"),
        ("Strong entries of equal sign", a.same_sign, "0.00"),
        ("Root mean square difference, percent", a.error, "0.0"),
    )
    for k, (text, values, number) in enumerate(lines):
        put(ws, row + k, 1, text, bold=True)
        for j, value in enumerate(values):
            put(ws, row + k, 3 + j, _finite(value), number=number)


def _legend_table(report: SurrogateReport, date: str) -> Table[tuple[str, str]]:
    designs = report.designs
    counts = (
        f"{len(designs.x)} used; {designs.failed} failed, {designs.elsewhere} of other variables or bounds"
    )
    skipped = [(f"{name} left out", reason) for name, reason in report.fitted.skipped.items()]
    columns: tuple[Column[tuple[str, str]], ...] = (
        Column("term", "Term", lambda line: line[0], width=18),
        Column("meaning", "Meaning", lambda line: line[1], width=130),
    )
    rows = [*SURROGATE_LEGEND, ("Designs", counts), *skipped]
    return Table("Legend", f"doe_kc, {date}", columns, rows, title="Surrogates")


def _finite(value: float) -> float | None:
    return float(value) if np.isfinite(value) else None
