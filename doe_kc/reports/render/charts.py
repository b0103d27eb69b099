"""Charts of a workbook, drawn by the program that opens it, and pictures on a sheet."""

from __future__ import annotations

from collections.abc import Sequence
from io import BytesIO

from openpyxl.chart import BarChart, LineChart, Reference, Series
from openpyxl.chart.data_source import AxDataSource, MultiLevelStrRef, StrRef
from openpyxl.chart.series import SeriesLabel
from openpyxl.chart.shapes import GraphicalProperties
from openpyxl.drawing.image import Image
from openpyxl.utils import get_column_letter
from openpyxl.workbook import Workbook
from openpyxl.worksheet.worksheet import Worksheet

from doe_kc.reports.render.cells import MUTED, page, put, title

CHART_CELL, CHART_AREA = "A4", "A1:R40"
"""Where a chart or picture begins, and what is printed of its sheet."""
CHART_SIZE = (30.0, 18.5)
"""Centimetres of a chart on a landscape A4 page."""
DATA_COLUMN = 24
"""First column of the numbers of a chart that has them on its own sheet, right of what is printed."""
PICTURE_WIDTH = 760
"""Pixels of a picture on its sheet."""
CELL_PIXELS = (7.0, 20.0)
"""Pixels of a character's width, and of a row."""


def chart_sheet(book: Workbook, name: str, head: str, remark: str, study: str) -> Worksheet:
    """An empty sheet for one chart, printed on one page."""
    ws = book.create_sheet(name)
    title(ws, f"{head}: {study}", remark)
    ws.sheet_view.showGridLines = False
    page(ws, study, single=True)
    ws.print_area = CHART_AREA
    return ws


def add_bars(
    ws: Worksheet, data: Worksheet, *, names: str, values: Sequence[str], colors: Sequence[str],
    rows: tuple[int, int], limits: tuple[float, float], middle: float, axis: str,
) -> None:  # fmt: skip
    """Horizontal bars from `middle`, a pair of rows of `data` a category.

    names, values: column letters; their heads stand above the first of `rows`. colors: RRGGBB of each of the
    values. limits: of the axis of values; a bar beyond ends there.
    """
    chart = BarChart()
    chart.type, chart.gapWidth, chart.overlap = "bar", 40, 0
    for letter, color in zip(values, colors, strict=True):
        series = Series(_range(data, letter, rows), title_from_data=False)
        series.tx = _head(data, letter, rows[0] - 1)
        series.graphicalProperties = GraphicalProperties(solidFill=color)
        series.invertIfNegative = False
        chart.series.append(series)
    chart.set_categories(_range(data, names, rows))
    chart.y_axis.scaling.min, chart.y_axis.scaling.max = limits
    chart.x_axis.crosses, chart.x_axis.crossesAt = None, middle
    chart.x_axis.scaling.orientation, chart.x_axis.tickLblPos = "maxMin", "low"
    chart.y_axis.crosses = "max"  # below, as the categories run downwards
    chart.y_axis.title, chart.y_axis.number_format = axis, "0.0"
    _finish(ws, chart)


def add_marks(
    ws: Worksheet, heads: Sequence[str], rows: Sequence[Sequence[str | float | None]], *,
    looks: Sequence[tuple[str, str]], lowest: float, axis: str,
) -> None:  # fmt: skip
    """Marks over categories of two levels, logarithmic.

    heads: of the two levels and of the series. rows: both names of a category, the outer one where it begins,
    and the value of each series. looks: symbol and RRGGBB of each series.
    """
    first = 5
    put(ws, first - 1, DATA_COLUMN, "Numbers of the chart", color=MUTED)
    for r, row in enumerate([heads, *rows], start=first):
        for c, value in enumerate(row, start=DATA_COLUMN):
            put(ws, r, c, value, number="0.00" if isinstance(value, float) else None, color=MUTED)
    last = first + len(rows)
    chart = LineChart()
    outer, inner = get_column_letter(DATA_COLUMN), get_column_letter(DATA_COLUMN + 1)
    for k, (symbol, color) in enumerate(looks):
        letter = get_column_letter(DATA_COLUMN + 2 + k)
        series = Series(_range(ws, letter, (first + 1, last)), title_from_data=False)
        series.tx = _head(ws, letter, first)
        series.marker.symbol, series.marker.size = symbol, 6
        series.marker.graphicalProperties = GraphicalProperties(solidFill=color)
        series.marker.graphicalProperties.line.solidFill = color
        series.graphicalProperties = GraphicalProperties()
        series.graphicalProperties.line.noFill = True
        series.smooth = False
        levels = f"'{ws.title}'!${outer}${first + 1}:${inner}${last}"
        series.cat = AxDataSource(multiLvlStrRef=MultiLevelStrRef(f=levels))
        chart.series.append(series)
    chart.y_axis.scaling.logBase, chart.y_axis.scaling.min = 2, lowest
    chart.y_axis.title, chart.y_axis.number_format = axis, "General"
    chart.y_axis.crosses = "min"
    chart.x_axis.tickLblPos = "low"
    _finish(ws, chart)


def add_picture(ws: Worksheet, png: bytes) -> None:
    """A picture below the title, on an upright page."""
    image = Image(BytesIO(png))
    image.width, image.height = PICTURE_WIDTH, image.height * PICTURE_WIDTH / image.width
    ws.add_image(image, CHART_CELL)
    ws.page_setup.orientation = "portrait"
    ws.print_area = f"A1:K{4 + int(image.height / CELL_PIXELS[1])}"
    for letter in "ABCDEFGHIJK":
        ws.column_dimensions[letter].width = PICTURE_WIDTH / 11.0 / CELL_PIXELS[0]


def _finish(ws: Worksheet, chart: BarChart | LineChart) -> None:
    chart.x_axis.delete = chart.y_axis.delete = False
    chart.legend.position = "b"
    chart.width, chart.height = CHART_SIZE
    ws.add_chart(chart, CHART_CELL)


def _range(ws: Worksheet, letter: str, rows: tuple[int, int]) -> Reference:
    return Reference(ws, range_string=f"'{ws.title}'!${letter}${rows[0]}:${letter}${rows[1]}")


def _head(ws: Worksheet, letter: str, row: int) -> object:
    return SeriesLabel(strRef=StrRef(f"'{ws.title}'!${letter}${row}"))
