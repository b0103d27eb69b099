"""The sheets laid out as the thesis's Appendix C: a row a parameter, a column a characteristic."""

from __future__ import annotations

import math
from itertools import groupby

import numpy as np
from openpyxl.utils import get_column_letter
from openpyxl.workbook import Workbook
from openpyxl.worksheet.worksheet import Worksheet

from doe_kc.ground.typing import FloatArray
from doe_kc.load_cases import case_label
from doe_kc.parameter_influence.study import Influence
from doe_kc.reports.influence.layout import (
    BASELINE_ROW,
    CASE_ROW,
    FIRST_MATRIX_ROW,
    LABELS,
    NAME_ROW,
    SECTION_ROW,
    UNIT_ROW,
    Layout,
    layout,
    section,
    step_text,
)
from doe_kc.reports.render.cells import (
    FLAGGED,
    HEADER_FILL,
    MUTED,
    colour_scale,
    frame,
    page,
    put,
    remark,
    title,
    widths,
)
from doe_kc.reports.table import three_digits

REMARK = "Description, remark"
PERCENT_WIDTH = 7.0
"""Characters of a percent column; values with their decimals need more."""


def influence_sheet(book: Workbook, influence: Influence, study: str) -> None:
    """Percent of each column's largest magnitude, with sums, ranks and colours."""
    ws, at = book.create_sheet("Influence"), layout(influence)
    title(
        ws,
        f"Parameter influence: {study}",
        "Percent of the largest entry of each column; + = positive change for a positive step. "
        "Italic with a comment: one-at-a-time and exact change differ (see Legend).",
    )
    _heads(ws, influence, at, study, sums=True)
    _labels(ws, influence, at)
    percent = np.where(np.isfinite(influence.absolute), influence.percent, np.nan)
    for r, i in enumerate(at.rows, start=FIRST_MATRIX_ROW):
        for c, j in enumerate(at.columns, start=LABELS + 1):
            flagged = bool(influence.nonlinear[i, j])
            value = round(float(percent[i, j])) if math.isfinite(percent[i, j]) else None
            cell = put(
                ws,
                r,
                c,
                value,
                number='0"%"',
                horizontal="center",
                italic=flagged,
                bold=flagged,
                color=None if value else MUTED,
            )
            if flagged:
                remark(cell, _difference(influence, i, j))
    colour_scale(ws, at.area)
    _sums(ws, np.nan_to_num(percent), at)


def absolute_sheet(book: Workbook, influence: Influence, study: str) -> None:
    """Half the difference between the runs with the parameter raised and lowered by its step."""
    ws, at = book.create_sheet("Absolute"), layout(influence)
    below = "Change of the characteristic, in its unit, for a positive step (one at a time)."
    title(ws, f"Absolute influence: {study}", below)
    _heads(ws, influence, at, study)
    _labels(ws, influence, at)
    _values(ws, influence, at, influence.absolute)


def exact_sheet(book: Workbook, influence: Influence, study: str) -> None:
    """Exact derivative of the nominal axle times the same step; cells that differ are marked."""
    ws, at = book.create_sheet("Exact"), layout(influence)
    count = int(influence.nonlinear.sum())
    below = (
        "Derivative of the nominal axle times the same step, in the same unit. "
        f"Shaded: one-at-a-time and exact change differ by more than 5 % ({count} cells)."
    )
    title(ws, f"Exact influence: {study}", below)
    _heads(ws, influence, at, study)
    _labels(ws, influence, at)
    _values(ws, influence, at, influence.exact, flag=True)


def _heads(ws: Worksheet, influence: Influence, at: Layout, study: str, *, sums: bool = False) -> None:
    entries = [influence.characteristics[j] for j in at.columns]
    _merged(ws, SECTION_ROW, [section(e) for e in entries])
    _merged(ws, CASE_ROW, [case_label(e.load_case) for e in entries])
    decimals = _formats(influence.baseline[list(at.columns)][None, :])
    for c, (entry, j) in enumerate(zip(entries, at.columns, strict=True), start=LABELS + 1):
        put(
            ws,
            NAME_ROW,
            c,
            entry.label,
            rotation=90,
            horizontal="center",
            vertical="bottom",
            fill=HEADER_FILL,
        )
        value = float(influence.baseline[j])
        number = decimals[c - LABELS - 1]
        put(ws, BASELINE_ROW, c, value, number=number, horizontal="center", fill=HEADER_FILL, color=MUTED)
        put(ws, UNIT_ROW, c, entry.unit, horizontal="center", vertical="top", fill=HEADER_FILL)
    for c, text in enumerate(("Group", "Parameter", "Step"), start=1):
        put(ws, UNIT_ROW, c, text, bold=True, vertical="top", fill=HEADER_FILL)
    put(ws, BASELINE_ROW, 1, "Nominal value of the characteristic", fill=HEADER_FILL, color=MUTED)
    put(ws, NAME_ROW, 1, "Characteristic", bold=True, vertical="bottom", fill=HEADER_FILL)
    put(ws, CASE_ROW, 1, "Load case", bold=True, fill=HEADER_FILL)
    for row in (SECTION_ROW, CASE_ROW, NAME_ROW, BASELINE_ROW):
        ws.merge_cells(start_row=row, end_row=row, start_column=1, end_column=LABELS)
    extra = 3 if sums else 1
    _tail_heads(ws, at, sums=sums)
    ws.row_dimensions[NAME_ROW].height = 150
    ws.row_dimensions[UNIT_ROW].height = 30
    ws.freeze_panes = ws.cell(FIRST_MATRIX_ROW, LABELS + 1)
    end = get_column_letter(at.last_column + extra)
    ws.auto_filter.ref = f"A{UNIT_ROW}:{end}{at.last_row}"
    widths(
        ws,
        [
            12,
            21,
            9,
            *[PERCENT_WIDTH if sums else 1.3 * PERCENT_WIDTH] * len(at.columns),
            *([6.5, 5.0] if sums else []),
            46,
        ],
    )
    frame(
        ws,
        range(SECTION_ROW, at.last_row + 1),
        range(1, at.last_column + extra + 1),
        thick_above=(SECTION_ROW, *at.row_breaks, at.last_row + 1),
        thick_left=(1, *at.column_breaks, at.last_column + 1),
    )
    page(ws, study, repeat=f"1:{UNIT_ROW}")
    ws.print_area = f"A1:{get_column_letter(at.last_column + extra - 1)}{at.last_row + (2 if sums else 0)}"


