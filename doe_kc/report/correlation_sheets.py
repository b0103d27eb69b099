"""The sheets of tables in the correlation workbook."""

from __future__ import annotations

import numpy as np
from openpyxl.formatting.rule import DataBarRule, FormulaRule
from openpyxl.styles import PatternFill
from openpyxl.workbook import Workbook

from doe_kc.correlation.result import Correlation
from doe_kc.curves import RESPONSE_LABELS
from doe_kc.report.correlation_characteristics import characteristic_rows
from doe_kc.report.correlation_evaluations import evaluation_frame
from doe_kc.report.correlation_parameters import parameter_rows
from doe_kc.report.correlation_terms import curve_rows
from doe_kc.report.names import case_label
from doe_kc.report.workbook_cells import (
    FLAGGED,
    MUTED,
    NEGATIVE_FILL,
    PAPER_A3,
    POSITIVE_FILL,
    page,
    put,
    title,
    widths,
)
from doe_kc.report.workbook_table import TABLE_FIRST_ROW, Value, table

COLUMNS_PER_PAGE = 24
INSIDE = PatternFill("solid", bgColor="D6E9F8")
OUTSIDE = PatternFill("solid", bgColor="FBDDB3")


def characteristics_sheet(book: Workbook, correlation: Correlation, study: str) -> None:
    """As Appendix D; final values blue inside their interval, orange outside."""
    ws = book.create_sheet("Characteristics")
    title(ws, f"Characteristics: {study}", "Blue: final value inside the interval; orange: outside.")
    heads = (
        "Load case", "Characteristic", "Id", "Unit", "Target", "Target sd", "Baseline", "Final", "Low",
        "High", "Inside", "Role", "Improvement, %", "In the mean", "Baseline distance, sd",
        "Final distance, sd", "Baseline, normalised", "Final, normalised",
    )  # fmt: skip
    rows = [
        (
            r.load_case, r.label, r.id, r.unit, r.entry.target.value, r.entry.target.sd, r.entry.baseline,
            r.entry.final, *r.interval, "yes" if r.inside else "no", r.role, r.entry.percent,
            "yes" if r.entry.counts else "no", r.baseline_distance, r.distance,
            r.normalized(r.entry.baseline), r.normalized(r.entry.final),
        )
        for r in characteristic_rows(correlation)
    ]  # fmt: skip
    formats = ["", "", "", "", *["0.0000"] * 6, "", "", "0.0", "", "0.0", "0.0", "0.000", "0.000"]
    last = table(ws, heads, rows, formats=formats)
    final, improvement = f"H{TABLE_FIRST_ROW}:H{last}", f"M{TABLE_FIRST_ROW}:M{last}"
    inside = f"AND($H{TABLE_FIRST_ROW}>=$I{TABLE_FIRST_ROW},$H{TABLE_FIRST_ROW}<=$J{TABLE_FIRST_ROW})"
    ws.conditional_formatting.add(final, FormulaRule([inside], fill=INSIDE))
    ws.conditional_formatting.add(final, FormulaRule([f"NOT({inside})"], fill=OUTSIDE))
    bar = DataBarRule("num", 0, "num", 100, color=NEGATIVE_FILL, showValue=True)
    ws.conditional_formatting.add(improvement, bar)
    ws.freeze_panes = ws.cell(TABLE_FIRST_ROW, 3)
    widths(ws, [25, 28, 32, 9, *[11.0] * 6, 8, 22, 13, 9, 11, 11, 12, 12])
    page(ws, study, paper=PAPER_A3, single=True)


