"""The verdict in words, and the effects that the records ask for."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from doe_kc.discovery.result import Discovery, Finding
from doe_kc.discovery.sentences import against_words, odds_number
from doe_kc.effects import EFFECTS
from doe_kc.reporting.discovery_effects import kind_of, rival_words
from doe_kc.reporting.discovery_sizes import found_sizes
from doe_kc.reporting.discovery_words import (
    HEADLINES,
    contrast_words,
    effect_label,
    hypothesis_label,
    own_sentences,
)
from doe_kc.reporting.page.section import Section, render


def verdict_section(found: Discovery, notes: Mapping[str, str]) -> Section:
    """Tiles, sentences, a row for each effect, what stays open."""
    better = sum(h.gain > 0.0 for h in found.held_out)
    html = render(
        "discovery_verdict.html",
        headline=HEADLINES[found.verdict],
        clear=found.verdict in ("named", "none"),
        top=found.findings[0] if found.findings else None,
        top_odds=odds_number(found.findings[0].log10_odds) if found.findings else "",
        top_label=effect_label(found.findings[0].hypothesis.effect) if found.findings else "",
        gap=found.gap,
        has_effect=bool(found.fitted.model.members),
        better=better,
        cases=len(found.held_out),
        sentences=own_sentences(found),
        effects=[_effect(found, f) for f in (*found.findings, *found.traces)],
        alike=[" or ".join(effect_label(e) for e in group) for group in found.classes],
        unexplained=[(contrast_words(c), z) for c, z in found.unexplained],
        notes=notes,
    )
    return Section("Verdict", html)


def _effect(found: Discovery, finding: Finding) -> dict[str, Any]:
    ident = finding.hypothesis.effect
    kind = kind_of(found, finding)
    return {
        "label": hypothesis_label(finding.hypothesis),
        "kind": "seen, too small to matter" if kind == "trace" else kind,
        "quiet": kind == "trace",
        "odds": odds_number(finding.log10_odds),
        "log10_odds": finding.log10_odds,
        "against": against_words(finding),
        "sizes": [s.sentence for s in found_sizes(found, finding)],
        "rivals": rival_words(finding) or "–",
        "physics": EFFECTS[ident].physics,
        "shown_by": EFFECTS[ident].shown_by,
    }
