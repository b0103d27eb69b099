"""The first sheet of the correlation workbook."""

from __future__ import annotations

from collections.abc import Mapping

from openpyxl.workbook import Workbook

from doe_kc import __version__
from doe_kc.correlation.assessment import Assessment
from doe_kc.correlation.result import Correlation
from doe_kc.report.correlation_parameters import remark_sentences
from doe_kc.report.correlation_rating_sheet import FINAL_RATING
from doe_kc.report.correlation_summary import summary
from doe_kc.report.workbook_cells import FLAGGED, frame, page, put, title, widths

SUMMARY_LINE_LENGTH = 110
"""Characters that fit one line of the text column."""


def summary_sheet(
    book: Workbook,
    correlation: Correlation,
    study: str,
    date: str,
    notes: Mapping[str, str],
    assessment: Assessment,
) -> None:
    """Outcome, what to think of bounds and unseen variables, and where it came from."""
    ws = book.create_sheet("Summary")
    title(ws, f"Correlation: {study}", "What the correlation reached, and what to know before using it.")
    remarks = {f"Note {i}": text for i, text in enumerate(remark_sentences(correlation), start=1)}
    made = {"Study": study, "Date": date, "Program": f"doe_kc {__version__}", **notes}
    lines = {**summary(correlation, assessment), **remarks, **made}
    for row, (key, text) in enumerate(lines.items(), start=4):
        put(ws, row, 1, key, bold=True, vertical="top", wrap=True)
        cell = put(ws, row, 2, text, wrap=True, vertical="top", bold=row <= 7)
        doubted = key == "Status" and assessment.status != "sound"
        if key in remarks or doubted or (key == "Constraints" and not correlation.feasible):
            cell.fill = FLAGGED
        ws.row_dimensions[row].height = 14.5 * (1 + len(text) // SUMMARY_LINE_LENGTH)
    row = 4 + len(lines)
    put(ws, row, 1, "Rating, live", bold=True, vertical="top")
    cell = put(ws, row, 2, None, number="0.000000", horizontal="left")
    cell.value = f"='Rating terms'!{FINAL_RATING}"
    put(ws, row + 1, 2, "with the weights, targets and intervals as they stand in the sheet Rating terms")
    frame(ws, range(4, row + 1), range(1, 3))
    widths(ws, [22, 120])
    page(ws, study)
