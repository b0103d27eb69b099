"""What was tried in the model's place, how it predicts load cases left out, and what to test next."""

from __future__ import annotations

import math
from typing import Any

from doe_kc.discovery.result import Discovery
from doe_kc.report.discovery_evidence import EvidenceBar, EvidenceStep, evidence_steps
from doe_kc.report.discovery_held_out import gain_words
from doe_kc.report.names import case_label
from doe_kc.report.render.page import Section, render

CANDIDATES_LEAD = (
    "Effects are added one by one, each with all parameters re-tuned. The evidence counts how much better "
    "the records are explained and charges for the added freedom; it must pass what chance reaches among so "
    "many candidates. Screened ones were not worth a joint refit."
)
HELD_OUT = (
    "Each load case is left out, the models are fitted to all the others and predict it. RMS in standard "
    "deviations of the prediction: 1 is as good as predicted. A right effect predicts what it has not seen."
)
SCAN = (
    "A generic scan that knows no library: a law at every interface of the axle, to first order at the "
    "re-tuned axle. It shows where in the axle the records point to, whatever the name."
)
CANDIDATES_LISTED = 10
TESTS = "Component tests and extra load cases, most useful first."
BAR = 150.0
"""Pixels of the longest bar."""


def candidates_section(discovery: Discovery) -> Section:
    """A row a candidate and step."""
    steps = evidence_steps(discovery)
    largest = max((c.gain for s in steps for c in s.candidates if math.isfinite(c.gain)), default=1.0)
    rows = [_candidate(i, s, c, largest) for i, s in enumerate(steps, start=1) for c in s.candidates]
    html = render("discovery_candidates.html", rows=rows, titles=[s.title for s in steps])
    return Section("Candidates", html, CANDIDATES_LEAD)


def _candidate(number: int, step: EvidenceStep, candidate: EvidenceBar, largest: float) -> dict[str, Any]:
    how = "taken" if candidate.accepted else "refitted" if candidate.refitted else "screened"
    place = math.log1p(max(candidate.gain, 0.0)) / math.log1p(max(largest, 1.0))
    return {
        "step": number,
        "label": candidate.label,
        "how": how,
        "gain": candidate.gain,
        "text": gain_words(candidate.gain).lstrip("+"),
        "needed": step.needed,
        "bar": round(BAR * place, 1) if math.isfinite(place) else 0.0,
    }


def scan_section(discovery: Discovery) -> list[Section]:
    """A row a place of the generic scan; no section where noise explains what re-tuning leaves."""
    if discovery.scan is None:
        return []
    html = render("discovery_scan.html", places=discovery.scan.places[:CANDIDATES_LISTED])
    return [Section("Without the library", html, SCAN)]


def held_out_section(discovery: Discovery) -> Section:
    """A row a load case."""
    rows = [
        {
            "case": case_label(h.load_case),
            "tuned": h.tuned.rms,
            "with_effect": h.with_effect.rms,
            "law_granted": h.law_granted.rms,
            "gain": h.gain,
            "text": gain_words(h.gain),
        }
        for h in discovery.held_out
    ]
    return Section("Load cases held out", render("discovery_held_out.html", rows=rows), HELD_OUT)


def tests_section(discovery: Discovery) -> Section:
    """What would confirm, separate or show."""
    return Section("What to test next", render("discovery_tests.html", tests=discovery.next_tests), TESTS)
