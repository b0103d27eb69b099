"""The overview as one A4 sheet, `summary.pdf`: drawn without a browser, which a user may not have."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

from doe_kc.correlation.answer_record import EffectWords
from doe_kc.ground.output import write_whole
from doe_kc.reports.answer.overview import AGREEMENT_LEAD, Overview, agreement_table, change_table
from doe_kc.reports.axle.strip import draw_strip, strip_height, strip_width
from doe_kc.reports.drawing import style
from doe_kc.reports.drawing.panel import Panel
from doe_kc.reports.drawing.sheet import Sheet
from doe_kc.reports.render.drawn import LINE, box, canvas, draw_table, paragraph, wrapped
from doe_kc.reports.table import ink_on

EDGE, TOP, FOOT = 34.0, 30.0, 24.0
"""Points of margin: left and right, above, below."""
BODY, SMALL, HEADING = 8.0, 6.8, 10.5
"""Points of text, of small print, and of headings."""
ABOVE, BETWEEN = 9.0, 14.0
"""Points above a heading, and between two columns."""
AGREEMENT_SHARE = 0.45
"""Of the width, for the agreement; the numbers to act on take the rest."""
GREY = "#5B6670"
FILES_ROOM, LEAST_STRIP = 62.0, 0.5
"""Points kept for the list of files, and the share of the width to which the axle's views shrink at most."""


def overview_sheet(overview: Overview, files: Mapping[str, str]) -> Sheet:
    """files: file -> what is in it, as the page links them."""
    page = Sheet(style.A4)
    behind = canvas(page)
    width = page.width - 2.0 * EDGE
    top = _title(page, overview, page.height - TOP)
    top = _status(page, behind, overview, top, width)
    top = _lacked(page, behind, overview, top, width)
    top = _tables(page, behind, overview, top, width)
    top = _heading(page, "The axle before and after, and how far its points moved", EDGE, top)
    view = overview.view
    wide = max(LEAST_STRIP * width, min(width, strip_width(view, top - FOOT - FILES_ROOM)))
    tall = strip_height(view, wide)
    draw_strip(page, view, EDGE, top - tall, wide)
    _files(page, files, top - tall, width)
    return page


def write_overview(path: Path, overview: Overview, files: Mapping[str, str]) -> Path:
    """One A4 page; no date inside but the study's, so that equal results are equal files. RunError when it
    cannot be written."""
    from matplotlib import rc_context
    from matplotlib.backends.backend_pdf import FigureCanvasPdf

    canvas_of_page = FigureCanvasPdf(overview_sheet(overview, files).figure())
    words = {"Title": f"{overview.study}: {overview.status}", "Creator": "doe_kc", "CreationDate": None}
    with rc_context({"pdf.fonttype": 3}):
        return write_whole(path, lambda p: canvas_of_page.print_pdf(p, metadata=words))  # type: ignore[no-untyped-call]


def _title(page: Sheet, overview: Overview, top: float) -> float:
    page.write(EDGE / page.width, (top - 12.0) / page.height, overview.study, 15.0, weight="bold")
    page.write(1.0 - EDGE / page.width, (top - 12.0) / page.height, overview.date, 8.0, "right", color=GREY)
    return top - 20.0


def _status(page: Sheet, behind: Panel, overview: Overview, top: float, width: float) -> float:
    """The word on its colour, and beside it what it means and why."""
    words = [overview.status_sentence, overview.met, *overview.reasons]
    left = EDGE + 108.0
    lines = [line for text in words for line in wrapped(text, BODY, width - 116.0)]
    height = LINE * BODY * len(lines) + 10.0
    box(behind, EDGE, top - height, 100.0, height, f"#{overview.status_fill}")
    box(behind, EDGE + 100.0, top - height, width - 100.0, height, "#F4F6F7")
    page.write(
        (EDGE + 50.0) / page.width, (top - height / 2.0) / page.height, overview.status, 14.0, "center",
        "center", weight="bold", color=f"#{ink_on(overview.status_fill)}",
    )  # fmt: skip
    end = top - 4.0
    for k, text in enumerate(words):
        end = paragraph(page, left, end, width - 116.0, text, BODY, weight="normal" if k else "bold")
    return top - height


