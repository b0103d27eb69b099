"""The verdict in words, and the effects that the records ask for."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from doe_kc.discovery.result import Discovery, Finding
from doe_kc.discovery.sentences import against_words, odds_number
from doe_kc.effects import EFFECTS
from doe_kc.report.discovery_effects import kind_of, rival_words
from doe_kc.report.discovery_sizes import found_sizes
from doe_kc.report.discovery_words import (
    HEADLINES,
    contrast_words,
    effect_label,
    hypothesis_label,
    own_sentences,
)
from doe_kc.report.render.page import Section, render


def verdict_section(discovery: Discovery, notes: Mapping[str, str]) -> Section:
    """Tiles, sentences, a row for each effect, what stays open."""
    better = sum(h.gain > 0.0 for h in discovery.held_out)
    html = render(
        "discovery_verdict.html",
        headline=HEADLINES[discovery.verdict],
        clear=discovery.verdict in ("named", "none"),
        top=discovery.findings[0] if discovery.findings else None,
        top_odds=odds_number(discovery.findings[0].log10_odds) if discovery.findings else "",
        top_label=effect_label(discovery.findings[0].hypothesis.effect) if discovery.findings else "",
        gap=discovery.gap,
        has_effect=bool(discovery.fitted.model.members),
        better=better,
        cases=len(discovery.held_out),
        sentences=own_sentences(discovery),
        effects=[_effect(discovery, f) for f in (*discovery.findings, *discovery.traces)],
        alike=[" or ".join(effect_label(e) for e in group) for group in discovery.classes],
        unexplained=[(contrast_words(c), z) for c, z in discovery.unexplained],
        notes=notes,
    )
    return Section("Verdict", html)


def _effect(discovery: Discovery, finding: Finding) -> dict[str, Any]:
    ident = finding.hypothesis.effect
    kind = kind_of(discovery, finding)
    return {
        "label": hypothesis_label(finding.hypothesis),
        "kind": "seen, too small to matter" if kind == "trace" else kind,
        "quiet": kind == "trace",
        "odds": odds_number(finding.log10_odds),
        "log10_odds": finding.log10_odds,
        "against": against_words(finding),
        "sizes": [s.sentence for s in found_sizes(discovery, finding)],
        "rivals": rival_words(finding) or "–",
        "physics": EFFECTS[ident].physics,
        "shown_by": EFFECTS[ident].shown_by,
    }
