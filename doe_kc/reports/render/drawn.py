"""Text and tables drawn on a sheet, as a page of a browser sets them: the print that needs no browser."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from matplotlib.patches import Rectangle

from doe_kc.reports.drawing.panel import PageBox, Panel
from doe_kc.reports.drawing.sheet import Sheet
from doe_kc.reports.drawing.words import text_width
from doe_kc.reports.render.page import NUMBER_STYLE, cell_text, column_head
from doe_kc.reports.render.typeset import signs
from doe_kc.reports.table import Column, PageCell, Row, Table, ink_on

LINE = 1.32
"""Heights of the text from one line to the next."""
ROW_ROOM, CELL_ROOM = 4.2, 3.0
"""Points of a row beyond its text, and between a cell's edge and its text."""
RULE, HEAD_FILL = "#D5DADE", "#E4E8EC"


def canvas(page: Sheet) -> Panel:
    """The whole page as a panel in points, for what is drawn behind text."""
    panel = page.add_panel(PageBox(0.0, 0.0, page.width, page.height))
    panel.x.set_limits(0.0, page.width)
    panel.y.set_limits(0.0, page.height)
    for part in (panel.spines, panel.grid, panel.marks, panel.numbers):
        part.update(dict.fromkeys(part, False))
    return panel


def box(panel: Panel, left: float, bottom: float, width: float, height: float, color: str) -> None:
    """A filled rectangle, points of the page."""
    panel.add(Rectangle((left, bottom), width, height, fc=color, lw=0.0, zorder=0.2))


def wrapped(text: str, size: float, width: float, weight: str = "normal") -> list[str]:
    """Lines of at most `width` points, with the signs of print; a longer word stands alone."""
    out: list[str] = []
    for word in signs(text).split():
        longer = f"{out[-1]} {word}" if out else word
        if out and text_width(longer, size, weight) <= width:
            out[-1] = longer
        else:
            out.append(word)
    return out


def paragraph(
    page: Sheet, left: float, top: float, width: float, text: str, size: float, **look: Any
) -> float:
    """Lines of text from `top` down, points of the page; returns where they end. look: of a Word."""
    for line in wrapped(text, size, width, str(look.get("weight", "normal"))):
        top -= LINE * size
        page.write(left / page.width, (top + 0.3 * size) / page.height, line, size, **look)
    return top


@dataclass(frozen=True)
class DrawnCell:
    """Lines of a cell and how they look; numbers stand at the right edge."""

    lines: list[str]
    bold: bool
    number: bool
    fill: str = ""


def draw_table(
    page: Sheet, behind: Panel, table: Table[Row], place: tuple[float, float], width: float, size: float
) -> float:
    """The columns that the table has in a page, from `place`, its upper left corner, down; returns where it
    ends. behind: of `canvas`. Columns are as wide as their widest text, the first one takes what is left and
    wraps."""
    columns = [(c, c.page) for c in table.page_columns if c.page is not None]
    widths = [max(_width(c, p, row, size) for row in (None, *table.rows)) for c, p in columns]
    widths[0] = width - sum(widths[1:])
    left, top = place
    lines = [[_head(c, p, w, size) for (c, p), w in zip(columns, widths, strict=True)]]
    lines += [
        [_cell(c, p, row, w, size) for (c, p), w in zip(columns, widths, strict=True)] for row in table.rows
    ]
    for k, cells in enumerate(lines):
        height = LINE * size * max(len(cell.lines) for cell in cells) + ROW_ROOM
        if k == 0:
            box(behind, left, top - height, width, height, HEAD_FILL)
        start = left
        for cell, wide in zip(cells, widths, strict=True):
            if cell.fill:
                box(behind, start, top - height + 0.4, wide, height - 0.8, f"#{cell.fill}")
            _write(page, cell, (start, top - ROW_ROOM / 2.0), wide, size)
            start += wide
        top -= height
        behind.plot([left, left + width], [top, top], color=RULE, lw=0.5, zorder=0.4)
    return top


def _write(page: Sheet, cell: DrawnCell, place: tuple[float, float], width: float, size: float) -> None:
    x = place[0] + (width - CELL_ROOM if cell.number else CELL_ROOM)
    for k, line in enumerate(cell.lines):
        y = place[1] - LINE * size * (k + 0.5)
        page.write(
            x / page.width, y / page.height, line, size, "right" if cell.number else "left", "center",
            weight="bold" if cell.bold else "normal", color=f"#{ink_on(cell.fill)}",
        )  # fmt: skip


def _width(column: Column[Row], cell: PageCell[Row], row: Row | None, size: float) -> float:
    if row is None:
        text, bold = column_head(column, cell), True
    else:
        text, bold = signs(cell_text(column, cell, row)), _strong(cell, row)
    return text_width(text, size, "bold" if bold else "normal") + 2.0 * CELL_ROOM + 1.0


def _head(column: Column[Row], cell: PageCell[Row], width: float, size: float) -> DrawnCell:
    lines = wrapped(column_head(column, cell), size, width - 2.0 * CELL_ROOM, "bold")
    return DrawnCell(lines, True, _number(column, cell))


def _cell(column: Column[Row], cell: PageCell[Row], row: Row, width: float, size: float) -> DrawnCell:
    strong = _strong(cell, row)
    lines = wrapped(
        cell_text(column, cell, row), size, width - 2.0 * CELL_ROOM, "bold" if strong else "normal"
    )
    return DrawnCell(lines, strong, _number(column, cell), cell.fill(row) if cell.fill is not None else "")


def _strong(cell: PageCell[Row], row: Row) -> bool:
    return cell.strong is not None and cell.strong(row)


def _number(column: Column[Row], cell: PageCell[Row]) -> bool:
    return bool(column.number) or NUMBER_STYLE in cell.style.split()
