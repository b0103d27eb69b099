"""The discovery workbook: the verdict, and every number behind it."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from openpyxl.workbook import Workbook

from doe_kc.discovery.result import Discovery
from doe_kc.report.discovery_legend import DISCOVERY_LEGEND
from doe_kc.report.discovery_sheets import (
    disagreement_sheet,
    effects_sheet,
    gap_sheet,
    held_out_sheet,
    library_sheet,
    parameters_sheet,
)
from doe_kc.report.discovery_verdict_sheet import verdict_sheet
from doe_kc.report.workbook_file import new_book, write_book
from doe_kc.report.workbook_terms import terms_sheet


def discovery_workbook(
    discovery: Discovery, *, study: str, date: str, notes: Mapping[str, str] | None = None
) -> Workbook:
    """Sheets Verdict, Disagreement, Effects, Library, Gap, Held out, Parameters and Legend.

    study: name in titles and page headers. date: as it shall stand in the first sheet. notes: further lines
    of that, title -> text (axle file, measurement, ...).
    """
    book = new_book(f"Missing effects: {study}")
    verdict_sheet(book, discovery, study, date, notes or {})
    disagreement_sheet(book, discovery, study)
    effects_sheet(book, discovery, study)
    library_sheet(book, discovery, study)
    gap_sheet(book, discovery, study)
    held_out_sheet(book, discovery, study)
    parameters_sheet(book, discovery, study)
    terms_sheet(book, study, DISCOVERY_LEGEND)
    return book


def write_discovery_workbook(
    path: Path, discovery: Discovery, *, study: str, date: str, notes: Mapping[str, str] | None = None
) -> Path:
    """Write `discovery_workbook`; RunError naming path and remedy when the place is locked or full."""
    return write_book(path, discovery_workbook(discovery, study=study, date=date, notes=notes))
