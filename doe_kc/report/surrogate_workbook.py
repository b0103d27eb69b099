"""surrogates.xlsx: quality of every model, influence, variance shares, and how to read them."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from openpyxl.utils import get_column_letter
from openpyxl.workbook import Workbook
from openpyxl.worksheet.worksheet import Worksheet

from doe_kc.ground.typing import FloatArray
from doe_kc.influence.result import percent_of_column
from doe_kc.report.names import case_label
from doe_kc.report.render.cells import (
    PAPER_A3,
    cell_alignment,
    colour_scale,
    page,
    put,
    three_digits,
    title,
    widths,
)
from doe_kc.report.surrogate_tables import judged_document
from doe_kc.report.workbook_file import new_book, write_book
from doe_kc.report.workbook_table import TABLE_FIRST_ROW, Value, table
from doe_kc.surrogates.models import SURROGATES
from doe_kc.surrogates.report import SurrogateReport
from doe_kc.surrogates.selection import ERROR_MARGIN, EXACT

SURROGATE_LEGEND = (
    ("Q2", "1 - left-out squared error / squares about the mean: 1 = perfect, 0 = no better than the mean."),
    ("RMSE", "Root mean square left-out error, in the characteristic's unit."),
    ("Coverage", "Share of left-out designs inside the 95 % interval, as predicted and after calibration."),
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
    _quality(book, report, study)
    below = "Percent of each column's largest entry, at the unchanged axle; + = both grow together."
    _matrix(book, "Influence", percent_of_column(report.changes), report, study, below, agreement=True)
    _matrix(book, "Shares", 100.0 * report.shares, report, study, "Total effects over the ranges, percent.")
    _legend(book, report, study, date)
    return write_book(path, book)


def _quality(book: Workbook, report: SurrogateReport, study: str) -> None:
    ws = book.create_sheet("Quality")
    n = len(report.designs.x)
    title(ws, f"Surrogates: {study}", f"Cross-validation over {n} designs; the model in use and all others.")
    models = list(report.fitted.models)
    heads = [
        "Load case",
        "Characteristic",
        "Unit",
        "Model",
        "Q2",
        "RMSE",
        "Coverage",
        "Calibrated",
        "Sharpness",
    ]
    rows: list[Sequence[Value]] = []
    documents = {name: judged_document(report, name) for name in models}
    for entry, name in zip(report.designs.characteristics, report.fitted.chosen, strict=True):
        d = documents[name][entry.id]
        own: list[Value] = [case_label(entry.load_case), entry.label, entry.unit, SURROGATES[name].label]
        own += [float(d[k]) for k in ("q2", "rmse", "coverage", "calibrated_coverage", "sharpness")]
        rows.append([*own, *(float(documents[m][entry.id]["q2"]) for m in models)])
    table(ws, [*heads, *(f"Q2 {m}" for m in models)], rows, formats="0.0000")
    rmse = heads.index("RMSE") + 1
    for r, values in enumerate(rows, start=TABLE_FIRST_ROW):
        ws.cell(r, rmse).number_format = three_digits(float(values[rmse - 1] or 0.0))
    widths(ws, [24, 34, 9, 22, *[12.0] * (5 + len(models))])
    ws.freeze_panes = "C5"
    page(ws, study, paper=PAPER_A3, single=True)


def _matrix(
    book: Workbook, name: str, values: FloatArray, report: SurrogateReport, study: str, below: str,
    *, agreement: bool = False,
) -> None:  # fmt: skip
    ws = book.create_sheet(name)
    title(ws, f"{name} by surrogates: {study}", below)
    entries = report.designs.characteristics
    heads = ["Path", "Step", *(f"{case_label(c.load_case)}: {c.label}" for c in entries)]
    rows: list[Sequence[Value]] = []
    for i, variable in enumerate(report.space.variables):
        step = f"{variable.parameter.step:g} {variable.unit}".removesuffix(" -")
        rows.append([variable.path, step, *(_finite(v) for v in values[i])])
    last = table(ws, heads, rows, formats="0", filtered=False)
    for c in range(3, len(heads) + 1):
        ws.cell(TABLE_FIRST_ROW - 1, c).alignment = cell_alignment(
            textRotation=90, horizontal="center", vertical="bottom"
        )
    ws.row_dimensions[TABLE_FIRST_ROW - 1].height = 6.0 * max(map(len, heads))
    colour_scale(ws, f"C{TABLE_FIRST_ROW}:{get_column_letter(2 + len(entries))}{last}")
    if agreement:
        _agreement(ws, last + 2, report)
    ws.freeze_panes = "C5"
    widths(ws, [36, 12, *[7.0] * len(entries)])
    page(ws, study, paper=PAPER_A3, single=True)


def _agreement(ws: Worksheet, row: int, report: SurrogateReport) -> None:
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


def _legend(book: Workbook, report: SurrogateReport, study: str, date: str) -> None:
    ws = book.create_sheet("Legend")
    title(ws, f"Surrogates: {study}", f"doe_kc, {date}")
    designs = report.designs
    counts = (
        f"{len(designs.x)} used; {designs.failed} failed, {designs.elsewhere} of other variables or bounds"
    )
    skipped = [(f"{name} left out", reason) for name, reason in report.fitted.skipped.items()]
    rows: list[Sequence[Value]] = [*SURROGATE_LEGEND, ("Designs", counts), *skipped]
    table(ws, ("Term", "Meaning"), rows, filtered=False)
    widths(ws, [18, 130])
    page(ws, study)


def _finite(value: float) -> float | None:
    return float(value) if np.isfinite(value) else None
