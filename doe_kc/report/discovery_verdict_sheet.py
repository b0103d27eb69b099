"""The first sheet of the discovery workbook: the verdict in words."""

from __future__ import annotations

from collections.abc import Mapping

from openpyxl.workbook import Workbook

from doe_kc import __version__
from doe_kc.discovery.result import Discovery, Finding
from doe_kc.effects import EFFECTS
from doe_kc.report.discovery_sizes import size_words
from doe_kc.report.discovery_words import (
    HEADLINES,
    contrast_words,
    effect_label,
    hypothesis_label,
    own_sentences,
)
from doe_kc.report.render.cells import FLAGGED, frame, page, put, title, widths

SCAN_PLACES = 3
"""Places of the generic scan that are listed."""
VERDICT_LINE_LENGTH = 125
"""Characters that fit one line of the text column."""


def verdict_sheet(
    book: Workbook, discovery: Discovery, study: str, date: str, notes: Mapping[str, str]
) -> None:
    """What is missing, how sure that is, what to test next, and what it was made from."""
    ws = book.create_sheet("Verdict")
    title(ws, f"Missing effects: {study}", "What the model lacks, how sure that is, and what to test next.")
    made = {"Study": study, "Date": date, "Program": f"doe_kc {__version__}", **notes}
    lines = [*verdict_lines(discovery), *made.items()]
    for row, (key, text) in enumerate(lines, start=4):
        put(ws, row, 1, key, bold=True, vertical="top", wrap=True)
        cell = put(ws, row, 2, text, wrap=True, vertical="top", bold=row == 4)
        if row == 4 and discovery.verdict in ("class", "unexplained"):
            cell.fill = FLAGGED
        ws.row_dimensions[row].height = 14.5 * (1 + len(text) // VERDICT_LINE_LENGTH)
    frame(ws, range(4, 4 + len(lines)), range(1, 3))
    widths(ws, [22, 120])
    page(ws, study)


def verdict_lines(discovery: Discovery) -> list[tuple[str, str]]:
    """(head, sentence): the verdict, each effect, what stays open, what to test next; heads only once."""
    out = [("Verdict", f"{HEADLINES[discovery.verdict]}. {discovery.sentences[0]}")]
    out += _headed("In words", own_sentences(discovery)[1:])
    head = "Lead" if discovery.verdict == "unexplained" else "Effect"
    out += _headed(head, [finding_words(discovery, f) for f in discovery.findings])
    traces = [f"{hypothesis_label(f.hypothesis)}: {size_words(discovery, f)}" for f in discovery.traces]
    out += _headed("Seen, too small", traces)
    alike = [" or ".join(effect_label(e) for e in group) for group in discovery.classes]
    out += _headed("Cannot be told apart", alike)
    open_ = [f"{contrast_words(c)}: {z:+.1f} standard deviations" for c, z in discovery.unexplained]
    out += _headed("Unexplained at", open_)
    out += _headed("Without the library", scan_lines(discovery))
    return out + _headed("Test next", discovery.next_tests)


def finding_words(discovery: Discovery, finding: Finding) -> str:
    """Name and place, sizes, and what happens in the car."""
    sizes = f": {size_words(discovery, finding)}" if finding.hypothesis.sizes else ""
    return f"{hypothesis_label(finding.hypothesis)}{sizes}. {EFFECTS[finding.hypothesis.effect].physics}"


def scan_lines(discovery: Discovery) -> list[str]:
    """Where a generic scan of all interfaces puts what re-tuning leaves, the most probable places."""
    places = discovery.scan.places[:SCAN_PLACES] if discovery.scan is not None else ()
    return [
        f"{p.words[0].upper()}{p.words[1:]}: probability {100.0 * p.probability:.0f} %, closes "
        f"{100.0 * p.closed:.0f} % of what re-tuning leaves"
        for p in places
    ]


def _headed(head: str, texts: list[str] | tuple[str, ...]) -> list[tuple[str, str]]:
    return [(head if i == 0 else "", text) for i, text in enumerate(texts)]
