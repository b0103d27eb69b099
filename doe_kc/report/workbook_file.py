"""A workbook as a file: begun without sheets, written whole."""

from __future__ import annotations

from io import BytesIO
from pathlib import Path

from openpyxl.workbook import Workbook

from doe_kc.ground.output import write_whole
from doe_kc.report.render.cells import clean


def new_book(title: str) -> Workbook:
    """Without a sheet; the title stands in the file's properties."""
    book = Workbook()
    book.remove(book.active)
    book.properties.title = clean(title)
    book.properties.creator = "doe_kc"
    return book


def write_book(path: Path, book: Workbook) -> Path:
    """The path, its old file whole until the new one is complete.

    RunError naming path and remedy when the place is locked, read-only or full.
    """
    # Into memory first: a full disk then meets plain bytes, not a half-made archive.
    content = BytesIO()
    book.save(content)
    return write_whole(path, lambda beside: beside.write_bytes(content.getvalue()))
