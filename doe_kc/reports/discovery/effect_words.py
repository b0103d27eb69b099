"""An effect as a test engineer reads it: what, how large, how sure, how to confirm; no statistics."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from doe_kc.correlation.answer_record import EffectWords
from doe_kc.discovery.result import Discovery, Finding
from doe_kc.discovery.verdict.sentences import trace_words
from doe_kc.discovery.verdict.size_words import told_sizes
from doe_kc.effects import EFFECTS
from doe_kc.effects.hypothesis import Size
from doe_kc.effects.words import effect_label, hypothesis_label
from doe_kc.reports.discovery.effects import kind_of
from doe_kc.reports.discovery.words import physics_words
from doe_kc.reports.table import Column, PageCell, PageLayout, Table

SIZE_WORDS: Mapping[str, str] = {
    "camber_Nm_deg": "stiffness in camber",
    "toe_Nm_deg": "stiffness in toe",
    "torsion_Nm_deg": "stiffness in torsion",
    "k_Nm_deg": "stiffness in bending",
    "k_N_mm": "stiffness",
    "k_lat_N_mm": "lateral stiffness",
    "k_long_N_mm": "longitudinal stiffness",
    "contact_N_mm": "contact stiffness",
    "force_N": "friction force",
    "presliding_mm": "travel until it slides",
    "gap_mm": "free play",
    "offset_mm": "offset",
    "reference_N": "force at which it grows",
    "reference_Nm": "moment half way between the two",
    "scale": "stiffness factor",
    "shares": "share of slider",
    "loaded_factor": "stiffness under load over that at rest",
    "exponent": "exponent of the law",
    "spread": "spread of the law",
}
"""Option of an effect -> what it is called; others by their own names without the unit."""
AXIS_LETTERS = "XYZ"
"""Of a list option's components; a shape's are numbered."""


def effect_words(discovery: Discovery, finding: Finding) -> EffectWords:
    """One line of the verdict."""
    effect = EFFECTS[finding.hypothesis.effect]
    return EffectWords(
        label=hypothesis_label(finding.hypothesis),
        kind=kind_of(discovery, finding),
        sizes=[f"{size_name(s.size, finding.hypothesis.location)} {s.words}" for s in told_sizes(finding)],
        sure=sure_words(discovery, finding),
        physics=physics_words(finding),
        rivals=", ".join(
            f"{effect_label(r.effect).lower()} ({_percent(r.probability)})" for r in finding.rivals
        ),
        confirm=effect.shown_by,
    )


def size_name(size: Size, location: str | None = None) -> str:
    """`stiffness in camber`, `LLR, X`, `share of slider 4`; without the location, which is said already."""
    suffix = "_" + size.unit.replace("/", "_")
    name = SIZE_WORDS.get(size.key, size.key.removesuffix(suffix).replace("_", " "))
    if size.index is None:
        return name
    if size.shape:
        return f"{name} {size.index + 1}"
    axis = AXIS_LETTERS[size.index]
    return axis if size.key == location else f"{name}, {axis}"


def sure_words(discovery: Discovery, finding: Finding) -> str:
    """How sure it is that the car has the effect, see `Finding.probability`."""
    kind = kind_of(discovery, finding)
    if kind == "trace":
        return f"seen, {trace_words(finding)}"
    if kind == "lead only":
        return "a lead: it explains part of the records, something else is at work beside it"
    chance = _percent(finding.probability)
    return f"sure ({chance})" if kind == "found" else f"most likely ({chance})"


def _percent(share: float) -> str:
    """Whole percents; neither certain nor impossible."""
    if share > 0.99:
        return "more than 99 %"
    return "less than 1 %" if share < 0.01 else f"{100.0 * share:.0f} %"


EFFECT_WORDS_COLUMNS: tuple[Column[EffectWords], ...] = (
    Column("label", "What", lambda e: e.label, page=PageCell(style="first wrap", strong=lambda e: True)),
    Column("physics", "What happens in the car", lambda e: e.physics, page=PageCell(style="wide")),
    Column("sizes", "How large", lambda e: "; ".join(e.sizes) or "present", page=PageCell(style="wide")),
    Column("sure", "How sure", lambda e: e.sure, page=PageCell(style="remark")),
    Column("rivals", "Could also be", lambda e: e.rivals or "–", page=PageCell(style="remark")),
    Column("confirm", "How to confirm", lambda e: e.confirm, page=PageCell(style="wide")),
)


def effect_words_table(words: Sequence[EffectWords]) -> Table[EffectWords]:
    """One row an effect, in its order; leads and traces in grey."""
    layout = PageLayout[EffectWords](
        "effects-table", "Effects", quiet=lambda e: e.kind in ("lead only", "trace")
    )
    return Table("Effects", "What the model lacks.", EFFECT_WORDS_COLUMNS, words, page=layout)
