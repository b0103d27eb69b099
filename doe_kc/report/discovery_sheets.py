"""The sheets of tables in the discovery workbook."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import pandas as pd
from openpyxl.formatting.rule import ColorScaleRule
from openpyxl.workbook import Workbook
from openpyxl.worksheet.worksheet import Worksheet

from doe_kc.curves import RESPONSE_LABELS
from doe_kc.discovery.disagreement import Map
from doe_kc.discovery.result import Discovery
from doe_kc.ground.numbers import sd_format
from doe_kc.report.discovery_effects import effect_frame
from doe_kc.report.discovery_gaps import gap_rows
from doe_kc.report.discovery_tables import (
    disagreement_rows,
    library_frame,
    ordered_standings,
    parameter_frame,
)
from doe_kc.report.discovery_words import STATUS_WORDS
from doe_kc.report.names import case_label
from doe_kc.report.render.cells import (
    MUTED,
    NEGATIVE_FILL,
    NEUTRAL_FILL,
    PAPER_A3,
    POSITIVE_FILL,
    cell_alignment,
    page,
    put,
    title,
    widths,
)
from doe_kc.report.workbook_table import TABLE_FIRST_ROW, Value, table

ODDS = '[>=6]"> 6";0.0'
"""log10 odds; 6 stands for 6 or more."""
FULL_COLOUR_LEVEL = 20.0
"""Standard deviations at which the colour of a disagreement is full."""
PRINTED = 40
"""Disagreements that are printed where fewer are beyond noise."""


def disagreement_sheet(book: Workbook, discovery: Discovery, study: str) -> None:
    """Every contrast of the records with the model, what re-tuning explains worst first."""
    ws = book.create_sheet("Disagreement")
    below = (
        f"Standard deviations; beyond ±{discovery.tuned.threshold:.1f} "
        f"(nominal ±{discovery.raw.threshold:.1f}) "
        "noise alone does not explain it: these rows come first, and are printed. +: model above measured. "
        "Empty: absorbed by re-tuning."
    )
    title(ws, f"Disagreement: {study}", below)
    maps = {"nominal": discovery.raw, "re-tuned": discovery.tuned, "with effect": discovery.final}
    rows = [
        (
            case_label(r.load_case), RESPONSE_LABELS[r.response], r.shape, _wheels(r.wheels), r.z_nominal,
            r.z_tuned, r.z_with_effect, _beyond(maps, (r.z_nominal, r.z_tuned, r.z_with_effect)),
        )
        for r in sorted(disagreement_rows(discovery), key=lambda r: -np.nan_to_num(abs(r.z_tuned)))
    ]  # fmt: skip
    rows.sort(key=lambda row: not row[-1])
    beyond = sum(bool(row[-1]) for row in rows)
    heads = (
        "Load case", "Response", "Shape", "Wheels", "z nominal", "z re-tuned", "z with effect",
        "Beyond noise",
    )  # fmt: skip
    last = table(ws, heads, rows, formats=["", "", "", "", "0.0", "0.0", "0.0"])
    _diverging(ws, f"E{TABLE_FIRST_ROW}:G{last}", FULL_COLOUR_LEVEL)
    ws.freeze_panes = ws.cell(TABLE_FIRST_ROW, 5)
    widths(ws, [28, 32, 14, 18, 12, 12, 12, 30])
    page(ws, study, repeat=f"{TABLE_FIRST_ROW - 1}:{TABLE_FIRST_ROW - 1}")
    ws.print_area = f"A1:H{TABLE_FIRST_ROW - 1 + max(beyond, min(len(rows), PRINTED))}"


def _wheels(wheels: str) -> str:
    return "both alike" if wheels == "both" else "left against right"


def _beyond(maps: Mapping[str, Map], values: Sequence[float]) -> str:
    each = zip(maps.items(), values, strict=True)
    return ", ".join(name for (name, found), z in each if abs(z) > found.threshold)


def effects_sheet(book: Workbook, discovery: Discovery, study: str) -> None:
    """Effects that the records ask for, a row for each of their numbers."""
    ws = book.create_sheet("Effects")
    title(ws, f"Effects: {study}", "What the records ask for; leads where the verdict is unexplained.")
    frame = effect_frame(discovery)
    heads = (
        "Id", "Effect", "Place", "Kind", "Probability", "log10 odds", "Against", "Size", "Value", "sd",
        "Unit", "Typical", "Times typical", "In words", "ln evidence", "Detectability, sd",
        "Chance of a wrong name", "Rivals", "What happens in the car", "Shown by", "Mistaken for",
    )  # fmt: skip
    formats = [
        "", "", "", "", "0.0%", ODDS, "", "", "0.0000", "0.0000", "", "0.000", "0.00", "", "0.0", "0.0",
        "0.00%",
    ]  # fmt: skip
    table(ws, heads, _rows(frame), formats=formats)
    if frame.empty:
        put(ws, TABLE_FIRST_ROW, 1, "No effect is asked for.", color=MUTED)
    for row, sd in enumerate(frame["sd"], start=TABLE_FIRST_ROW):
        ws.cell(row, 9).number_format = ws.cell(row, 10).number_format = sd_format(float(sd))
    wide = [24, 30, 16, 9, 11, 8, 22, 16, 13, 11, 9, 10, 10, 34, 12, 13, 12, 34, 44, 44, 34]
    wrapped(ws, wide, range(TABLE_FIRST_ROW, TABLE_FIRST_ROW + len(frame)))
    ws.freeze_panes = ws.cell(TABLE_FIRST_ROW, 4)
    page(ws, study, paper=PAPER_A3, repeat=f"{TABLE_FIRST_ROW - 1}:{TABLE_FIRST_ROW - 1}")
    ws.print_area = f"A1:R{TABLE_FIRST_ROW - 1 + max(1, len(frame))}"  # the rest is the same of every car


def library_sheet(book: Workbook, discovery: Discovery, study: str) -> None:
    """Where every hypothesis stands."""
    ws = book.create_sheet("Library")
    below = (
        "Would have shown: from the detectable size on, if the model is right but for this. Not resolved: "
        "the same, but the model does not explain the records. Not testable: re-tuning absorbs it, or it "
        "shows too little; see what hides it, and the parts that, measured on a bench, would show it."
    )
    title(ws, f"Library of effects: {study}", below)
    frame = library_frame(discovery)
    frame["status"] = [STATUS_WORDS[s.status] for s in ordered_standings(discovery)]
    heads = (
        "Id", "Effect", "Place", "Status", "Detectable size", "Times typical", "Typical size", "Absorbed, %",
        "Hidden by", "Parts to measure", "Looks like", "Mistaken for", "What happens in the car", "Shown by",
    )  # fmt: skip
    table(ws, heads, _rows(frame), formats=["", "", "", "", "", "0.000", "", "0.0"])
    wide = [24, 30, 20, 13, 34, 10, 30, 11, 34, 34, 40, 40, 50, 44]
    wrapped(ws, wide, range(TABLE_FIRST_ROW, TABLE_FIRST_ROW + len(frame)))
    ws.freeze_panes = ws.cell(TABLE_FIRST_ROW, 4)
    page(ws, study, paper=PAPER_A3, repeat=f"{TABLE_FIRST_ROW - 1}:{TABLE_FIRST_ROW - 1}")
    ws.print_area = f"A1:K{TABLE_FIRST_ROW - 1 + len(frame)}"  # the rest is the same of every car


def gap_sheet(book: Workbook, discovery: Discovery, study: str) -> None:
    """Whitened RMS of each load case and response."""
    ws = book.create_sheet("Gap")
    title(ws, f"Gap: {study}", "Whitened RMS of model minus measured; 1 is noise. First row: all records.")
    rows = [
        (
            case_label(r.case) if r.case else "All", RESPONSE_LABELS.get(r.response, "All"), r.gap.nominal,
            r.gap.tuned, r.gap.with_effect, r.gap.best_decoy, r.gap.noise_floor,
        )
        for r in gap_rows(discovery)
    ]  # fmt: skip
    heads = ("Load case", "Response", "Nominal", "Re-tuned", "With effect", "Best decoy", "Noise floor")
    last = table(ws, heads, rows, formats=["", "", *["0.00"] * 5])
    scale = ColorScaleRule("num", 1, NEUTRAL_FILL, "num", 3, "FCE0BC", "num", 10, POSITIVE_FILL)
    ws.conditional_formatting.add(f"C{TABLE_FIRST_ROW}:F{last}", scale)
    ws.freeze_panes = ws.cell(TABLE_FIRST_ROW, 3)
    widths(ws, [28, 34, *[13.0] * 5])
    page(ws, study, single=True)


def held_out_sheet(book: Workbook, discovery: Discovery, study: str) -> None:
    """Load cases predicted from all the others."""
    ws = book.create_sheet("Held out")
    below = "Each load case predicted by models fitted to all others; RMS 1 = as good as predicted."
    title(ws, f"Load cases held out: {study}", below)
    rows = [
        (case_label(h.load_case), h.tuned.rms, h.with_effect.rms, h.law_granted.rms, h.gain)
        for h in discovery.held_out
    ]
    heads = ("Load case", "RMS re-tuned", "RMS with effect", "RMS, law granted", "Gain, ln density")
    table(ws, heads, rows, formats=["", "0.00", "0.00", "0.00", "0.0"])
    if not rows:
        put(
            ws, TABLE_FIRST_ROW, 1, "No effect was found, so there is nothing to predict better.", color=MUTED
        )
    widths(ws, [30, 15, 15, 17, 17])
    page(ws, study)


def parameters_sheet(book: Workbook, discovery: Discovery, study: str) -> None:
    """Tunable parameters before and after, with their distance from nominal."""
    ws = book.create_sheet("Parameters")
    below = "Distances from nominal in standard deviations of the prior; sd: of the last value."
    if discovery.beyond:
        below += " Parameters marked lie outside the study's bounds, as the records ask for."
    title(ws, f"Parameters: {study}", below)
    frame = parameter_frame(discovery)
    frame["beyond"] = np.where(frame["beyond"], "outside", "")
    heads = (
        "Path", "Parameter", "Group", "Unit", "Nominal", "Re-tuned", "With effect", "sd",
        "Distance re-tuned, sd", "Distance with effect, sd", "Bounds",
    )  # fmt: skip
    last = table(ws, heads, _rows(frame), formats=["", "", "", "", *["0.0000"] * 4, "0.00", "0.00", ""])
    _diverging(ws, f"I{TABLE_FIRST_ROW}:J{last}", 2.0)
    ws.freeze_panes = ws.cell(TABLE_FIRST_ROW, 2)
    widths(ws, [24, 44, 15, 8, *[12.0] * 4, 14, 14, 10])
    page(ws, study, repeat=f"{TABLE_FIRST_ROW - 1}:{TABLE_FIRST_ROW - 1}")


def wrapped(ws: Worksheet, wide: Sequence[float], rows: range) -> None:
    """Column widths, and rows as high as their longest text needs."""
    widths(ws, wide)
    for r in rows:
        lines = 1
        for c, width in enumerate(wide, start=1):
            cell = ws.cell(r, c)
            if isinstance(cell.value, str):
                lines = max(lines, -(-len(cell.value) // max(1, int(width) - 3)))
                cell.alignment = cell_alignment(horizontal="left", vertical="top", wrap_text=True, indent=1)
            else:
                cell.alignment = cell_alignment(vertical="top")
        ws.row_dimensions[r].height = 14.0 * lines + 1.0


def _rows(frame: pd.DataFrame) -> list[Sequence[Value]]:
    """A frame's rows; what is not finite stays empty."""
    return [tuple(map(_value, row)) for row in frame.itertuples(index=False)]


def _value(value: Any) -> Value:
    return value if isinstance(value, str) else float(value) if np.isfinite(value) else None


def _diverging(ws: Worksheet, cells: str, full: float) -> None:
    """Blue below, white at, orange above zero."""
    ends = {"start_type": "num", "start_value": -full, "start_color": NEGATIVE_FILL}
    ends |= {"mid_type": "num", "mid_value": 0, "mid_color": NEUTRAL_FILL}
    ends |= {"end_type": "num", "end_value": full, "end_color": POSITIVE_FILL}
    ws.conditional_formatting.add(cells, ColorScaleRule(**ends))
