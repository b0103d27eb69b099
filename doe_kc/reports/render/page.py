"""Sections, tables and the page that holds them: everything inline, nothing fetched, all text escaped."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any, Literal

from jinja2 import Environment, PackageLoader, StrictUndefined
from markupsafe import Markup

from doe_kc import __version__
from doe_kc.ground.output import write_whole
from doe_kc.reports.render.typeset import typeset, unsigned_zero, with_own_meanings
from doe_kc.reports.table import Column, PageCell, Row, Table, Value, ink_on

CHART_DIGITS = 7
"""Significant digits of the numbers that the page's charts hold."""
WHOLE_DIGITS = 3
"""Digits before the point that may stand beyond the significant ones: 6290 rather than 6.29e+03."""
NUMBER_STYLE = "n"
"""CSS class of cells that hold numbers."""
HEAD_STYLES = ("first", NUMBER_STYLE, "turned")
"""Classes that a head shares with the cells below it."""
Paper = Literal["landscape", "portrait"]
"""A4 across, of as many sheets as it takes; or upright, for what is meant for one sheet."""
_CONTROL = re.compile(r"[\x00-\x08\x0b\x0c\x0e-\x1f\x7f\ufffe\uffff\ud800-\udfff]")


@dataclass(frozen=True)
class Section:
    """One part of the page. title: also in the navigation. html: its content, safe as it is.

    Make the content with `render` from a template, which escapes, or with `markupsafe.Markup.format`; a
    `<table class="data">` in it can be sorted and filtered. lead: one sentence under the title. folded: words
    of the line that opens the content, which is neither shown nor printed before; empty for an open section.
    """

    title: str
    html: Markup
    lead: str = ""
    folded: str = ""

    @property
    def ident(self) -> str:
        """Anchor in the page."""
        return re.sub(r"[^a-z0-9]+", "-", self.title.lower()).strip("-") or "section"


def page_html(
    title: str, sections: Sequence[Section], *, subtitle: str = "", paper: Paper = "landscape"
) -> str:
    """The whole page with its styles and scripts inside; opens from a disk, a mail or a server."""
    html = render(
        "page.html", title=title, subtitle=subtitle, sections=sections, paper=paper, version=__version__
    )
    return _CONTROL.sub("\N{REPLACEMENT CHARACTER}", str(html))


def write_page(
    path: Path,
    title: str,
    sections: Sequence[Section],
    *,
    subtitle: str = "",
    paper: Paper = "landscape",
    labels: Mapping[str, str] | None = None,
) -> Path:
    """Write `page_html`; RunError when it cannot be written. labels: of the axle's points and elements."""
    html = page_html(title, sections, subtitle=subtitle, paper=paper)
    html = with_own_meanings(html, labels) if labels else html
    return write_whole(path, lambda p: p.write_text(html, encoding="utf-8"))


def render(template: str, **values: Any) -> Markup:
    """Content from a template of this package; values are escaped unless they are `Markup`."""
    return Markup(_environment().get_template(template).render(**values))


@lru_cache(maxsize=1)
def _environment() -> Environment:
    environment = Environment(
        loader=PackageLoader("doe_kc.reports.page", "templates"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters["sig"] = significant
    environment.filters["typeset"] = typeset
    return environment


def significant(value: float, digits: int = 4) -> str:
    """A number for reading; a dash for none."""
    if not math.isfinite(value):
        return "–"
    if value == 0.0:
        return "0"
    places = digits - 1 - math.floor(math.log10(abs(value)))
    if -WHOLE_DIGITS <= places < 0:
        return f"{round(value, places):.0f}"
    return f"{value:.{places}f}" if 0 <= places <= 7 else f"{value:.{digits}g}"


def embedded(data: Mapping[str, Any]) -> Markup:
    """Data for a script, as JSON that no text in it can break out of; not finite becomes null."""
    text = json.dumps(_plain(data), separators=(",", ":"), allow_nan=False)
    for char in "<>&":
        text = text.replace(char, f"\\u{ord(char):04x}")
    return Markup(text)  # escaped just above


def _plain(value: Any) -> Any:
    if isinstance(value, Mapping):
        return {str(k): _plain(v) for k, v in value.items()}
    if hasattr(value, "tolist"):
        value = value.tolist()
    if isinstance(value, (list, tuple)):  # a tuple of types is asked in half the time of their union
        return [_plain_number(v) if type(v) is float else _plain(v) for v in value]
    return _plain_number(value) if isinstance(value, float) else value


def _plain_number(value: float) -> float | None:
    return float(f"{value:.{CHART_DIGITS}g}") if math.isfinite(value) else None


def table_html(table: Table[Row], *, notice: Markup | None = None) -> Markup:
    """Search field and boxes, then the table. notice: below them."""
    layout = table.page
    if layout is None:
        raise ValueError(f"table {table.name} has no place in a page")
    columns = [(c, c.page) for c in table.page_columns if c.page is not None]
    return render(
        "table.html",
        layout=layout,
        choices=layout.choices or {},
        notice=notice or "",
        heads=[
            (column_head(c, p), _attributes({"class": _head_style(c, p)}), _sorted(c, p)) for c, p in columns
        ],
        rows=[
            (
                layout.tags(row) if layout.tags is not None else None,
                layout.quiet is not None and layout.quiet(row),
                [(_cell(c, p, row), _text(c, p, row)) for c, p in columns],
            )
            for row in table.rows
        ],
    )


def _sorted(column: Column[Row], cell: PageCell[Row]) -> bool:
    """Whether it is sorted as numbers."""
    return bool(column.number) or cell.order is not None


def _head_style(column: Column[Row], cell: PageCell[Row]) -> str:
    words = _style(column, cell).split()
    return " ".join(w for w in words if w in HEAD_STYLES)


def _style(column: Column[Row], cell: PageCell[Row]) -> str:
    return f"{cell.style} {NUMBER_STYLE if column.number else ''}".strip()


def _cell(column: Column[Row], cell: PageCell[Row], row: Row) -> Markup:
    own = dict(cell.attributes(row)) if cell.attributes is not None else {}
    attributes = {"class": f"{_style(column, cell)} {own.pop('class', '')}".strip()}
    if _sorted(column, cell):
        attributes["data-value"] = str((cell.order or column.value)(row))
    fill = cell.fill(row) if cell.fill is not None else ""
    if fill:
        attributes["style"] = f"background:#{fill};color:#{ink_on(fill)}"
    return _attributes(attributes | own)


def _attributes(attributes: dict[str, str]) -> Markup:
    return Markup("").join(Markup(' {}="{}"').format(k, v) for k, v in attributes.items() if v)


def cell_text(column: Column[Row], cell: PageCell[Row], row: Row) -> str:
    """What is read in a cell, before it is typeset; `Markup` where it is a drawing."""
    return cell.text(row) if cell.text is not None else _words(column.read(row), cell)


def column_head(column: Column[Row], cell: PageCell[Row]) -> str:
    """What stands above the column."""
    return cell.head if cell.head is not None else column.head or ""


def _text(column: Column[Row], cell: PageCell[Row], row: Row) -> Markup:
    text = typeset(cell_text(column, cell, row))
    strong = cell.strong is not None and cell.strong(row)
    return Markup("<b>{}</b>").format(text) if strong else text


def _words(value: Value, cell: PageCell[Row]) -> str:
    if value is None or isinstance(value, str):
        return value or ""
    if cell.layout and math.isfinite(value):
        return unsigned_zero(format(value, cell.layout))
    return significant(value, cell.digits)
