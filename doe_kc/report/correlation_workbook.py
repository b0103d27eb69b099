"""The correlation workbook: what came out, from what, and a rating sheet to try other weights in."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from openpyxl.workbook import Workbook

from doe_kc.correlation.assessment import Assessment, assess
from doe_kc.correlation.result import Correlation
from doe_kc.report.correlation_legend import CORRELATION_LEGEND
from doe_kc.report.correlation_rating_sheet import rating_sheet
from doe_kc.report.correlation_sheets import (
    characteristics_sheet,
    curves_sheet,
    evaluations_sheet,
    parameters_sheet,
)
from doe_kc.report.correlation_summary_sheet import summary_sheet
from doe_kc.report.workbook_file import new_book, write_book
from doe_kc.report.workbook_terms import terms_sheet


def correlation_workbook(
    correlation: Correlation,
    *,
    study: str,
    date: str,
    notes: Mapping[str, str] | None = None,
    assessment: Assessment | None = None,
) -> Workbook:
    """Sheets Summary, Characteristics, Parameters, Curves, Evaluations, Rating terms and Legend.

    study: name in titles and page headers. date: as it shall stand in the summary. notes: further lines of
    the summary, title -> text (axle file, measurement, ...). assessment: by default the correlation's own.
    """
    book = new_book(f"Correlation: {study}")
    summary_sheet(book, correlation, study, date, notes or {}, assessment or assess(correlation))
    characteristics_sheet(book, correlation, study)
    parameters_sheet(book, correlation, study)
    curves_sheet(book, correlation, study)
    evaluations_sheet(book, correlation, study)
    rating_sheet(book, correlation, study)
    terms_sheet(book, study, CORRELATION_LEGEND)
    return book


def write_correlation_workbook(
    path: Path,
    correlation: Correlation,
    *,
    study: str,
    date: str,
    notes: Mapping[str, str] | None = None,
    assessment: Assessment | None = None,
) -> Path:
    """Write `correlation_workbook`; RunError naming path and remedy when the place is locked or full."""
    book = correlation_workbook(correlation, study=study, date=date, notes=notes, assessment=assessment)
    return write_book(path, book)