def _lacked(page: Sheet, behind: Panel, overview: Overview, top: float, width: float) -> float:
    """One block an effect: what, how large and how sure, how to confirm."""
    top = _heading(page, "What the model lacked", EDGE, top)
    top = paragraph(page, EDGE, top, width, overview.sentence, BODY + 0.6, weight="bold")
    for effect in overview.effects:
        first = top - 2.0
        for text, look in _effect_lines(effect, overview):
            top = paragraph(page, EDGE + 9.0, top, width - 9.0, text, BODY, **look)
        box(behind, EDGE, top - 1.0, 2.5, first - top, f"#{_effect_fill(effect)}")
        top -= 2.0
    return top


def _effect_lines(effect: EffectWords, overview: Overview) -> Sequence[tuple[str, dict[str, str]]]:
    """Text and look, as much as there is room for."""
    size = ", ".join(effect.sizes)
    physics = effect.physics if overview.physics_printed else ""
    confirm = f" To confirm: {effect.confirm}." if overview.tests_printed else ""
    rivals = f"; could also be {effect.rivals}" if effect.rivals else ""
    return [
        (f"{effect.label}{': ' if size else ''}{size} – {effect.sure}{rivals}.", {"weight": "bold"}),
        (f"{physics}{confirm}", {"color": GREY}),
    ]


def _effect_fill(effect: EffectWords) -> str:
    """Whether the axle handed over has it."""
    return "0072B2" if effect.adopted else "E69F00"


def _tables(page: Sheet, behind: Panel, overview: Overview, top: float, width: float) -> float:
    """Agreement and numbers to act on beside each other; returns where the longer one ends."""
    left_width = AGREEMENT_SHARE * (width - BETWEEN)
    right, right_width = EDGE + left_width + BETWEEN, width - BETWEEN - left_width
    first = _heading(page, "Agreement with the measured car", EDGE, top)
    second = _heading(page, "Numbers to act on", right, top)
    agreement, changes = agreement_table(overview), change_table(overview)
    lead = AGREEMENT_LEAD if agreement.rows else "Not known of the axle handed over."
    first = paragraph(page, EDGE, first, left_width, lead, SMALL, color=GREY) - 2.0
    second = paragraph(page, right, second, right_width, changes.remark, SMALL, color=GREY) - 2.0
    if agreement.rows:
        first = draw_table(page, behind, agreement, (EDGE, first), left_width, SMALL)
    if changes.rows:
        second = draw_table(page, behind, changes, (right, second), right_width, SMALL)
    return min(first, second)


def _heading(page: Sheet, text: str, left: float, top: float) -> float:
    top -= ABOVE + HEADING
    page.write(left / page.width, top / page.height, text, HEADING, weight="bold")
    return top - 4.0


def _files(page: Sheet, files: Mapping[str, str], top: float, width: float) -> None:
    """As many as there is room for, in two columns."""
    if top - ABOVE - HEADING - 3.0 * LINE * SMALL > FOOT:
        top = _heading(page, "Where to find the rest", EDGE, top)
    names, half = list(files), (len(files) + 1) // 2
    for column, part in enumerate((names[:half], names[half:])):
        down = top
        for name in part:
            if down - 2.0 * LINE * SMALL < FOOT:
                break
            left = EDGE + column * width / 2.0
            down = paragraph(page, left, down, width / 2.0 - 6.0, f"{name}: {files[name]}", SMALL)
    note = "Left wheel where no side is named. Chassis: X rearwards, Y to the right, Z up."
    page.write(EDGE / page.width, (FOOT - 8.0) / page.height, f"doe_kc · {note}", 6.0, color=GREY)
