"""Where every effect of the library stands: found, excluded from a size on, or not testable and why."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

from doe_kc.discovery.result import Discovery
from doe_kc.discovery.verdict.exclusion import HypothesisStatus
from doe_kc.effects import EFFECTS
from doe_kc.effects.words import effect_label, hypothesis_label, place_of
from doe_kc.reports.discovery.words import STATUS_WORDS, limit_words, mistaken_words, typical_words
from doe_kc.reports.table import Column, PageCell, PageLayout, SheetLayout, Table

STATUS_ORDER = tuple(STATUS_WORDS)
MOST_TIMES = 100.0
"""Times its typical size beyond which how large an effect would have to be is of no use."""


@dataclass(frozen=True)
class LibraryRow:
    """One hypothesis. labels: of all hypotheses by their names. mistaken: what looks alike on the axle."""

    status: HypothesisStatus
    labels: Mapping[str, str]
    mistaken: str

    @property
    def effect(self) -> str:
        """Id in the library."""
        return self.status.hypothesis.effect

    @property
    def tag(self) -> str:
        """The status as one word."""
        return self.status.status.replace(" ", "-")

    @property
    def hidden_by(self) -> str:
        """Parameters that take the effect's place, with their move in standard deviations of the prior, those
        that round to none left out."""
        return ", ".join(f"{path} ({move:+.1f} sd)" for path, move in self.status.hidden_by if round(move, 1))

    @property
    def parts_to_measure(self) -> str:
        """Parts that a bench has to measure for the effect to show, and by how much it then does."""
        test = self.status.component_test
        return "" if test is None else f"{', '.join(test.parts)} ({test.separation:.0f} sd)"

    @property
    def looks_like(self) -> str:
        """Hypotheses whose remaining change is the same, with the correlation."""
        return "; ".join(f"{self.labels.get(name, name)} ({r:+.2f})" for name, r in self.status.alike)


def library_rows(discovery: Discovery) -> list[LibraryRow]:
    """By status, found ones first, then in the order of the library."""
    order = list(EFFECTS)
    labels = {s.hypothesis.name: hypothesis_label(s.hypothesis) for s in discovery.statuses}
    statuses = sorted(
        discovery.statuses,
        key=lambda s: (
            STATUS_ORDER.index(s.status),
            order.index(s.hypothesis.effect),
            s.hypothesis.name,
        ),
    )
    axle = discovery.fitted.model.axle
    mistaken = {e: mistaken_words(e, axle) for e in {s.hypothesis.effect for s in statuses}}
    return [LibraryRow(s, labels, mistaken[s.hypothesis.effect]) for s in statuses]


def _times_words(times: float) -> float | str:
    return f"> {MOST_TIMES:g}" if MOST_TIMES < times < math.inf else times


LIBRARY_COLUMNS: tuple[Column[LibraryRow], ...] = (
    Column("effect", None, lambda r: r.effect),
    Column("label", "Effect", lambda r: effect_label(r.effect), width=36,
           cell=lambda r: f"{effect_label(r.effect)} ({r.effect})",
           page=PageCell(text=lambda r: hypothesis_label(r.status.hypothesis), style="first wrap",
                         strong=lambda r: r.tag == "found",
                         attributes=lambda r: {"title": r.status.hypothesis.name})),
    Column("place", "Place", lambda r: place_of(r.status.hypothesis), width=20),
    Column("status", "Status", lambda r: r.status.status, width=13,
           words=lambda r: STATUS_WORDS[r.status.status], page=PageCell("Standing")),
    Column("detectable", "Detectable size", lambda r: limit_words(r.status), width=34,
           page=PageCell(style="remark", order=lambda r: _finite(r.status.detectable))),
    Column("detectable_times_typical", "Times typical", lambda r: r.status.detectable, "0.000", 10,
           words=lambda r: _times_words(r.status.detectable)),
    Column("typical", "Typical size", lambda r: typical_words(r.status.hypothesis), width=30,
           page=PageCell(text=lambda r: typical_words(r.status.hypothesis) or "–", style="remark")),
    Column("absorbed_percent", "Absorbed, %", lambda r: 100.0 * r.status.absorbed, "0.0", 11),
    Column("hidden_by", "Hidden by", lambda r: r.hidden_by, width=34,
           page=PageCell(text=lambda r: r.hidden_by or "–", style="remark")),
    Column("parts_to_measure", "Parts to measure", lambda r: r.parts_to_measure, width=34,
           page=PageCell(text=lambda r: r.parts_to_measure or "–", style="remark")),
    Column("looks_like", "Looks like", lambda r: r.looks_like, width=40,
           page=PageCell("Looks like, here", text=lambda r: r.looks_like or "–", style="remark")),
    Column("mistaken_for", "Mistaken for", lambda r: r.mistaken, width=40),
    Column("physics", "What happens in the car", lambda r: EFFECTS[r.effect].physics, width=50,
           page=PageCell(style="wide")),
    Column("shown_by", "Shown by", lambda r: EFFECTS[r.effect].shown_by, width=44),
)  # fmt: skip


def library_table(discovery: Discovery) -> Table[LibraryRow]:
    """One row a hypothesis; detectable in words and as a multiple of the typical size. What is the same of
    every car is not printed."""
    return Table(
        "Library",
        "Would have shown: from the detectable size on, if the model is right but for this. Not resolved: "
        "the same, but the model does not explain the records. Not testable: re-tuning absorbs it, or it "
        "shows too little; see what hides it, and the parts that, measured on a bench, would show it.",
        LIBRARY_COLUMNS,
        library_rows(discovery),
        title="Library of effects",
        sheet=SheetLayout(frozen="status", wrapped=True, printed_to="looks_like"),
        page=PageLayout(
            "library-table",
            "Library of effects",
            filtered=True,
            choices={"excluded": "would have shown only", "not-testable": "not testable only"},
            tags=lambda r: r.tag,
            quiet=lambda r: r.tag in ("not-testable", "no-solution"),
        ),
    )


def _finite(value: float) -> float:
    return value if math.isfinite(value) else math.nan
