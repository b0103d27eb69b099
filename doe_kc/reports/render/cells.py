"""Cells of a workbook: one look, and text that never becomes a formula."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from functools import lru_cache

import numpy as np
from openpyxl.cell.cell import Cell
from openpyxl.comments import Comment
from openpyxl.formatting.rule import ColorScaleRule
from openpyxl.styles import Alignment, Border, Font, PatternFill, Side
from openpyxl.utils import get_column_letter
from openpyxl.worksheet.worksheet import Worksheet

from doe_kc.reports.table import NEGATIVE_FILL, NEUTRAL_FILL, POSITIVE_FILL


class CellFont(Font):  # type: ignore[misc]
    """With `CellAlignment`, `CellBorder`, `CellFill`: looks made once and known by identity.

    A workbook finds the number of a look by its hash, which openpyxl computes anew of thirty fields for
    every cell: half of the time that a sheet takes. What is written of a look, openpyxl lists for each class
    anew, so that it is repeated here.
    """

    __attrs__, __nested__, __elements__ = Font.__attrs__, Font.__nested__, Font.__elements__
    __hash__, __eq__ = object.__hash__, object.__eq__


class CellAlignment(Alignment):  # type: ignore[misc]
    """See `CellFont`."""

    __attrs__, __nested__, __elements__ = Alignment.__attrs__, Alignment.__nested__, Alignment.__elements__
    __hash__, __eq__ = object.__hash__, object.__eq__


class CellBorder(Border):  # type: ignore[misc]
    """See `CellFont`."""

    __attrs__, __nested__, __elements__ = Border.__attrs__, Border.__nested__, Border.__elements__
    __hash__, __eq__ = object.__hash__, object.__eq__


class CellFill(PatternFill):  # type: ignore[misc]
    """See `CellFont`."""

    __attrs__, __nested__, __elements__ = (
        PatternFill.__attrs__,
        PatternFill.__nested__,
        PatternFill.__elements__,
    )
    __hash__, __eq__ = object.__hash__, object.__eq__


cell_font, cell_alignment = lru_cache(CellFont), lru_cache(CellAlignment)

HEADER_FILL = CellFill("solid", fgColor="E4E8EC")
FLAGGED = CellFill("solid", fgColor="FBE3F0")
MUTED = "8A9199"
THIN, THICK = Side(style="thin", color="C3C9CF"), Side(style="medium", color="3C4650")
PAPER_A4 = 9
"""As the file format numbers paper sizes."""
LONGEST_TEXT = 32_000
_FORBIDDEN = re.compile(r"[\x00-\x08\x0b\x0c\x0e-\x1f\x7f\ufffe\uffff\ud800-\udfff]")
_FORMULA = ("=", "+", "-", "@", "\t", "\r")


def clean(text: str) -> str:
    """Text that a workbook can hold: control characters replaced, not longer than a cell takes."""
    return _FORBIDDEN.sub("\N{REPLACEMENT CHARACTER}", text)[:LONGEST_TEXT]


def put(
    ws: Worksheet,
    row: int,
    column: int,
    value: str | float | int | None,
    *,
    bold: bool = False,
    italic: bool = False,
    color: str | None = None,
    fill: PatternFill | None = None,
    number: str | None = None,
    horizontal: str | None = None,
    vertical: str = "center",
    rotation: int = 0,
    wrap: bool = False,
    indent: int = 0,
) -> Cell:
    """Write one cell. Text stays text whatever it begins with; nan and None stay empty."""
    cell = ws.cell(row, column)
    if isinstance(value, str):
        put_text(cell, value)
    elif value is not None and np.isfinite(value):
        cell.value = value
    cell.font = cell_font(name="Calibri", size=10, bold=bold, italic=italic, color=color)
    cell.alignment = cell_alignment(
        horizontal=horizontal,
        vertical=vertical,
        textRotation=rotation,
        wrap_text=wrap,
        indent=indent,
    )
    if fill is not None:
        cell.fill = fill
    if number is not None:
        cell.number_format = number
    return cell


def put_text(cell: Cell, text: str) -> None:
    """Text as text: the type is forced, and the quote mark keeps it text when a user edits the cell."""
    cell.value = clean(text)
    cell.data_type = "s"
    cell.quotePrefix = clean(text).startswith(_FORMULA)


def remark(cell: Cell, text: str) -> None:
    """A comment that shows when the pointer rests on the cell."""
    comment = Comment(clean(text), "doe_kc")
    comment.width, comment.height = 320, 90
    cell.comment = comment


def title(ws: Worksheet, text: str, below: str) -> None:
    """Rows 1 and 2: what the sheet is, and how to read it."""
    put(ws, 1, 1, text).font = Font(name="Calibri", size=14, bold=True)
    put(ws, 2, 1, below, color=MUTED)


def colour_scale(ws: Worksheet, cells: str) -> None:
    """-100 blue, 0 white, +100 orange, fixed: the same percent has the same colour in every study."""
    ws.conditional_formatting.add(
        cells,
        ColorScaleRule(
            start_type="num",
            start_value=-100,
            start_color=NEGATIVE_FILL,
            mid_type="num",
            mid_value=0,
            mid_color=NEUTRAL_FILL,
            end_type="num",
            end_value=100,
            end_color=POSITIVE_FILL,
        ),
    )


def widths(ws: Worksheet, values: Sequence[float]) -> None:
    """Column widths in characters, from the first column on."""
    for i, width in enumerate(values, start=1):
        ws.column_dimensions[get_column_letter(i)].width = width


@lru_cache
def _border(left: bool, right: bool, top: bool, bottom: bool) -> CellBorder:
    """Which lines are thick."""
    sides = {"left": left, "right": right, "top": top, "bottom": bottom}
    return CellBorder(**{name: THICK if thick else THIN for name, thick in sides.items()})


def frame(
    ws: Worksheet,
    rows: range,
    columns: range,
    *,
    thick_above: Iterable[int] = (),
    thick_left: Iterable[int] = (),
) -> None:
    """Thin lines everywhere, thick ones above the rows and left of the columns named."""
    above, left = set(thick_above), set(thick_left)
    for r in rows:
        for c in columns:
            ws.cell(r, c).border = _border(c in left, c + 1 in left, r in above, r + 1 in above)


def page(ws: Worksheet, study: str, *, repeat: str | None = None, single: bool = False) -> None:
    """Landscape A4, as wide as the paper (or on one page), study and sheet on top, page numbers below."""
    ws.page_setup.orientation = "landscape"
    ws.page_setup.paperSize = PAPER_A4
    ws.page_setup.fitToWidth, ws.page_setup.fitToHeight = 1, int(single)
    ws.sheet_properties.pageSetUpPr.fitToPage = True
    ws.print_options.horizontalCentered = True
    ws.page_margins.left = ws.page_margins.right = 0.4
    ws.page_margins.top = ws.page_margins.bottom = 0.6
    ws.page_margins.header = ws.page_margins.footer = 0.25
    # "&" starts a code in headers, so a literal one is doubled.
    ws.oddHeader.left.text = clean(study)[:100].replace("&", "&&")
    ws.oddHeader.right.text = "&A"
    ws.oddFooter.left.text = "doe_kc"
    ws.oddFooter.right.text = "&P / &N"
    if repeat is not None:
        ws.print_title_rows = repeat
