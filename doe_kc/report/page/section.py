"""Sections and the page that holds them: everything inline, nothing fetched, all text escaped."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any

from jinja2 import Environment, PackageLoader, StrictUndefined
from markupsafe import Markup

from doe_kc import __version__
from doe_kc.ground.output import write_whole

CHART_DIGITS = 7
"""Significant digits of the numbers that the page's charts hold."""
_CONTROL = re.compile(r"[\x00-\x08\x0b\x0c\x0e-\x1f\x7f\ufffe\uffff\ud800-\udfff]")


@dataclass(frozen=True)
class Section:
    """One part of the page. title: also in the navigation. html: its content, safe as it is.

    Make the content with `render` from a template, which escapes, or with `markupsafe.Markup.format`; a
    `<table class="data">` in it can be sorted and filtered. lead: one sentence under the title.
    """

    title: str
    html: Markup
    lead: str = ""

    @property
    def ident(self) -> str:
        """Anchor in the page."""
        return re.sub(r"[^a-z0-9]+", "-", self.title.lower()).strip("-") or "section"


def page_html(title: str, sections: Sequence[Section], *, subtitle: str = "") -> str:
    """The whole page with its styles and scripts inside; opens from a disk, a mail or a server."""
    html = render("page.html", title=title, subtitle=subtitle, sections=sections, version=__version__)
    return _CONTROL.sub("\N{REPLACEMENT CHARACTER}", str(html))


def write_page(path: Path, title: str, sections: Sequence[Section], *, subtitle: str = "") -> Path:
    """Write `page_html`; RunError when it cannot be written."""
    html = page_html(title, sections, subtitle=subtitle)
    return write_whole(path, lambda p: p.write_text(html, encoding="utf-8"))


def render(template: str, **values: Any) -> Markup:
    """Content from a template of this package; values are escaped unless they are `Markup`."""
    return Markup(_environment().get_template(template).render(**values))


@lru_cache(maxsize=1)
def _environment() -> Environment:
    found = Environment(
        loader=PackageLoader("doe_kc.report.page", "templates"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    found.filters["sig"] = significant
    return found


def significant(value: float, digits: int = 4) -> str:
    """A number for reading; a dash for none."""
    if not math.isfinite(value):
        return "–"
    if value == 0.0:
        return "0"
    places = digits - 1 - math.floor(math.log10(abs(value)))
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
