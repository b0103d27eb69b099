"""A reported quantity, declared once: CSV, workbook, page, terminal and JSON are written from its column."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Generic, TypeVar

from doe_kc.ground.numbers import sd_format

Value = str | float | int | bool | None
"""Of a cell: nan and None are empty, a truth value is yes or no to a reader."""
Row = TypeVar("Row")
NEGATIVE_FILL, NEUTRAL_FILL, POSITIVE_FILL = "5AA5DC", "FFFFFF", "F2A23C"
"""Blue, white, orange: told apart by the colour-blind, black text readable on each."""


@dataclass(frozen=True)
class PageCell(Generic[Row]):
    """How a quantity stands in a page.

    head: by default the column's. text: what is read, by default the column's words, a number as `layout` (a
    format specification) says or with `digits` significant digits; a dash for none. strong: rows that have it
    bold. order: what the column is sorted by where that is not its value. style: CSS class of all its cells.
    attributes: further ones of one cell (title, style); its `class` is added to `style`. fill: colour behind
    one cell, RRGGBB; empty for none.
    """

    head: str | None = None
    text: Callable[[Row], str] | None = None
    digits: int = 4
    layout: str = ""
    strong: Callable[[Row], bool] | None = None
    order: Callable[[Row], float] | None = None
    style: str = ""
    attributes: Callable[[Row], Mapping[str, str]] | None = None
    fill: Callable[[Row], str] | None = None


@dataclass(frozen=True)
class TerminalCell(Generic[Row]):
    """How a quantity stands in a terminal. layout: format specification of head and text with its width, as
    `>11`; number: the same of a number in it, as `.4g`. text: by default the value as `number` says."""

    head: str
    layout: str = ""
    number: str = ""
    text: Callable[[Row], str] | None = None


@dataclass(frozen=True)
class Column(Generic[Row]):
    """One quantity of a row.

    key: its name in files and code. head: of the sheet, with the unit where all rows have the same; None
    where the sheet does not have it. value: from a row. number: format of the sheet's cell, of the column or
    from a row; empty for text. width: of the sheet's column, characters. words: what a reader of sheet and
    page sees in place of the value; cell: what the sheet alone shows. csv: whether the CSV has it. page,
    terminal: None where it is absent. json: key in JSON documents, empty where it is absent.
    """

    key: str
    head: str | None
    value: Callable[[Row], Value]
    number: str | Callable[[Row], str] = ""
    width: float = 11.0
    words: Callable[[Row], Value] | None = None
    csv: bool = True
    page: PageCell[Row] | None = None
    terminal: TerminalCell[Row] | None = None
    json: str = ""
    cell: Callable[[Row], Value] | None = None

    def read(self, row: Row) -> Value:
        """What a reader sees: `words`, yes or no for a truth value, else the value."""
        value = (self.words or self.value)(row)
        if isinstance(value, bool):
            return "yes" if value else "no"
        return value

    def in_sheet(self, row: Row) -> Value:
        """What the sheet shows."""
        return self.cell(row) if self.cell is not None else self.read(row)


@dataclass(frozen=True)
class Bar:
    """Bars behind the numbers of a column, from 0 to `full`, by default its largest value; color: RRGGBB."""

    key: str
    color: str
    full: float | None = None


@dataclass(frozen=True)
class Scale:
    """Colours behind the numbers of the columns from `first` to `last`: three pairs of level and RRGGBB."""

    first: str
    last: str
    colors: tuple[tuple[float, str], tuple[float, str], tuple[float, str]]


def diverging(first: str, last: str, full: float) -> Scale:
    """Blue below, white at, orange above zero, full at -+`full`."""
    return Scale(first, last, ((-full, NEGATIVE_FILL), (0, NEUTRAL_FILL), (full, POSITIVE_FILL)))


@dataclass(frozen=True)
class Inside:
    """One colour behind a column's value from column `low` to column `high`, another beyond."""

    key: str
    low: str
    high: str


@dataclass(frozen=True)
class SheetLayout:
    """How a table lies in its sheet.

    frozen: key of the first column that scrolls. single: printed on one page.
    pages_wide: pages beside each other. repeat_columns: as `A:C`, on each of them. wrapped: rows as high as
    their longest text. printed_to: key of the last printed column; printed: number of printed rows, by
    default all. first: keys of columns before the others, in this order.
    """

    frozen: str = ""
    single: bool = False
    pages_wide: int = 1
    repeat_columns: str = ""
    wrapped: bool = False
    printed_to: str = ""
    printed: int | None = None
    first: tuple[str, ...] = ()