def parameters_sheet(book: Workbook, correlation: Correlation, study: str) -> None:
    """As Appendix A, with bounds and what the measurement says."""
    ws = book.create_sheet("Parameters")
    title(
        ws,
        f"Parameters: {study}",
        "Shaded: at a bound. Grey: not visible in these measurements, tied or fixed.",
    )
    heads = (
        "Group", "Parameter", "Path", "Unit", "Role", "Baseline", "Final", "Change", "sd", "Lower", "Upper",
        "At bound", "Remark",
    )  # fmt: skip
    rows = parameter_rows(correlation)
    values = [
        (
            r.group, r.label, r.path, r.unit, r.role, r.baseline, r.final, r.change, r.sd, r.lower, r.upper,
            r.at_bound, r.remark,
        )
        for r in rows
    ]  # fmt: skip
    grey = [r.visible is False or r.role != "variable" for r in rows]
    table(ws, heads, values, formats=["", "", "", "", "", *["0.0000"] * 6], muted=grey)
    for r, row in enumerate(rows, start=TABLE_FIRST_ROW):
        for c in range(1, len(heads) + 1):
            if row.at_bound:
                ws.cell(r, c).fill = FLAGGED
    ws.freeze_panes = ws.cell(TABLE_FIRST_ROW, 4)
    widths(ws, [14, 46, 24, 8, 10, *[12.0] * 6, 10, 32])
    page(ws, study, paper=PAPER_A3, single=True)


def curves_sheet(book: Workbook, correlation: Correlation, study: str) -> None:
    """RMS deviation of every curve that is an objective."""
    ws = book.create_sheet("Curves")
    title(ws, f"Curves: {study}", "RMS deviation of both wheels' mean curves from the measured ones.")
    heads = (
        "Load case", "Response", "Id", "Unit", "RMS baseline", "RMS final", "Noise RMS", "Final / noise",
        "Norm", "Final, % of Norm",
    )  # fmt: skip
    rows = [
        (
            case_label(r.load_case), RESPONSE_LABELS[r.response], r.id, r.unit, r.rms_baseline, r.rms_final,
            r.noise_rms, r.rms_final / r.noise_rms if r.noise_rms else np.nan, r.norm,
            100.0 * r.rms_final / r.norm,
        )
        for r in curve_rows(correlation)
    ]  # fmt: skip
    last = table(ws, heads, rows, formats=["", "", "", "", *["0.00000"] * 3, "0.00", "0.0000", "0.00"])
    if rows:
        bar = DataBarRule("num", 0, "max", None, color=POSITIVE_FILL, showValue=True)
        ws.conditional_formatting.add(f"J{TABLE_FIRST_ROW}:J{last}", bar)
    else:
        put(ws, TABLE_FIRST_ROW, 1, "No curve is an objective of this study.", color=MUTED)
    widths(ws, [28, 32, 24, 8, *[13.0] * 6])
    page(ws, study)


def evaluations_sheet(book: Workbook, correlation: Correlation, study: str) -> None:
    """Every design that the true solver was asked for."""
    ws = book.create_sheet("Evaluations")
    title(ws, f"Evaluations: {study}", "In order; the shaded one is handed over. Values are absolute.")
    frame_ = evaluation_frame(correlation)
    names = {p.path: p for p in (v.parameter for v in correlation.problem.space.variables)}
    heads = [_head(c, names[c].unit if c in names else "") for c in frame_.columns]
    rows: list[list[Value]] = [[_cell(v) for v in row] for row in frame_.itertuples(index=False)]
    formats = ["0", "", "0.0000", "0.0000", "", "", "", "0.0000", "0.0000", "0.00", *["0.0000"] * len(names)]
    table(ws, heads, rows, formats=formats)
    for c in range(1, len(heads) + 1):
        ws.cell(TABLE_FIRST_ROW + correlation.run.best, c).fill = FLAGGED
    ws.freeze_panes = ws.cell(TABLE_FIRST_ROW, 4)
    # a head breaks at its blank only
    named = [max(11.0, 1.1 * len(head.split(",")[0]) + 1.0) for head in heads[len(heads) - len(names) :]]
    widths(ws, [11, 23, 13, 13, 9, 9, 34, 13, 12, 9, *named])
    page(ws, study, paper=PAPER_A3, repeat=f"{TABLE_FIRST_ROW - 1}:{TABLE_FIRST_ROW - 1}")
    ws.page_setup.fitToWidth = -(-len(heads) // COLUMNS_PER_PAGE)
    ws.print_title_cols = "A:C"


def _head(column: str, unit: str) -> str:
    return (
        f"{column}, {unit}"
        if unit
        else column.replace("_", " ").capitalize()
        if "." not in column
        else column
    )


def _cell(value: object) -> Value:
    if isinstance(value, bool | np.bool_):
        return "yes" if value else "no"
    return value if isinstance(value, str) else float(value)  # type: ignore[arg-type]
