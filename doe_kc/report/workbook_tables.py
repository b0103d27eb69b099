"""The sheets of tables: Relations and Selection."""

from __future__ import annotations

from collections.abc import Sequence

from openpyxl.workbook import Workbook

from doe_kc.influence.relations import STRONG_PERCENT, Link, Relations
from doe_kc.influence.selection_result import Selection, VariableAdvice
from doe_kc.report.names import case_label
from doe_kc.report.render.cells import (
    FLAGGED,
    PAPER_A3,
    page,
    put,
    title,
    widths,
)
from doe_kc.report.workbook_table import TABLE_FIRST_ROW, Value, table

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
        f"Entries of {STRONG_PERCENT:g} % and more of the column's largest, strongest first; "
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
    last = table(ws, ("Load case", "Characteristic", "Unit", *numbers), rows)
    put(ws, last + 2, 1, "Characteristics that move together", bold=True)
    groups: list[Sequence[Value]] = [
        (
            f"|r| of {g.weakest:.3f} and more",
            "",
            "",
            *(_member(name, sign) for name, sign in zip(g.characteristics, g.signs, strict=True)),
        )
        for g in relations.together
    ]
    last = table(ws, ("Correlation", "", "", *numbers), groups, start=last + 3, filtered=False)
    put(ws, last + 2, 1, "What each parameter moves most", bold=True)
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
    table(ws, ("Path", "Parameter", "Unit", *numbers), moved, start=last + 3, filtered=False)
    widths(ws, [25, 40, 9, *[40.0] * relations.longest])
    ws.freeze_panes = "D5"
    page(ws, study, paper=PAPER_A3)


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
    last = table(ws, VARIABLE_HEADS, [_variable(v) for v in selection.variables], formats="0.000")
    for k, variable in enumerate(selection.variables, start=TABLE_FIRST_ROW):
        if variable.at_bound:
            for c in range(1, len(VARIABLE_HEADS) + 1):
                ws.cell(k, c).fill = FLAGGED
    put(ws, last + 2, 2, "Forecast with these moves (linear)", bold=True)
    outcomes: list[Sequence[Value]] = [
        ("", o.characteristic, o.unit, o.baseline, o.target, o.sd, o.expected, o.before, o.after)
        for o in selection.outcomes
    ]
    table(ws, OUTCOME_HEADS, outcomes, formats="0.0000", start=last + 3, filtered=False)
    widths(ws, [7, 32, 34, 13, 32, 13, 18, 16, 11, 11, 15, 15, 11, 11, 44])
    ws.freeze_panes = "C5"
    page(ws, study, paper=PAPER_A3, single=True)


def _summary(selection: Selection) -> str:
    used = sum(v.used for v in selection.variables)
    bound = sum(bool(v.at_bound) for v in selection.variables)
    return (
        f"{used} of {len(selection.variables)} variables to use, {bound} of them at a bound; rank "
        f"{selection.rank}, {selection.informed} directions known better than before, "
        f"condition of the used ones {selection.condition:.3g}."
    )


def _variable(v: VariableAdvice) -> Sequence[Value]:
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
