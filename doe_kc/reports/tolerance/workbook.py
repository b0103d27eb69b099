"""tolerance.xlsx: scatter of the characteristics, contributions, what to tighten, and how to read them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from openpyxl.utils import get_column_letter
from openpyxl.workbook import Workbook

from doe_kc import __version__
from doe_kc.ground.numbers import number
from doe_kc.production_scatter.result import Tolerance
from doe_kc.reports.render.cells import cell_alignment, colour_scale, put
from doe_kc.reports.render.workbook import TABLE_FIRST_ROW, lines_sheet, new_book, table_sheet, write_book
from doe_kc.reports.table import Table
from doe_kc.reports.tolerance.contributions import contribution_matrix, reduction_matrix
from doe_kc.reports.tolerance.scatter import band_table, scatter_table
from doe_kc.reports.tolerance.tables import tightening_table, tolerance_table
from doe_kc.reports.tolerance.words import conclusions

MATRIX_HEADS = 2
"""Columns of a matrix before its characteristics."""
TOLERANCE_LEGEND = (
    ("Car", "One draw of all scattering parameters, each side its own, solved by the true solver."),
    ("Standard deviation", "Of the characteristic over the cars; its standard error counts the kurtosis."),
    ("By slopes alone", "Standard deviation of first order: slopes of the unchanged axle and the covariance "
     "of the parameters."),
    ("Variance that slopes explain", "1 - variance of (car minus its first order) over the variance of the "
     "cars; below 95 % the characteristic is not linear over the scatter, and its row is shaded."),
    ("Cars outside", "Share of the cars beyond the requirement, with Wilson's interval of 95 % confidence."),
    ("First order", "Share of the variance that a parameter takes part in by its slope, with the "
     "correlations: Cov(y, slope times deviation) / Var(y). The shares add up to 100 %."),
    ("Total", "From the cars: what slopes miss is fitted by squares and products of deviations (ridge "
     "regression, the penalty by leaving one car out), and every term is counted for each parameter in it."),
    ("Not attributed", "Below the totals: share of the variance that slopes and fit together miss."),
    ("Tightening", "The same cars with one parameter's deviations halved or doubled; each car's change is "
     "of first order, on top of what the true solver gave for it."),
    ("Bands", "At each input 95 % of the cars lie between the 2.5 and the 97.5 percent of the curves."),
)  # fmt: skip


def write_tolerance_workbook(path: Path, tolerance: Tolerance, *, study: str, date: str) -> Path:
    """Sheets Summary, Characteristics, Tightening, First order, Total, Reduction, Bands, Scatter and Legend;
    RunError as `write_book`."""
    book = new_book(f"Tolerance: {study}")
    sentences = [(str(k), text) for k, text in enumerate(conclusions(tolerance), start=1)]
    lines_sheet(book, "Summary", "Production scatter", "What follows.", sentences, study, key_width=6.0)
    table_sheet(book, tolerance_table(tolerance), study)
    table_sheet(book, tightening_table(tolerance), study)
    _matrix(book, contribution_matrix(tolerance, "first"), study)
    _matrix(book, contribution_matrix(tolerance, "total"), study)
    _unexplained(book, tolerance)
    _matrix(book, reduction_matrix(tolerance), study)
    table_sheet(book, band_table(tolerance), study)
    table_sheet(book, scatter_table(tolerance), study)
    facts = [
        ("Study", study),
        ("Date", date),
        ("Program", f"doe_kc {__version__}"),
        (
            "Cars",
            f"{tolerance.n}, seed {tolerance.seed}; {len(tolerance.failures)} without equilibrium left out",
        ),
        ("Slopes", tolerance.first_order.source),
    ]
    lines_sheet(book, "Legend", "Legend", "How to read this workbook.", [*facts, *TOLERANCE_LEGEND], study,
                key_width=28.0)  # fmt: skip
    return write_book(path, book)


def _matrix(book: Workbook, table: Table[Any], study: str) -> None:
    """Heads upright, as the columns are narrow; colours from white at 0 to full at 100 %."""
    ws, columns = table_sheet(book, table, study), table.sheet_columns
    head = TABLE_FIRST_ROW - 1
    for c in range(MATRIX_HEADS + 1, len(columns) + 1):
        ws.cell(head, c).alignment = cell_alignment(textRotation=90, horizontal="center", vertical="bottom")
    ws.row_dimensions[head].height = 5.2 * max(len(c.head or "") for c in columns)
    first, last = get_column_letter(MATRIX_HEADS + 1), get_column_letter(len(columns))
    colour_scale(ws, f"{first}{TABLE_FIRST_ROW}:{last}{head + len(table.rows)}")


def _unexplained(book: Workbook, tolerance: Tolerance) -> None:
    """Below the totals, what they leave open."""
    ws = book["Total"]
    row = ws.max_row + 2
    put(ws, row, 1, "Not attributed, at most, %", bold=True)
    for k, share in enumerate(tolerance.totals.unexplained):
        put(ws, row, MATRIX_HEADS + 1 + k, float(number(100.0 * float(share), 2)), number="0.0")
