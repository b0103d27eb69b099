"""The effects that a discovery asks for as rows: one for each of their numbers."""

from __future__ import annotations

import math
from dataclasses import dataclass

import pandas as pd

from doe_kc.discovery.result import Discovery, Finding
from doe_kc.discovery.thresholds import CERTAIN, NAME_PROBABILITY
from doe_kc.discovery.verdict.sentences import against_words
from doe_kc.effects import EFFECTS
from doe_kc.report.discovery_sizes import FoundSize, found_sizes
from doe_kc.report.discovery_words import effect_label, mistaken_words, place_of


@dataclass(frozen=True)
class EffectRow:
    """One number of one effect; size is None for an effect that is there or not. kind: as `kind_of`."""

    finding: Finding
    kind: str
    size: FoundSize | None

    @property
    def label(self) -> str:
        """Name of the effect."""
        return effect_label(self.finding.hypothesis.effect)

    @property
    def place(self) -> str:
        """Where or how, in words."""
        return place_of(self.finding.hypothesis)


def effect_rows(discovery: Discovery) -> list[EffectRow]:
    """Findings, largest first, then traces."""
    out: list[EffectRow] = []
    for finding in (*discovery.findings, *discovery.traces):
        own = kind_of(discovery, finding)
        sizes: list[FoundSize | None] = list(found_sizes(discovery, finding))
        out += [EffectRow(finding, own, size) for size in sizes or [None]]
    return out


def kind_of(discovery: Discovery, finding: Finding) -> str:
    """found; most likely, of several that cannot be told apart; lead only, where the verdict is unexplained;
    trace, seen but too small to matter."""
    if finding not in discovery.findings:
        return "trace"
    if discovery.verdict == "unexplained":
        return "lead only"
    return "found" if finding.probability >= NAME_PROBABILITY else "most likely"


def rival_words(finding: Finding) -> str:
    """What it could be instead, with the probabilities."""
    return ", ".join(f"{effect_label(r.effect)} {100.0 * r.probability:.1f} %" for r in finding.rivals)


def effect_frame(discovery: Discovery) -> pd.DataFrame:
    """One row a number of an effect: value, sd, unit, probability, odds, rivals, physics."""
    return pd.DataFrame([_record(r) for r in effect_rows(discovery)], columns=list(EFFECT_COLUMNS))


EFFECT_COLUMNS = (
    "effect", "label", "place", "kind", "probability", "log10_odds", "against", "size", "value", "sd",
    "unit", "typical", "times_typical", "in_words", "gain_ln_evidence", "detectability_sd",
    "wrong_name_chance", "rivals", "physics", "shown_by", "mistaken_for",
)  # fmt: skip


def _record(row: EffectRow) -> dict[str, object]:
    f, s = row.finding, row.size
    ident = f.hypothesis.effect
    return {
        "effect": ident,
        "label": row.label,
        "place": row.place,
        "kind": row.kind,
        "probability": f.probability,
        "log10_odds": min(f.log10_odds, CERTAIN),
        "against": against_words(f),
        "size": s.size.name if s else "",
        "value": s.estimate.value if s else math.nan,
        "sd": s.estimate.sd if s else math.nan,
        "unit": s.size.unit if s else "",
        "typical": s.size.typical if s else math.nan,
        "times_typical": s.times if s else math.nan,
        "in_words": s.words if s else "present",
        "gain_ln_evidence": f.gain,
        "detectability_sd": f.detectability,
        "wrong_name_chance": f.wrong_name,
        "rivals": rival_words(f),
        "physics": EFFECTS[ident].physics,
        "shown_by": EFFECTS[ident].shown_by,
        "mistaken_for": mistaken_words(ident),
    }
