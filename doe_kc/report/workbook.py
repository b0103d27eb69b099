"""The influence workbook that a test engineer prints and filters."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from openpyxl.workbook import Workbook

from doe_kc.parameter_influence.relations import Relations
from doe_kc.parameter_influence.result import Influence
from doe_kc.parameter_influence.selection_result import Selection
from doe_kc.report.workbook_file import new_book, write_book
from doe_kc.report.workbook_legend import legend_sheet
from doe_kc.report.workbook_matrix import absolute_sheet, exact_sheet, influence_sheet
from doe_kc.report.workbook_tables import relations_sheet, selection_sheet


def influence_workbook(
    influence: Influence,
    *,
    relations: Relations,
    study: str,
    date: str,
    selection: Selection | None = None,
    notes: Mapping[str, str] | None = None,
    windows: Mapping[str, float] | None = None,
) -> Workbook:
    """Sheets Influence (as Appendix C), Absolute, Exact, Relations, Selection and Legend.

    study: name in titles and page headers. date: as it shall stand in the legend.
    notes: further lines of the legend, title -> text (axle file, measurement, ...).
    windows: load case -> half-width of the fit window where it is not the default.
    """
    book = new_book(f"Parameter influence: {study}")
    influence_sheet(book, influence, study)
    absolute_sheet(book, influence, study)
    exact_sheet(book, influence, study)
    relations_sheet(book, relations, study)
    selection_sheet(book, selection, study)
    legend_sheet(book, influence, study, date, notes=notes or {}, windows=windows or {})
    return book


def write_influence_workbook(
    path: Path,
    influence: Influence,
    *,
    relations: Relations,
    study: str,
    date: str,
    selection: Selection | None = None,
    notes: Mapping[str, str] | None = None,
    windows: Mapping[str, float] | None = None,
) -> Path:
    """Write `influence_workbook`; returns its path. RunError as `write_book`."""
    book = influence_workbook(
        influence,
        relations=relations,
        study=study,
        date=date,
        selection=selection,
        notes=notes,
        windows=windows,
    )
    return write_book(path, book)