@dataclass(frozen=True)
class PageLayout(Generic[Row]):
    """How a table stands in a page.

    ident: of its anchor. label: to those who hear it. filtered: whether it has a search field. choices: tag
    of rows -> words of the box that shows only these. tags: of a row, blanks between them. quiet: rows in
    grey. first: keys of columns before the others, in this order.
    """

    ident: str
    label: str
    filtered: bool = False
    choices: Mapping[str, str] | None = None
    tags: Callable[[Row], str] | None = None
    quiet: Callable[[Row], bool] | None = None
    first: tuple[str, ...] = ()


@dataclass(frozen=True)
class Table(Generic[Row]):
    """Rows and what is reported of each.

    name: of its sheet. remark: how to read it, below the title. title: of the sheet before the study's name,
    by default the name. muted: rows in grey. flagged: rows that are shaded. colors: conditional formats.
    empty: said where there are no rows. ValueError when two columns have one key.
    """

    name: str
    remark: str
    columns: tuple[Column[Row], ...]
    rows: Sequence[Row]
    title: str = ""
    muted: Callable[[Row], bool] | None = None
    flagged: Callable[[Row], bool] | None = None
    colors: tuple[Bar | Scale | Inside, ...] = ()
    empty: str = ""
    sheet: SheetLayout = SheetLayout()
    page: PageLayout[Row] | None = None

    def __post_init__(self) -> None:
        keys = [c.key for c in self.columns]
        twice = sorted({k for k in keys if keys.count(k) > 1})
        if twice:
            raise ValueError(f"table {self.name}: more than one column is called {', '.join(twice)}")

    @property
    def sheet_columns(self) -> list[Column[Row]]:
        """Those of the sheet, in its order."""
        return _ordered([c for c in self.columns if c.head is not None], self.sheet.first)

    def without(self, key: str) -> Table[Row]:
        """The same for a page, without a column that has nothing to say."""
        return replace(self, columns=tuple(c for c in self.columns if c.key != key))

    @property
    def page_columns(self) -> list[Column[Row]]:
        """Those of the page, in its order."""
        columns = [c for c in self.columns if c.page is not None]
        return _ordered(columns, self.page.first if self.page is not None else ())


def _ordered(columns: list[Column[Row]], first: Sequence[str]) -> list[Column[Row]]:
    order = {key: i for i, key in enumerate(first)}
    return sorted(columns, key=lambda c: order.get(c.key, len(order)))


def row_digits(sd: float, value: float) -> str:
    """Number format of a row's values: two digits of their standard deviation, else three of `value`."""
    return sd_format(sd) if math.isfinite(sd) and sd > 0.0 else three_digits(value)


def zero_format(value: Value, number: str) -> str:
    """Number format that shows exactly zero as 0, and a negative value that rounds to zero without a sign."""
    decimals = number.partition(".")[2]
    plain = number in ("0", f"0.{'0' * len(decimals)}")
    if not plain or not isinstance(value, float) or round(value, len(decimals)) or value > 0.0:
        return number
    return "0" if value == 0.0 else f'"{number}"'


def four_digits(value: float) -> str:
    """Number format that shows four significant digits of a number of this size, eight decimals at most."""
    places = min(8, max(0, 3 - math.floor(math.log10(abs(value))))) if value and math.isfinite(value) else 0
    return f"0.{'0' * places}" if places else "0"


def three_digits(value: float) -> str:
    """Number format that shows three significant digits of a number of this size: seven decimals at most, a
    power of ten where those would show none."""
    if 0.0 < abs(value) < 5e-8:
        return "0.0E+00"
    places = min(7, max(0, 2 - math.floor(math.log10(abs(value))))) if value and math.isfinite(value) else 0
    return f"0.{'0' * places}" if places else "0"


def ink_on(fill: str) -> str:
    """Black or white as RRGGBB, whichever is read better on a colour (its luma, ITU-R BT.601)."""
    if not fill:
        return "000000"
    red, green, blue = (int(fill[i : i + 2], 16) for i in (0, 2, 4))
    return "000000" if 0.299 * red + 0.587 * green + 0.114 * blue > 140 else "FFFFFF"
