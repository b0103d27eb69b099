"""The effects that a discovery asks for as rows: one for each of their numbers."""

from __future__ import annotations

import math
from dataclasses import dataclass

from doe_kc.discovery.result import Discovery, Finding
from doe_kc.discovery.thresholds import CERTAIN
from doe_kc.discovery.verdict.sentences import against_words
from doe_kc.discovery.verdict.size_words import SizeEstimate, size_estimates
from doe_kc.effects import EFFECTS
from doe_kc.effects.words import effect_label, place_of
from doe_kc.ground.numbers import sd_format
from doe_kc.reports.discovery.words import mistaken_words, physics_words
from doe_kc.reports.table import Column, SheetLayout, Table

ODDS = '[>=6]"> 6";0.0'
"""log10 odds; 6 stands for 6 or more."""


@dataclass(frozen=True)
class EffectRow:
    """One number of one effect; size is None for an effect that is there or not. kind: as `kind_of`.
    mistaken: what looks alike on the axle. first: whether it is the effect's first one."""

    finding: Finding
    kind: str
    size: SizeEstimate | None
    mistaken: str
    first: bool

    @property
    def effect(self) -> str:
        """Its id in the library."""
        return self.finding.hypothesis.effect

    @property
    def label(self) -> str:
        """Name of the effect."""
        return effect_label(self.effect)

    @property
    def place(self) -> str:
        """Where or how, in words."""
        return place_of(self.finding.hypothesis)

    @property
    def told(self) -> bool:
        """Whether it is a number with a standard deviation: a limit and what is not shown are words alone."""
        return self.size is not None and self.size.seen

    @property
    def value(self) -> float:
        """The number, in its unit; nan without one."""
        return self.size.estimate.value if self.size else math.nan

    @property
    def sd(self) -> float:
        """Of the number, in its unit; nan without one."""
        return self.size.estimate.sd if self.size else math.nan

    @property
    def times_typical(self) -> float:
        """The number over its typical size, see `Size.over_typical`; nan where none is told."""
        return self.size.size.over_typical(self.value) if self.size and self.told else math.nan


def effect_rows(discovery: Discovery) -> list[EffectRow]:
    """Findings, largest first, then traces."""
    out: list[EffectRow] = []
    for finding in (*discovery.findings, *discovery.traces):
        own = kind_of(discovery, finding)
        sizes: list[SizeEstimate | None] = list(size_estimates(finding))
        alike = mistaken_words(finding.hypothesis.effect, discovery.fitted.model.axle)
        out += [EffectRow(finding, own, size, alike, i == 0) for i, size in enumerate(sizes or [None])]
    return out


def kind_of(discovery: Discovery, finding: Finding) -> str:
    """found; most likely, of several that cannot be told apart; lead only, where something else remains;
    trace, seen but too small to matter or too weakly to be named."""
    if finding not in discovery.findings:
        return "trace"
    return {"lead": "lead only", "named": "found", "class": "most likely"}[finding.verdict]


def rival_words(finding: Finding) -> str:
    """What it could be instead, with the probabilities."""
    return ", ".join(f"{effect_label(r.effect)} {100.0 * r.probability:.1f} %" for r in finding.rivals)


EFFECT_COLUMNS: tuple[Column[EffectRow], ...] = (
    Column("effect", None, lambda r: r.effect),
    Column("label", "Effect", lambda r: r.label, width=36, cell=lambda r: f"{r.label} ({r.effect})"),
    Column("place", "Place", lambda r: r.place, width=16),
    Column("kind", "Kind", lambda r: r.kind, width=9),
    Column("probability", "Probability", lambda r: r.finding.probability, "0.0%"),
    Column("log10_odds", "log10 odds", lambda r: min(r.finding.log10_odds, CERTAIN), ODDS, 8),
    Column("against", "Against", lambda r: against_words(r.finding), width=22),
    Column("size", "Size", lambda r: r.size.size.name if r.size else "", width=16),
    Column("value", "Value", lambda r: r.value, lambda r: sd_format(r.sd), 13,
           cell=lambda r: r.value if r.told else math.nan),
    Column("sd", "sd", lambda r: r.sd, lambda r: sd_format(r.sd),
           cell=lambda r: r.sd if r.told else math.nan),
    Column("unit", "Unit", lambda r: r.size.size.unit if r.size else "", width=9),
    Column("typical", "Typical", lambda r: r.size.size.typical if r.size else math.nan, "0.000", 10),
    Column("times_typical", "Times typical", lambda r: r.times_typical, "0.00", 10),
    Column("in_words", "In words", lambda r: r.size.words if r.size else "present", width=34),
    Column("gain_ln_evidence", "ln evidence", lambda r: r.finding.gain, "0.0", 12),
    Column("detectability_sd", "Detectability, sd", lambda r: r.finding.detectability, "0.0", 13),
    Column("wrong_name_chance", "Chance of a wrong name", lambda r: r.finding.wrong_name, "0.00%", 12),
    Column("rivals", "Rivals", lambda r: rival_words(r.finding), width=34),
    Column("physics", "What happens in the car", lambda r: physics_words(r.finding), width=44,
           cell=lambda r: physics_words(r.finding) if r.first else ""),
    Column("shown_by", "Shown by", lambda r: EFFECTS[r.effect].shown_by, width=44,
           cell=lambda r: EFFECTS[r.effect].shown_by if r.first else ""),
    Column("mistaken_for", "Mistaken for", lambda r: r.mistaken, width=34,
           cell=lambda r: r.mistaken if r.first else ""),
)  # fmt: skip


def effect_table(discovery: Discovery) -> Table[EffectRow]:
    """One row a number of an effect: value, sd, unit, probability, odds, rivals, physics. What is the same of
    every car is not printed."""
    rows = effect_rows(discovery)
    return Table(
        "Effects",
        "What the records ask for; leads where the verdict is unexplained.",
        EFFECT_COLUMNS,
        rows,
        empty="No effect is asked for.",
        sheet=SheetLayout(
            frozen="kind",
            wrapped=True,
            printed_to="rivals",
            printed=max(1, len(rows)),
        ),
    )
