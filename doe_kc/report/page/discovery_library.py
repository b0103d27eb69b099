"""Where every effect of the library stands: found, excluded from a size on, or not testable and why."""

from __future__ import annotations

import math

from doe_kc.discovery.result import Discovery
from doe_kc.effects import EFFECTS
from doe_kc.report.discovery_tables import alike_words, bench_words, hidden_words, ordered_standings
from doe_kc.report.discovery_words import (
    STATUS_WORDS,
    hypothesis_label,
    limit_words,
    mistaken_words,
    typical_words,
)
from doe_kc.report.render.page import Section, render

LIBRARY_LEAD = (
    "Would have shown: it would have been found from the detectable size on, in four of five cars, if the "
    "model is right but for this; for a stiffness, a softer part would have been found. Not resolved: the "
    "same, but the model does not explain the records, so that nothing follows. Not testable: re-tuning "
    "absorbs it or it shows too little in these load cases; the parameters that hide it are named with the "
    "move that does so, and the parts that, measured on a bench, would show it, with the standard deviations "
    "that its typical size would then make."
)


def library_section(discovery: Discovery) -> Section:
    """One row a hypothesis, sortable and filterable."""
    labels = {s.hypothesis.name: hypothesis_label(s.hypothesis) for s in discovery.statuses}
    rows = [
        {
            "label": hypothesis_label(s.hypothesis),
            "id": s.hypothesis.name,
            "status": STATUS_WORDS[s.status],
            "tags": s.status.replace(" ", "-"),
            "limit": limit_words(s),
            "times": s.detectable if math.isfinite(s.detectable) else math.nan,
            "typical": typical_words(s.hypothesis) or "–",
            "absorbed": 100.0 * s.absorbed,
            "hidden": hidden_words(s) or "–",
            "bench": bench_words(s) or "–",
            "alike": alike_words(s, labels) or "–",
            "mistaken": mistaken_words(s.hypothesis.effect) or "–",
            "physics": EFFECTS[s.hypothesis.effect].physics,
        }
        for s in ordered_standings(discovery)
    ]
    return Section("Library of effects", render("discovery_library.html", rows=rows), LIBRARY_LEAD)
