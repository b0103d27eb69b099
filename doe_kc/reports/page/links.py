"""The links on top of every page of a study, to each other page that is there."""

from __future__ import annotations

import os
import re
from collections.abc import Mapping, Sequence
from pathlib import Path

from markupsafe import Markup

from doe_kc.ground.errors import RunError
from doe_kc.ground.output import write_whole

STUDY_PAGES: Mapping[str, str] = {
    "index.html": "Answer",
    "discover/report.html": "What the model lacks",
    "correlate/report.html": "Correlation",
    "compare/report.html": "Comparison",
    "influence/report.html": "Influence",
    "tolerance/report.html": "Tolerance",
    "reduce/report.html": "Rig records",
    "simulate/report.html": "Simulation",
}
"""Page under the study's folder -> its name in the links."""
_PLACE = re.compile(r"(<nav class=\"pages\"[^>]*><!--pages-->).*?(<!--/pages-->)", re.DOTALL)


def link_pages(folder: Path) -> None:
    """Writes into every page of a study's folder the links to all that are there now.

    Pages are written step by step, so that none knows at its writing which others there will be. RunError
    when one cannot be read or written.
    """
    there = [name for name in STUDY_PAGES if (folder / name).is_file()]
    for name in there:
        _link(folder / name, name, there)


def _link(page: Path, name: str, there: Sequence[str]) -> None:
    try:
        html = page.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise RunError(f"{page}: cannot be read to link it with the other pages ({error}).") from error
    links = Markup("\n").join(_anchor(other, name) for other in there)
    linked = _PLACE.sub(lambda m: f"{m[1]}\n{links}\n{m[2]}", html, count=1)
    if linked != html:
        write_whole(page, lambda p: p.write_text(linked, encoding="utf-8"))


def _anchor(other: str, name: str) -> Markup:
    way = os.path.relpath(other, Path(name).parent).replace(os.sep, "/")
    here = Markup(' aria-current="page"') if other == name else Markup("")
    return Markup('<a href="{}"{}>{}</a>').format(way, here, STUDY_PAGES[other])
