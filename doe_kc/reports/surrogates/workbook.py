"""surrogates.xlsx: quality of every model, influence, variance shares, and how to read them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from openpyxl.utils import get_column_letter
from openpyxl.workbook import Workbook
from openpyxl.worksheet.worksheet import Worksheet

from doe_kc.characteristics import Characteristic
from doe_kc.load_cases import case_label
from doe_kc.parameter_influence.study import percent_of_column
from doe_kc.reports.drawing.style import COLOUR_CYCLE
from doe_kc.reports.render.cells import cell_alignment, colour_scale, put
from doe_kc.reports.render.charts import add_marks, chart_sheet
from doe_kc.reports.render.workbook import TABLE_FIRST_ROW, new_book, table_sheet, write_book
from doe_kc.reports.surrogates.learning import LearningRow, learning_table
from doe_kc.reports.surrogates.tables import MatrixRow, chosen_table, matrix_table
from doe_kc.reports.table import Column, Table
from doe_kc.surrogate_models.models import SURROGATES
from doe_kc.surrogate_models.report import SurrogateReport
from doe_kc.surrogate_models.selection import ERROR_MARGIN, EXACT

SYMBOLS = ("circle", "square", "diamond", "triangle", "x", "star", "plus", "dash")
SURROGATE_LEGEND = (
    ("Q2", "1 - left-out squared error / squares about the mean: 1 = perfect, 0 = no better than the mean."),
    ("RMSE", "Root mean square left-out error, in the characteristic's unit."),
    ("Coverage", "Share of left-out designs inside the 95 % interval, as predicted and after calibration; "
     "the latter with 95 % limits of what it is on new designs, as its scale is known from so few."),
    ("Sharpness", "Half width of the 95 % interval over the characteristic's standard deviation."),
    ("Chosen", "The simplest model whose left-out squared error, geometric mean of the characteristic's and "
     f"that over all, is within {ERROR_MARGIN:.0%} of the best one's, or whose 1 - Q2 is at most {EXACT:g}."),
    ("Learning curve", "sqrt(1 - Q2) falls with the number of designs to the power of the rate: from a "
     "cross-validation that leaves out half the designs and from the usual one; limits of 95 %."),
    ("Left out", "Models with many hyper-parameters are refitted to each fold; linear and radial ones leave "
     "one design out in closed form; the quadratic one chooses its terms anew in each fold."),
    ("Influence", "Gradient of the chosen model at the unchanged axle times the parameter's step, percent of "
     "the column's largest entry; one at a time: the same by the true solver."),
    ("Shares", "Total effect: share of the characteristic's variance over the variables' ranges that the "
     "parameter takes part in, percent."),
)  # fmt: skip


def write_surrogate_workbook(path: Path, report: SurrogateReport, *, study: str, date: str) -> Path:
    """Sheets Quality and Learning curve with a chart each, Influence, Shares and Legend; RunError as
    `write_book`."""
    book = new_book(f"Surrogates: {study}")
    table_sheet(book, chosen_table(report), study)
    _quality_chart(book, report, study)
    if report.curve is not None:
        learning = learning_table(report, report.curve)
        table_sheet(book, learning, study)
        _learning_chart(book, learning, study)
    remark = "Percent of each column's largest entry, at the unchanged axle; + = both grow together."
    percent = percent_of_column(report.changes)
    ws = _matrix_sheet(book, matrix_table(report, "Influence", remark, percent), study)
    _put_agreement(ws, report)
    remark = "Total effects over the ranges, percent."
    _matrix_sheet(book, matrix_table(report, "Shares", remark, 100.0 * report.shares), study)
    ws = table_sheet(book, _legend_table(report, date), study)
    ws.auto_filter.ref = None
    return write_book(path, book)


def _quality_chart(book: Workbook, report: SurrogateReport, study: str) -> None:
    """sqrt(1 - Q2) of every model over the characteristics."""
    remark = "Left-out error in percent of the characteristic's standard deviation, 100 sqrt(1 - Q2)."
    ws = chart_sheet(book, "Quality chart", "Surrogates", remark, study)
    models = report.fitted.models
    entries = report.designs.characteristics
    rows = [
        [*heads, *(_percent(m.quality.q2[j]) for m in models.values())]
        for j, heads in enumerate(_heads(entries))
    ]
    looks = [(SYMBOLS[k % len(SYMBOLS)], _rgb(k)) for k in range(len(models))]
    labels = [SURROGATES[name].label for name in models]
    add_marks(
        ws, ["Load case", "Characteristic", *labels], rows, looks=looks, lowest=_floor(rows),
        axis="left-out error [% of the standard deviation]",
    )  # fmt: skip


def _learning_chart(book: Workbook, table: Table[LearningRow], study: str) -> None:
    """Designs that each characteristic needs, with limits."""
    ws = chart_sheet(book, "Designs chart", "Designs for the goal", table.remark or "", study)
    rows = [
        [*heads, r.needed, r.low, r.high]
        for heads, r in zip(_heads([r.entry for r in table.rows]), table.rows, strict=True)
    ]
    looks = [("circle", _rgb(0)), ("dash", _rgb(1)), ("dash", _rgb(1))]
    heads = ["Load case", "Characteristic", "designs", "at least", "at most"]
    add_marks(ws, heads, rows, looks=looks, lowest=_floor(rows), axis="designs")


def _heads(entries: Sequence[Characteristic]) -> list[list[str | float | None]]:
    """Load case, where it begins, and label."""
    cases = [case_label(e.load_case) for e in entries]
    return [
        [case if k == 0 or case != cases[k - 1] else None, entry.label]
        for k, (case, entry) in enumerate(zip(cases, entries, strict=True))
    ]


def _percent(q2: float) -> float | None:
    return 100.0 * math.sqrt(max(1.0 - q2, 0.0)) if np.isfinite(q2) else None


def _floor(rows: Sequence[Sequence[str | float | None]]) -> float:
    """Power of two below all numbers, where the axis begins."""
    numbers = [v for row in rows for v in row[2:] if isinstance(v, float) and v > 0.0]
    return 2.0 ** math.floor(math.log2(min(numbers, default=1.0)))


def _rgb(k: int) -> str:
    return COLOUR_CYCLE[k % len(COLOUR_CYCLE)].removeprefix("#").upper()


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
