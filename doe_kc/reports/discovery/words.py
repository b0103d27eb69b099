"""What is said of a discovery in the same words everywhere: effects, shapes, sizes with their uncertainty."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from doe_kc.axle.design_parameters import design_parameters
from doe_kc.axle.model import FORCE_AXES, Axle
from doe_kc.axle.places import places_of
from doe_kc.curves import response_name
from doe_kc.discovery.result import Discovery, Finding, VerdictKind
from doe_kc.discovery.screening.contrasts import Contrast
from doe_kc.discovery.verdict.exclusion import HypothesisStatus, Status, exclusion_limit
from doe_kc.effects import EFFECTS
from doe_kc.effects.hypothesis import Hypothesis, Size
from doe_kc.effects.words import effect_label, hypothesis_words
from doe_kc.ground.numbers import number, unit_words
from doe_kc.load_cases import case_label

_HEADLINES: dict[VerdictKind, str] = {
    "named": "Effect named",
    "class": "One of several effects",
    "none": "No effect missing",
    "unexplained": "Unexplained",
}
STATUS_WORDS: dict[Status, str] = {
    "found": "found",
    "trace": "seen, not named",
    "excluded": "would have shown",
    "unresolved": "not resolved",
    "not testable": "not testable",
    "no solution": "has no equilibrium in this axle",
}
MODEL_LABELS = {
    "nominal": "as handed in",
    "tuned": "re-tuned",
    "with_effect": "with the effect",
    "best_decoy": "with the best other effect",
}
"""Names of the four models that are compared, by their field in `Gap`."""


def headline(discovery: Discovery) -> str:
    """The verdict in a few words."""
    several = discovery.verdict == "named" and len(discovery.findings) > 1
    return "Effects named" if several else _HEADLINES[discovery.verdict]


def model_head(model: str) -> str:
    """Its name as the head of a column."""
    return MODEL_LABELS[model].capitalize()


def own_sentences(discovery: Discovery) -> list[str]:
    """The verdict in words; without what remains unexplained where that is listed in full beside it."""
    return [s for s in discovery.sentences if not (discovery.unexplained and s.startswith("Unexplained:"))]


def other_laws_words(before: Sequence[Hypothesis], after: Sequence[Hypothesis]) -> str:
    """Which members of a set have another law than in the one before: `other law of strut friction`; "" for
    none."""
    laws = {h.name: h.law for h in before}
    names = [hypothesis_words(h) for h in after if h.law != laws.get(h.name, h.law)]
    return f"other law of {' and '.join(names)}" if names else ""


def physics_words(finding: Finding) -> str:
    """What happens in the car, and what it means at the sizes that were estimated."""
    options: dict[str, Any] = dict(finding.hypothesis.fixed)
    options |= {e.key: e.value for e in finding.estimates if e.index is None}
    effect = EFFECTS[finding.hypothesis.effect]
    return f"{effect.physics} {effect.consequence(options)}".strip()


def mistaken_words(ident: str, axle: Axle) -> str:
    """What looks alike on such an axle, effects by their names and parameters by their paths."""
    places, parameters = places_of(axle), {p.path for p in design_parameters(axle)}
    return ", ".join(
        effect_label(m) if m in EFFECTS else m
        for m in EFFECTS[ident].mistaken_for
        if (EFFECTS[m].possible(places) if m in EFFECTS else m in parameters)
    )


def contrast_words(contrast: Contrast) -> str:
    """`Lateral force, in phase: toe, loop width (left against right)`."""
    shape = "" if contrast.shape == "static" else f", {contrast.shape}"
    return f"{case_label(contrast.load_case)}: {response_name(contrast.response)}{shape} ({wheels(contrast)})"


def wheels(contrast: Contrast) -> str:
    """Which way the wheels disagree."""
    return "both wheels" if contrast.wheels == "both" else "left against right"


def limit_words(standing: HypothesisStatus) -> str:
    """From which size on the effect would have been seen, e.g. `k_N_mm below 9000 N/mm`.

    Of a list the components that have a limit: `|LLR| above 370 (x), 910 (y) N`.
    """
    if not math.isfinite(standing.detectable) or not standing.hypothesis.sizes:
        return "–"
    known = list(zip(standing.hypothesis.sizes, standing.limits, strict=True))
    parts = [
        _limit(s, [a for other, a in known if other.key == s.key]) for s in merged_sizes(standing.hypothesis)
    ]
    return "; ".join(p for p in parts if p)


def merged_sizes(hypothesis: Hypothesis) -> list[Size]:
    """One size of each option: the components of a list are alike."""
    return list({s.key: s for s in reversed(hypothesis.sizes)}.values())[::-1]


def _limit(size: Size, amplitudes: Sequence[float]) -> str:
    """Of one option; amplitudes: of each of its components."""
    said = [a if exclusion_limit(size, a) is not None else math.nan for a in amplitudes]
    if size.shape:
        return ""
    if all(map(math.isnan, said)):
        return f"{size.key} not shown"
    value = f"{_numbers(size, said)}{unit_words(size.unit)}"
    if size.growth == "compliance":
        return f"{size.key} below {value}"
    if size.growth == "factor":
        low = _numbers(size, [-a for a in said], 4)
        return f"{size.key} below {low} or above {_numbers(size, said, 4)}"
    return f"{'|' + size.key + '|' if size.signed else size.key} above {value}"


def _numbers(size: Size, amplitudes: Sequence[float], digits: int = 3) -> str:
    """At the amplitudes that are known; those of a list with their axes."""
    axes = [f" ({axis[-1]})" for axis in FORCE_AXES] if len(amplitudes) > 1 else [""]
    known = ((a, axis) for a, axis in zip(amplitudes, axes, strict=True) if math.isfinite(a))
    return ", ".join(f"{number(size.value(a), digits)}{axis}" for a, axis in known)


def typical_words(hypothesis: Hypothesis) -> str:
    """Typical size, e.g. `force_N 250 N`."""
    return "; ".join(f"{s.key} {number(s.typical)}{unit_words(s.unit)}" for s in merged_sizes(hypothesis))
