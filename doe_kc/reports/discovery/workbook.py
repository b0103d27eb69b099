"""The discovery workbook: the verdict, and every number behind it."""

from __future__ import annotations

import math
from collections.abc import Mapping
from pathlib import Path

from openpyxl.workbook import Workbook

from doe_kc import __version__
from doe_kc.curves import response_name
from doe_kc.discovery.result import Discovery, Finding
from doe_kc.discovery.thresholds import RELEVANT
from doe_kc.effects.words import effect_label
from doe_kc.load_cases import case_label
from doe_kc.reports.discovery.effect_words import effect_words
from doe_kc.reports.discovery.effects import effect_table
from doe_kc.reports.discovery.gap_steps import gap_steps
from doe_kc.reports.discovery.isolability import isolability_table
from doe_kc.reports.discovery.library import library_table
from doe_kc.reports.discovery.parameters import tuned_table
from doe_kc.reports.discovery.tables import GapRow, disagreement_table, gap_table, held_out_table
from doe_kc.reports.discovery.words import contrast_words, headline, own_sentences
from doe_kc.reports.render.charts import add_marks, chart_sheet
from doe_kc.reports.render.workbook import lines_sheet, new_book, table_sheet, write_book
from doe_kc.reports.table import Column, Table, Value

GAP_LOOKS: Mapping[str, tuple[str, str]] = {
    "nominal": ("dash", "555555"),
    "tuned": ("circle", "E69F00"),
    "with_effect": ("diamond", "0072B2"),
    "best_decoy": ("x", "CC79A7"),
}
"""Symbol and colour of the models in the chart, as in the pictures."""
SCAN_PLACES = 3
"""Places of the generic scan that are listed."""
VERDICT_LINE_LENGTH = 125
"""Characters that fit one line of the text column."""
DISCOVERY_LEGEND = {
    "Frame": "Chassis: X rearwards, Y to the right, Z up, ground z = 0.",
    "Signs": "Toe-in +, camber top outwards +, caster top rearwards +; forces as their load case has them.",
    "Verdict": (
        "Effect named: the records ask for it, noise explains what remains, held-out load cases are "
        "predicted better. One of several: an effect is missing, but these records cannot tell which. No "
        "effect missing: re-tuning explains all records. Unexplained: something is missing, but no effect"
        " of the library is convincing; what is listed are leads."
    ),
    "As handed in": "The axle as it is in its file.",
    "Re-tuned": "The most probable axle without any effect: parameters within their production scatter.",
    "With the effect": "The most probable axle with the effects found, all parameters re-tuned with them.",
    "With the best other effect": (
        "The best other effect in place of the one found, refitted alike: a gap that it closes as "
        "well is no evidence for a name."
    ),
    "Gap": (
        "RMS of model minus measured in units of the records' noise, correlations of the noise respected;"
        " 1 is noise. Noise floor: what the right model would reach, as its parameters follow the noise."
    ),
    "Disagreement": (
        "How much of one shape a curve's deviation holds, in standard deviations. Gradient: slope at "
        "static; curvature: even; progression: odd and cubic; dead band: a step about zero; loop width "
        "and loop tilt: of the half-width of the loop, (falling - rising) / 2; offset: constant, tyre "
        "load only."
    ),
    "Re-tuned z": (
        "Only what no re-tuning can absorb, against the smaller noise that is left of it: does not compare "
        "with the nominal z. With the effect: the shape of its law is left open as far as the records ask "
        "for."
    ),
    "Wheels": "Both alike: sum of both wheels; left against right: their difference.",
    "Size, sd": (
        "Most probable value and its standard deviation, all parameters free together. 'Not told from "
        "rigid / none': the limit that the value passes with a chance of 5 %."
    ),
    "Probability": (
        "That it is this effect, in whatever place, all other effects in the model: among it, its removal "
        "and its rivals in its place, each refitted, less the chance that something outside the library has "
        "taken its place; of a trace among those alone."
    ),
    "log10 odds": (
        "Of the effect against the best alternative, all others in the model: 2 is a hundred to one; 6 says "
        "6 or more."
    ),
    "Adequacy": (
        "How often noise alone leaves as much as remains: on the map of disagreements, and of load cases "
        "held out. Something that the library does not list has odds of 2 % before the records; what "
        "remains can raise them to the stated probability at most."
    ),
    "Trace": f"The records show it, but it is less than {RELEVANT:g} of its typical size.",
    "ln evidence": "Gained over the model without it; the price of its extra freedom is paid.",
    "Detectability": "Standard deviations that the effect makes after re-tuning.",
    "Detectable size": (
        "Would be found in four of five cars, and is above the 95 % limit of what the records say of it, if "
        "the model is right but for this effect; of several numbers all together. For a stiffness 'below': a "
        "softer part would have been found."
    ),
    "Absorbed": (
        "Share of the effect that re-tuning hides. Hidden by: the parameters that move most for it at its"
        " typical size, in standard deviations of their prior."
    ),
    "Looks like": "Hypotheses that change the records nearly alike after re-tuning, with the correlation.",
    "Held out": (
        "Each load case is left out of the fit and predicted; RMS in standard deviations of the "
        "prediction. Law granted: with what the laws of the effects leave open among the errors; by "
        "that the verdict goes. Gain: ln predictive density won by the effect."
    ),
}


