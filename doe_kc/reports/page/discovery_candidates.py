"""What was tried in the model's place, how it predicts load cases left out, and what to test next."""

from __future__ import annotations

import math
from dataclasses import dataclass

from markupsafe import Markup

from doe_kc.discovery.result import Discovery
from doe_kc.discovery.screening.scan import Place
from doe_kc.reports.discovery.evidence import EvidenceBar, EvidenceStep, evidence_steps
from doe_kc.reports.discovery.tables import gain_words, held_out_table
from doe_kc.reports.render.page import Section, render, table_html
from doe_kc.reports.table import Column, PageCell, PageLayout, Table

CANDIDATES_LEAD = (
    "Effects are added one by one, each with all parameters re-tuned. The odds count how much better the "
    "records are explained, charge for the added freedom and for how many effects there are to choose from; "
    "a hundred to one are needed at least, more where much remains. Screened ones were not worth a joint "
    "refit."
)
HELD_OUT = (
    "Each load case is left out, the models are fitted to all the others and predict it. A right effect "
    "predicts what it has not seen. Deviation as a multiple of what the prediction itself leaves open: 1 is "
    "as good as predicted."
)
SCAN = (
    "A generic scan that knows no library: a law at every interface of the axle, to first order at the "
    "re-tuned axle. It shows where in the axle the records point to, whatever the name."
)
CANDIDATES_LISTED = 10
TESTS = "Component tests and extra load cases, most useful first."
BAR = 150.0
"""Pixels of the longest bar."""
UNLIKELY = 0.01
"""Probability below which a place of the scan is grey."""


@dataclass(frozen=True)
class CandidateRow:
    """One candidate of one step, counted from 1; share: of the longest bar, on a logarithmic scale."""

    number: int
    step: EvidenceStep
    bar: EvidenceBar
    share: float

    @property
    def how(self) -> str:
        """How far it came."""
        return "taken" if self.bar.accepted else "refitted" if self.bar.refitted else "screened"


CANDIDATE_COLUMNS: tuple[Column[CandidateRow], ...] = (
    Column("step", "Step", lambda r: r.number, "0", page=PageCell(layout="d")),
    Column("candidate", "Candidate", lambda r: r.bar.label,
           page=PageCell(style="first", strong=lambda r: r.how == "taken")),
    Column("how", "How far", lambda r: r.how, page=PageCell()),
    Column("gain", "ln odds gained", lambda r: r.bar.gain, "0.0",
           page=PageCell(text=lambda r: gain_words(r.bar.gain).lstrip("+"))),
    Column("bar", "on a logarithmic scale", lambda r: r.bar.gain,
           page=PageCell(text=lambda r: _bar(r), order=lambda r: r.bar.gain)),
    Column("needed", "Needed", lambda r: r.step.needed, "0.0", page=PageCell(layout=".1f")),
)  # fmt: skip
SCAN_COLUMNS: tuple[Column[Place], ...] = (
    Column("words", "Place and law", lambda p: p.words, page=PageCell(style="first wide")),
    Column("probability", "Probability", lambda p: p.probability, "0.0%",
           page=PageCell(text=lambda p: f"{100 * p.probability:.1f} %")),
    Column("closed", "Closes, % of what re-tuning leaves", lambda p: p.explained, "0%",
           page=PageCell(text=lambda p: f"{100 * p.explained:.0f}")),
    Column("score", "Score, sd", lambda p: p.score, "0.0", page=PageCell(layout=".1f")),
)  # fmt: skip


def candidates_section(discovery: Discovery) -> Section:
    """A row a candidate and step."""
    steps = evidence_steps(discovery)
    largest = max((c.gain for s in steps for c in s.candidates if math.isfinite(c.gain)), default=1.0)
    rows = [
        CandidateRow(i, s, c, math.log1p(max(c.gain, 0.0)) / math.log1p(max(largest, 1.0)))
        for i, s in enumerate(steps, start=1)
        for c in s.candidates
    ]
    layout = PageLayout[CandidateRow](
        "candidates-table",
        "Candidates",
        filtered=True,
        choices={"refitted": "refitted only"},
        tags=lambda r: "" if r.how == "screened" else "refitted",
        quiet=lambda r: r.how == "screened",
    )
    table = table_html(Table("Candidates", CANDIDATES_LEAD, CANDIDATE_COLUMNS, rows, page=layout))
    html = render("discovery_steps.html", titles=[s.title for s in steps]) + table
    return Section(
        "Candidates", html, CANDIDATES_LEAD, folded="Every candidate with its evidence, step by step"
    )


def _bar(row: CandidateRow) -> Markup:
    width = round(BAR * row.share, 1) if math.isfinite(row.share) else 0.0
    return Markup('<span class="bar {}" style="width:{}px"></span>').format(row.how, width)


def scan_section(discovery: Discovery) -> list[Section]:
    """A row a place of the generic scan; no section where noise explains what re-tuning leaves."""
    if discovery.scan is None:
        return []
    layout = PageLayout[Place](
        "scan-table", "Places of the generic scan", quiet=lambda p: p.probability < UNLIKELY
    )
    places = discovery.scan.places[:CANDIDATES_LISTED]
    table = Table("Places", SCAN, SCAN_COLUMNS, places, page=layout)
    return [
        Section("Without the library", table_html(table), SCAN, folded="The places, with their probability")
    ]


def held_out_section(discovery: Discovery) -> Section:
    """A row a load case."""
    return Section("Load cases held out", table_html(held_out_table(discovery)), HELD_OUT)


def tests_section(discovery: Discovery) -> Section:
    """What would confirm, separate or show."""
    return Section("What to test next", render("discovery_tests.html", tests=discovery.next_tests), TESTS)
