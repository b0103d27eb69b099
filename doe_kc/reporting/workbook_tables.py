"""The sheets of tables: Relations and Selection."""

from __future__ import annotations

from collections.abc import Sequence

from openpyxl.utils import get_column_letter
from openpyxl.workbook import Workbook
from openpyxl.worksheet.worksheet import Worksheet

from doe_kc.influence.relations import Link, Relations
from doe_kc.influence.selection_result import Selection, Variable
from doe_kc.reporting.workbook_cells import (
    A3,
    FLAGGED,
    HEADER,
    frame,
    page,
    put,
    title,
    widths,
)
from doe_kc.reporting.workbook_matrix import case_label

Value = str | float | int | None
VARIABLE_HEADS = (
    "Order",
    "Path",
    "Verdict",
    "Influence, sd",
    "Moves most",
    "Collinearity",
    "Most alike",
    "sd after / before",
    "Unit",
    "Nominal",
    "Expected move",
    "Expected value",
    "Lower",
    "Upper",
    "Note",
)
OUTCOME_HEADS = (
    "",
    "Characteristic",
    "Unit",
    "Baseline",
    "Target",
    "sd",
    "Expected",
    "Before, sd",
    "After, sd",
)


def relations_sheet(book: Workbook, relations: Relations, study: str) -> None:
    """Strongest parameters of each characteristic and the reverse, and what moves together."""
    ws = book.create_sheet("Relations")
    title(
        ws,
        f"Relations: {study}",
        f"Entries of {relations.threshold:g} % and more of the column's largest, strongest first; "
        "+ = both grow together.",
    )
    numbers = [f"{k}." for k in range(1, relations.longest + 1)]
    rows: list[Sequence[Value]] = [
        (
            case_label(e.characteristic.load_case),
            e.characteristic.label,
            e.characteristic.unit,
            *(_link(link.parameter, link) for link in e.links),
        )
        for e in relations.by_characteristic
    ]
    row = table(ws, 4, ("Load case", "Characteristic", "Unit", *numbers), rows)
    ws.auto_filter.ref = f"A4:{get_column_letter(3 + relations.longest)}{row - 1}"
    put(ws, row + 1, 1, "Characteristics that move together", bold=True)
    groups: list[Sequence[Value]] = [
        (
            f"|r| of {g.weakest:.3f} and more",
            "",
            "",
            *(_member(name, sign) for name, sign in zip(g.characteristics, g.signs, strict=True)),
        )
        for g in relations.together
    ]
    row = table(ws, row + 2, ("Correlation", "", "", *numbers), groups)
    put(ws, row + 1, 1, "What each parameter moves most", bold=True)
    moved: list[Sequence[Value]] = [
        (
            e.parameter.path,
            e.parameter.label,
            e.parameter.unit,
            *(_link(link.characteristic, link) for link in e.links),
        )
        for e in relations.by_parameter
        if e.links
    ]
    table(ws, row + 2, ("Path", "Parameter", "Unit", *numbers), moved)
    widths(ws, [25, 40, 9, *[40.0] * relations.longest])
    ws.freeze_panes = "D5"
    page(ws, study, paper=A3)


def _member(name: str, sign: int) -> str:
    return name if sign > 0 else f"{name} (opposite)"


def _link(name: str, link: Link) -> str:
    return f"{name}  {link.percent:+.0f} %"


def selection_sheet(book: Workbook, selection: Selection | None, study: str) -> None:
    """Verdict, expected move and bounds of every variable, and the forecast; or what is needed."""
    ws = book.create_sheet("Selection")
    if selection is None:
        title(ws, f"Selection of variables: {study}", "No measured differences were given.")
        put(ws, 4, 1, "Name a measurement in the study (or give --measurement DIR) to fill this sheet.")
        page(ws, study)
        return
    title(ws, f"Selection of variables: {study}", _summary(selection))
    row = table(ws, 4, VARIABLE_HEADS, [_variable(v) for v in selection.variables], number="0.000")
    ws.auto_filter.ref = f"A4:O{row - 1}"
    for k, variable in enumerate(selection.variables, start=5):
        if variable.at_bound:
            for c in range(1, len(VARIABLE_HEADS) + 1):
                ws.cell(k, c).fill = FLAGGED
    put(ws, row + 1, 2, "Forecast with these moves (linear)", bold=True)
    outcomes: list[Sequence[Value]] = [
        ("", o.characteristic, o.unit, o.baseline, o.target, o.sd, o.expected, o.before, o.after)
        for o in selection.outcomes
    ]
    table(ws, row + 2, OUTCOME_HEADS, outcomes, number="0.0000")
    widths(ws, [7, 32, 34, 13, 32, 13, 18, 16, 11, 11, 15, 15, 11, 11, 44])
    ws.freeze_panes = "C5"
    page(ws, study, paper=A3, single=True)


def _summary(selection: Selection) -> str:
    used = sum(v.used for v in selection.variables)
    bound = sum(bool(v.at_bound) for v in selection.variables)
    return (
        f"{used} of {len(selection.variables)} variables to use, {bound} of them at a bound; rank "
        f"{selection.rank}, {selection.informed} directions known better than before, "
        f"condition of the used ones {selection.condition:.3g}."
    )


def _variable(v: Variable) -> Sequence[Value]:
    p = v.parameter
    note = ""
    if v.at_bound:
        note = f"move ends at the {v.at_bound} bound" + ("; bound widened" if v.widened else "")
    collinearity: Value = v.collinearity if v.collinearity < 1e6 else "imitated"
    return (
        v.pivot,
        p.path,
        v.verdict,
        v.influence,
        v.strongest,
        collinearity,
        v.partner,
        v.posterior_ratio,
        p.unit,
        p.nominal,
        v.move,
        p.nominal + v.move,
        v.lower,
        v.upper,
        note,
    )


def table(
    ws: Worksheet,
    row: int,
    heads: Sequence[str],
    rows: Sequence[Sequence[Value]],
    *,
    number: str = "0.00",
) -> int:
    """Heads in `row`, rows below; returns the next free row."""
    for c, text in enumerate(heads, start=1):
        put(ws, row, c, text, bold=True, fill=HEADER, wrap=True)
    for r, values in enumerate(rows, start=row + 1):
        for c, value in enumerate(values, start=1):
            if isinstance(value, str):
                put(ws, r, c, value, horizontal="left", indent=1)
            else:
                put(ws, r, c, value, number=number if isinstance(value, float) else None)
    frame(ws, range(row, row + len(rows) + 1), range(1, len(heads) + 1))
    return row + len(rows) + 1