def discovery_workbook(
    discovery: Discovery, *, study: str, date: str, notes: Mapping[str, str] | None = None
) -> Workbook:
    """Sheets Verdict, Disagreement, Effects, Library, Groups, Gap chart, Gap, Held out, Parameters, Legend.

    study: name in titles and page headers. date: as it shall stand in the first sheet. notes: further lines
    of that, title -> text (axle file, measurement, ...).
    """
    book = new_book(f"Missing effects: {study}")
    origin = {"Study": study, "Date": date, "Program": f"doe_kc {__version__}", **(notes or {})}
    lines_sheet(
        book,
        "Verdict",
        "Missing effects",
        "What the model lacks, how sure that is, and what to test next.",
        [*verdict_lines(discovery), *origin.items()],
        study,
        bold=1,
        flagged=(0,) if discovery.verdict in ("class", "unexplained") else (),
        length=VERDICT_LINE_LENGTH,
    )
    table_sheet(book, disagreement_table(discovery, worst_first=True), study)
    table_sheet(book, effect_table(discovery), study)
    table_sheet(book, library_table(discovery), study)
    table_sheet(book, isolability_table(discovery), study)
    _gap_chart(book, gap_table(discovery), study)
    table_sheet(book, gap_table(discovery), study)
    table_sheet(book, held_out_table(discovery), study)
    table_sheet(book, tuned_table(discovery), study)
    lines_sheet(book, "Legend", "Legend", "How to read this workbook.", list(DISCOVERY_LEGEND.items()), study)
    return book


def _gap_chart(book: Workbook, table: Table[GapRow], study: str) -> None:
    """Marks of every model over load case and response."""
    remark = "Model minus measured as a multiple of the noise of the rig; 1 is noise."
    ws = chart_sheet(book, "Gap chart", "Gap", remark, study)
    columns = [c for c in table.columns if c.key in GAP_LOOKS and not _absent(c, table)]
    rows: list[list[str | float | None]] = []
    last = ""
    for row in table.rows:
        case = case_label(row.case) if row.case else "All"
        rows.append([case if case != last else None, response_name(row.response) if row.response else "all"])
        rows[-1] += [_known(c.value(row)) for c in columns]
        last = case
    add_marks(
        ws, ["Load case", "Response", *(c.head or "" for c in columns)], rows,
        looks=[GAP_LOOKS[c.key] for c in columns], lowest=0.5, axis="deviation, times the noise of the rig",
    )  # fmt: skip


def _absent(column: Column[GapRow], table: Table[GapRow]) -> bool:
    return all(_known(column.value(row)) is None for row in table.rows)


def _known(value: Value) -> float | None:
    return value if isinstance(value, float) and math.isfinite(value) else None


def write_discovery_workbook(
    path: Path, discovery: Discovery, *, study: str, date: str, notes: Mapping[str, str] | None = None
) -> Path:
    """Write `discovery_workbook`; RunError naming path and remedy when the place is locked or full."""
    return write_book(path, discovery_workbook(discovery, study=study, date=date, notes=notes))


def verdict_lines(discovery: Discovery) -> list[tuple[str, str]]:
    """(head, sentence): the verdict, each effect, how far model and records are apart, what stays open, what
    to test next, the statistics last; heads only once."""
    out = [("Verdict", f"{headline(discovery)}. {discovery.sentences[0]}")]
    for head, leads in (("Effect", False), ("Lead", True)):
        listed = [f for f in discovery.findings if (f.verdict == "lead") is leads]
        out += _headed(head, [finding_words(discovery, f) for f in listed])
    out += _headed("Seen, too small", [finding_words(discovery, f) for f in discovery.traces])
    steps = (f"{step.label}: {step.gap:.2f} times the noise of the rig" for step in gap_steps(discovery))
    out += _headed("Step by step", list(steps))
    alike = [" or ".join(effect_label(e) for e in group) for group in discovery.classes]
    out += _headed("Cannot be told apart", alike)
    open_ = [f"{contrast_words(c)}: {z:+.1f} times the noise" for c, z in discovery.unexplained]
    out += _headed("Unexplained at", open_)
    out += _headed("Test next", discovery.next_tests)
    out += _headed("Statistics", own_sentences(discovery)[1:])
    return out + _headed("Without the library", scan_lines(discovery))


def finding_words(discovery: Discovery, finding: Finding) -> str:
    """Name and place, sizes, how sure, what happens in the car, what it could also be, how to confirm it."""
    words = effect_words(discovery, finding)
    sizes = f": {'; '.join(words.sizes)}" if words.sizes else ""
    rivals = f" Could also be {words.rivals}." if words.rivals else ""
    sure = f"{words.sure[0].upper()}{words.sure[1:]}"
    return f"{words.label}{sizes}. {sure}. {words.physics}{rivals} To confirm: {words.confirm}."


def scan_lines(discovery: Discovery) -> list[str]:
    """Where a generic scan of all interfaces puts what re-tuning leaves, the most probable places."""
    places = discovery.scan.places[:SCAN_PLACES] if discovery.scan is not None else ()
    return [
        f"{p.words[0].upper()}{p.words[1:]}: probability {100.0 * p.probability:.0f} %, closes "
        f"{100.0 * p.explained:.0f} % of what re-tuning leaves"
        for p in places
    ]


def _headed(head: str, texts: list[str] | tuple[str, ...]) -> list[tuple[str, str]]:
    return [(head if i == 0 else "", text) for i, text in enumerate(texts)]
