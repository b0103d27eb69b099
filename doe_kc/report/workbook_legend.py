"""The sheet that says how to read the others, and what they were made from."""

from __future__ import annotations

from collections.abc import Mapping

from openpyxl.workbook import Workbook

from doe_kc import __version__
from doe_kc.influence.identifiability import COLLINEAR, NO_INFLUENCE
from doe_kc.influence.result import NONLINEAR_PERCENT, Influence
from doe_kc.load_cases import LOAD_CASES
from doe_kc.report.names import case_label
from doe_kc.report.render.cells import frame, page, put, title, widths

MATRIX = {
    "Frame": "Chassis: X rearwards, Y to the right, Z up, ground z = 0. Values are the left wheel's.",
    "Signs": "Toe-in +, camber top outwards +, caster top rearwards +; forces as their load case has them. "
    "+ in a cell: the characteristic grows when the parameter grows.",
    "Paths": "LLF.x is a hardpoint coordinate in mm, llr.Fx a stiffness factor (nominal 1), llr.Tx a "
    "rotational one. Both sides change alike. Bushing axes are the chassis axes; those of llf and llr are "
    "turned -90 deg about Z.",
    "Steps": "One parameter at a time, raised and lowered: hardpoints ±1 mm, stiffnesses ±10 %, others as "
    "in the column Step. A change is half the difference of the two runs.",
    "Percent": "Change over the largest change in its column, each for its own step, rounded.",
    "Colours": "Fixed scale: blue -100 %, white 0 %, orange +100 %.",
    "Sums and ranks": "Sum of the magnitudes of a row or column in percent; rank 1 is the largest sum.",
    "Exact": "Derivative of the equilibrium equations at the nominal axle times the same step.",
    "Italic, bold, shaded": f"One-at-a-time and exact change differ by more than {NONLINEAR_PERCENT:g} % "
    "of the larger (and by more than half a percent of the column's largest): the axle is not linear over "
    "the step.",
    "Empty cell": "No equilibrium with the step, or no such value; the reason is in the last column.",
}
SELECTION = {
    "Selection: sd": "Influence counts in standard deviations of the measurement for a move by the "
    f"parameter's prior standard deviation; below {NO_INFLUENCE:g} the variable is fixed.",
    "Selection: collinearity": "Length of a variable's influence over the part of it that the used "
    f"variables together cannot imitate; above {COLLINEAR:g} when its turn comes, it is fixed. "
    "'Collinear with' names the used variable that is most alike.",
    "Selection: sd after / before": "How far the measurement narrows a variable when all are free; "
    "1 = it says nothing about it.",
    "Selection: bounds": "Default bounds, widened where the expected move ends at a bound; never across "
    "zero for what must stay positive.",
}
LEGEND_LINE_LENGTH = 115
"""Characters that fit one line of the text column."""


def legend_sheet(
    book: Workbook,
    influence: Influence,
    study: str,
    date: str,
    *,
    notes: Mapping[str, str],
    windows: Mapping[str, float],
) -> None:
    """Study, date, program and notes of the caller; then signs, units, steps, windows and colours."""
    ws = book.create_sheet("Legend")
    title(ws, f"Legend: {study}", "How to read this workbook.")
    lines = {
        "Study": study,
        "Date": date,
        "Program": f"doe_kc {__version__}",
        "Run time": f"{influence.seconds:.1f} s",
        **notes,
        **MATRIX,
        "Gradients": _gradients(influence, windows),
        **SELECTION,
    }
    for row, (key, text) in enumerate(lines.items(), start=4):
        put(ws, row, 1, key, bold=True, vertical="top", wrap=True)
        put(ws, row, 2, text, wrap=True, vertical="top")
        ws.row_dimensions[row].height = 14.5 * (1 + max(len(text) // LEGEND_LINE_LENGTH, len(key) // 26))
    frame(ws, range(4, 4 + len(lines)), range(1, 3))
    widths(ws, [28, 120])
    page(ws, study)


def _gradients(influence: Influence, windows: Mapping[str, float]) -> str:
    cases = dict.fromkeys(c.load_case for c in influence.characteristics)
    listed = ", ".join(
        f"{case_label(name)} ±{windows.get(name, LOAD_CASES[name].window):g} {LOAD_CASES[name].unit}"
        for name in cases
        if name in LOAD_CASES
    )
    return f"Slope of the least-squares line about static, fitted within: {listed}."