def _tail_heads(ws: Worksheet, at: Layout, *, sums: bool) -> None:
    names = ("Sum of magnitudes", "Rank", REMARK) if sums else (REMARK,)
    for k, text in enumerate(names, start=1):
        rotation = 0 if text == REMARK else 90
        c = at.last_column + k
        put(ws, NAME_ROW, c, text, bold=True, rotation=rotation, horizontal="center", vertical="bottom")
        for row in (SECTION_ROW, CASE_ROW, NAME_ROW, BASELINE_ROW, UNIT_ROW):
            ws.cell(row, c).fill = HEADER_FILL


def _merged(ws: Worksheet, row: int, names: list[str]) -> None:
    column = LABELS + 1
    for name, members in groupby(names):
        count = len(list(members))
        put(ws, row, column, name, bold=True, horizontal="center", fill=HEADER_FILL, wrap=True)
        ws.merge_cells(start_row=row, end_row=row, start_column=column, end_column=column + count - 1)
        column += count
    ws.row_dimensions[row].height = 30 if row == CASE_ROW else 18


def _labels(ws: Worksheet, influence: Influence, at: Layout) -> None:
    last = max(at.last_column + 1, ws.max_column)
    for r, i in enumerate(at.rows, start=FIRST_MATRIX_ROW):
        parameter = influence.parameters[i]
        first = r in at.row_breaks
        # The group stands in every row, not in a merged cell, so that rows can be filtered and sorted.
        put(ws, r, 1, parameter.group, bold=first, color=None if first else MUTED)
        put(ws, r, 2, parameter.path, bold=True)
        put(ws, r, 3, step_text(influence, i), horizontal="right")
        put(ws, r, last, _remark(influence, i), color=MUTED)


def _remark(influence: Influence, i: int) -> str:
    parameter = influence.parameters[i]
    if parameter.path in influence.failures:
        return f"{parameter.label}; {influence.failures[parameter.path]}"
    return parameter.label + ("" if parameter.active else "; rigid in this axle")


def _difference(influence: Influence, i: int, j: int) -> str:
    unit = influence.characteristics[j].unit
    return (
        f"Not linear over the step: one at a time {influence.percent[i, j]:.1f} % "
        f"({influence.absolute[i, j]:.4g} {unit}), exact {influence.exact_percent[i, j]:.1f} % "
        f"({influence.exact[i, j]:.4g} {unit})."
    )


def _sums(ws: Worksheet, percent: FloatArray, at: Layout) -> None:
    table = np.abs(percent[np.ix_(at.rows, at.columns)])
    total, ranks = table.sum(axis=1), _ranks(table.sum(axis=1))
    for k in range(len(at.rows)):
        put(
            ws,
            FIRST_MATRIX_ROW + k,
            at.last_column + 1,
            round(float(total[k])),
            number="0",
            horizontal="center",
        )
        put(ws, FIRST_MATRIX_ROW + k, at.last_column + 2, int(ranks[k]), number="0", horizontal="center")
    below, order = table.sum(axis=0), _ranks(table.sum(axis=0))
    for row, name in ((at.last_row + 1, "Sum of magnitudes"), (at.last_row + 2, "Rank")):
        put(ws, row, 1, name, bold=True)
        for k in range(len(at.columns)):
            value = round(float(below[k])) if name != "Rank" else int(order[k])
            put(ws, row, LABELS + 1 + k, value, number="0", horizontal="center", bold=True)


def _ranks(sums: FloatArray) -> FloatArray:
    """1 for the largest; equal sums share the better rank."""
    falling = -np.round(sums, 6)
    return np.asarray(np.searchsorted(np.sort(falling), falling) + 1.0)


def _values(
    ws: Worksheet, influence: Influence, at: Layout, values: FloatArray, *, flag: bool = False
) -> None:
    formats = _formats(values[:, list(at.columns)])
    for r, i in enumerate(at.rows, start=FIRST_MATRIX_ROW):
        for c, j in enumerate(at.columns, start=LABELS + 1):
            flagged = flag and bool(influence.nonlinear[i, j])
            fill = FLAGGED if flagged else None
            number = formats[c - LABELS - 1]
            cell = put(ws, r, c, float(values[i, j]), number=number, fill=fill, italic=flagged, bold=flagged)
            if flagged:
                remark(cell, _difference(influence, i, j))


def _formats(values: FloatArray) -> list[str]:
    """Number formats that show three digits of each column's largest entry."""
    return [three_digits(float(p)) for p in np.nan_to_num(np.abs(values)).max(axis=0)]
