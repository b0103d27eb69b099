"""The sheets of text tables: Relations, Selection, Legend."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from openpyxl.workbook import Workbook
from openpyxl.worksheet.worksheet import Worksheet

from doe_kc import __version__
from doe_kc.influence.identifiability import COLLINEAR, NO_INFLUENCE
from doe_kc.influence.relations import Link, Relations
from doe_kc.influence.result import NONLINEAR_PERCENT, Influence
from doe_kc.influence.selection_result import Selection, Variable
from doe_kc.reporting.workbook_cells import (
    FLAGGED,
    HEADER,
    frame,
    page,
    put,
    title,
    widths,
)
from doe_kc.reporting.workbook_matrix import case_label
from doe_kc.solver.load_cases import LOAD_CASES

Value = str | float | int | None
COLUMNS = 11
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
    numbers = [f"{k}." for k in range(1, 9)]
    rows: list[Sequence[Value]] = [
        (case_label(e.characteristic.load_case), e.characteristic.label, e.characteristic.unit)
        + tuple(_link(link.parameter, link) for link in e.links)
        for e in relations.by_characteristic
    ]
    row = table(ws, 4, ("Load case", "Characteristic", "Unit", *numbers), rows)
    ws.auto_filter.ref = f"A4:K{row - 1}"
    put(ws, row + 1, 1, "Characteristics that move together", bold=True)
    groups: list[Sequence[Value]] = [
        (f"|r| >= {g.weakest:.2f}", "", "")
        + tuple(
            f"{name} ({'same' if sign > 0 else 'opposite'} sign)"
            for name, sign in zip(g.characteristics, g.signs, strict=True)
        )
        for g in relations.together
    ]
    row = table(ws, row + 2, ("Correlation", "", "", *numbers), groups)
    put(ws, row + 1, 1, "What each parameter moves most", bold=True)
    moved: list[Sequence[Value]] = [
        (e.parameter.path, e.parameter.label, e.parameter.unit)
        + tuple(_link(link.characteristic, link) for link in e.links)
        for e in relations.by_parameter
        if e.links
    ]
    table(ws, row + 2, ("Path", "Parameter", "Unit", *numbers), moved)
    widths(ws, [24, 31, 9, *[25.0] * 8])
    ws.freeze_panes = "D5"
    page(ws, study, repeat="4:4")


def _link(name: str, link: Link) -> str:
    return f"{name}  {link.percent:+.0f} %"


def selection_sheet(book: Workbook, selection: Selection | None, study: str) -> None:
    """Verdict, expected move and bounds of every variable, and the forecast; or what is needed for it."""
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
    page(ws, study, repeat="4:4")


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


def legend_sheet(
    book: Workbook, influence: Influence, study: str, date: str, notes: Mapping[str, str]
) -> None:
    """How to read the workbook, and what it was made from."""
    ws = book.create_sheet("Legend")
    title(ws, f"Legend: {study}", "How to read this workbook.")
    lines = {
        "Study": study,
        "Date": date,
        "Program": f"doe_kc {__version__}",
        "Run time": f"{influence.seconds:.1f} s",
        **notes,
        **_explanations(influence),
    }
    row = 4
    for row, (key, text) in enumerate(lines.items(), start=4):
        put(ws, row, 1, key, bold=True, vertical="top")
        put(ws, row, 2, text, wrap=True, vertical="top")
        ws.row_dimensions[row].height = 14.5 * (1 + len(text) // 118)
    frame(ws, range(4, row + 1), range(1, 3))
    widths(ws, [24, 120])
    page(ws, study)


def _explanations(influence: Influence) -> dict[str, str]:
    used = dict.fromkeys(c.load_case for c in influence.characteristics)
    windows = ", ".join(
        f"{case_label(name)} ±{LOAD_CASES[name].window:g} {LOAD_CASES[name].unit}"
        for name in used
        if name in LOAD_CASES
    )
    return {
        "Frame": "Chassis: X rearwards, Y to the right, Z up, ground z = 0; figures are the left wheel's.",
        "Signs": "Toe-in +, camber top outwards +, caster top rearwards +; forces as their load case names "
        "them. + in a cell = the characteristic grows when the parameter grows.",
        "Paths": "LLF.x is a hardpoint coordinate in mm, llr.Fx a stiffness factor (nominal 1), llr.Tx a "
        "rotational one. Both sides change alike. Bushing axes are the chassis axes, those of llf and llr "
        "turned -90 deg about Z.",
        "Steps": "One parameter at a time, raised and lowered: hardpoints ±1 mm, stiffnesses ±10 %, others "
        "as in the column Step. A change is half the difference of the two runs.",
        "Gradients": f"Least-squares line inside the default window about static: {windows}.",
        "Percent": "Change over the largest change in its column, both for their own step, rounded.",
        "Colours": "Fixed scale: blue -100 %, white 0 %, orange +100 %.",
        "Sums and ranks": "Sum of the magnitudes of a row or column in percent; rank 1 is the largest sum.",
        "Exact": "Derivative of the equilibrium equations at the nominal axle times the same step.",
        "Italic, bold, shaded": f"One-at-a-time and exact change differ by more than "
        f"{NONLINEAR_PERCENT:g} % of the larger (and by more than half a percent of the column's largest): "
        "the axle is not linear over the step.",
        "Empty cell": "No equilibrium with the step, or no such value; the reason stands under Remark.",
        "Selection: sd": "Influence counts in standard deviations of the measurement for a move by the "
        f"parameter's prior standard deviation; below {NO_INFLUENCE:g} the variable is fixed.",
        "Selection: collinearity": "Length of a variable's influence over the part that the used variables "
        f"together cannot imitate; above {COLLINEAR:g} when its turn comes, it is fixed. 'Collinear with' "
        "names the used variable that is most alike.",
        "Selection: sd after / before": "How far the measurement narrows a variable when all are free; 1 = "
        "it says nothing about it.",
        "Selection: bounds": "Default bounds; widened where the expected move ends at a bound, never across "
        "zero for what must stay positive.",
    }


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
            put(ws, r, c, value, number=number if isinstance(value, float) else None)
    frame(ws, range(row, row + len(rows) + 1), range(1, len(heads) + 1))
    return row + len(rows) + 1
