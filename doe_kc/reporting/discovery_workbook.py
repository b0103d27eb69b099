"""The discovery workbook: the verdict, and every number behind it."""

from __future__ import annotations

from collections.abc import Mapping
from io import BytesIO
from pathlib import Path

from openpyxl.workbook import Workbook

from doe_kc.discovery.result import Discovery
from doe_kc.output import write_whole
from doe_kc.reporting.correlation_legend import legend_sheet
from doe_kc.reporting.discovery_legend import LEGEND
from doe_kc.reporting.discovery_sheets import (
    disagreement_sheet,
    effects_sheet,
    gap_sheet,
    held_out_sheet,
    library_sheet,
    parameters_sheet,
)
from doe_kc.reporting.discovery_verdict_sheet import verdict_sheet
from doe_kc.reporting.workbook_cells import clean


def discovery_workbook(
    found: Discovery, *, study: str, date: str, notes: Mapping[str, str] | None = None
) -> Workbook:
    """Sheets Verdict, Disagreement, Effects, Library, Gap, Held out, Parameters and Legend.

    study: name in titles and page headers. date: as it shall stand in the first sheet. notes: further lines
    of that, title -> text (axle file, measurement, ...).
    """
    book = Workbook()
    book.remove(book.active)
    verdict_sheet(book, found, study, date, notes or {})
    disagreement_sheet(book, found, study)
    effects_sheet(book, found, study)
    library_sheet(book, found, study)
    gap_sheet(book, found, study)
    held_out_sheet(book, found, study)
    parameters_sheet(book, found, study)
    legend_sheet(book, study, LEGEND)
    book.properties.title = clean(f"Missing effects: {study}")
    book.properties.creator = "doe_kc"
    return book


def write_discovery_workbook(
    path: Path, found: Discovery, *, study: str, date: str, notes: Mapping[str, str] | None = None
) -> Path:
    """Write `discovery_workbook`; RunError naming path and remedy when the place is locked or full."""
    content = BytesIO()
    discovery_workbook(found, study=study, date=date, notes=notes).save(content)
    return write_whole(path, lambda beside: beside.write_bytes(content.getvalue()))
