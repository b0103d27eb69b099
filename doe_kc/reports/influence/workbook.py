"""The influence workbook that a test engineer prints and filters."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from openpyxl.workbook import Workbook
from openpyxl.worksheet.worksheet import Worksheet

from doe_kc import __version__
from doe_kc.load_cases import LOAD_CASES, case_label
from doe_kc.parameter_influence.global_sensitivity import GlobalSensitivity
from doe_kc.parameter_influence.identifiability import COLLINEAR, NO_INFLUENCE
from doe_kc.parameter_influence.relations import Relations
from doe_kc.parameter_influence.selection_result import Selection
from doe_kc.parameter_influence.study import NONLINEAR_PERCENT, Influence
from doe_kc.reports.influence.global_tables import convergence_table, disagreement_table, global_table
from doe_kc.reports.influence.global_words import GLOBAL_LEGEND
from doe_kc.reports.influence.sheets import absolute_sheet, exact_sheet, influence_sheet
from doe_kc.reports.influence.tables import (
    characteristic_links_table,
    forecast_table,
    parameter_links_table,
    selection_table,
    together_table,
)
from doe_kc.reports.render.cells import page, put, title
from doe_kc.reports.render.workbook import lines_sheet, new_book, put_table, table_sheet, write_book
from doe_kc.reports.table import Table

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
LEGEND_LINE_LENGTH, LEGEND_KEY_WIDTH = 115, 28.0
"""Characters that fit one line of the text column, and of the terms' column."""


@dataclass(frozen=True)
class InfluenceBook:
    """What the workbook tells beside the influences.

    study: name in titles and page headers. date: as it shall stand in the legend. selection: None without
    measured differences. notes: further lines of the legend, title -> text (axle file, measurement, ...).
    windows: load case -> half-width of the fit window where it is not the default. overall: global
    sensitivities, None where none were asked for.
    """

    influence: Influence
    relations: Relations
    study: str
    date: str
    selection: Selection | None = None
    notes: Mapping[str, str] = field(default_factory=dict)
    windows: Mapping[str, float] = field(default_factory=dict)
    overall: GlobalSensitivity | None = None

    def workbook(self) -> Workbook:
        """Sheets Influence (as Appendix C), Absolute, Exact, Relations, Selection, Global and its convergence
        where it was asked for, and Legend."""
        book = new_book(f"Parameter influence: {self.study}")
        for fill in (influence_sheet, absolute_sheet, exact_sheet):
            fill(book, self.influence, self.study)
        _relations_sheet(book, self.relations, self.study)
        _selection_sheet(book, self.selection, self.study)
        if self.overall is not None:
            table_sheet(book, global_table(self.overall), self.study)
            table_sheet(book, disagreement_table(self.overall), self.study)
            table_sheet(book, convergence_table(self.overall), self.study)
        lines = list(_legend_lines(self).items())
        remark = "How to read this workbook."
        width = LEGEND_KEY_WIDTH
        lines_sheet(
            book, "Legend", "Legend", remark, lines, self.study, length=LEGEND_LINE_LENGTH, key_width=width
        )
        return book

    def write(self, path: Path) -> Path:
        """Write `workbook`; returns its path. RunError as `write_book`."""
        return write_book(path, self.workbook())


def _relations_sheet(book: Workbook, relations: Relations, study: str) -> None:
    """Strongest parameters of each characteristic and the reverse, and what moves together."""
    ws = table_sheet(book, characteristic_links_table(relations), study)
    _below(ws, together_table(relations), column=1)
    _below(ws, parameter_links_table(relations), column=1)


def _selection_sheet(book: Workbook, selection: Selection | None, study: str) -> None:
    """Verdict, expected move and bounds of every variable, and the forecast; or what is needed."""
    if selection is not None:
        _below(table_sheet(book, selection_table(selection), study), forecast_table(selection), column=2)
        return
    ws = book.create_sheet("Selection")
    title(ws, f"Selection of variables: {study}", "No measured differences were given.")
    put(ws, 4, 1, "Name a measurement in the study (or give --measurement DIR) to fill this sheet.")
    page(ws, study)


def _below(ws: Worksheet, table: Table[Any], *, column: int) -> None:
    """A further table with its name above it."""
    row = ws.max_row + 2
    put(ws, row, column, table.name, bold=True)
    put_table(ws, table, start=row + 1)


def _legend_lines(book: InfluenceBook) -> dict[str, str]:
    """Study, date, program and notes of the caller; then signs, units, steps, windows and colours."""
    return {
        "Study": book.study,
        "Date": book.date,
        "Program": f"doe_kc {__version__}",
        "Run time": f"{book.influence.seconds:.1f} s",
        **book.notes,
        **MATRIX,
        "Gradients": _gradients(book.influence, book.windows),
        **SELECTION,
        **(GLOBAL_LEGEND if book.overall is not None else {}),
    }


def _gradients(influence: Influence, windows: Mapping[str, float]) -> str:
    cases = dict.fromkeys(c.load_case for c in influence.characteristics)
    listed = ", ".join(
        f"{case_label(name)} ±{windows.get(name, LOAD_CASES[name].window):g} {LOAD_CASES[name].unit}"
        for name in cases
        if name in LOAD_CASES
    )
    return f"Slope of the least-squares line about static, fitted within: {listed}."
