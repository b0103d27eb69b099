"""How far model and records are apart, step by step: as handed in, re-tuned, with each effect, noise."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from doe_kc.discovery.result import Discovery
from doe_kc.effects.hypothesis import Hypothesis
from doe_kc.effects.words import hypothesis_label


@dataclass(frozen=True)
class GapStep:
    """label: what was done. gap: whitened RMS of all records then, in units of their own errors."""

    label: str
    gap: float


def gap_steps(discovery: Discovery) -> list[GapStep]:
    """In the order of the search; the last one is the axle handed over. Effects that the search took back
    are named with the step that did so."""
    out = [GapStep("model as handed in", discovery.gap.nominal), GapStep("re-tuned", discovery.gap.tuned)]
    before: Sequence[Hypothesis] = ()
    for step in discovery.search.steps[1:]:
        if list(step.members) != list(before):
            out.append(GapStep(_changed(before, step.members), step.gap))
        before = step.members
    last = discovery.fitted.model.members
    if list(last) != list(before):
        out.append(GapStep(_changed(before, last), discovery.gap.with_effect))
    elif last:
        out[-1] = GapStep(out[-1].label, discovery.gap.with_effect)
    return out


def _changed(before: Sequence[Hypothesis], after: Sequence[Hypothesis]) -> str:
    """`+ steering friction`, `− strut bending`."""
    new = [f"+ {_name(h)}" for h in after if h.name not in {b.name for b in before}]
    gone = [f"− {_name(h)}" for h in before if h.name not in {a.name for a in after}]
    return ", ".join([*new, *gone]) or "refitted"


def _name(hypothesis: Hypothesis) -> str:
    label = hypothesis_label(hypothesis)
    return label[0].lower() + label[1:]
