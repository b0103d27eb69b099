"""The verdict: named, one of a class, none needed, or unexplained."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from doe_kc.discovery.fit import Fit
from doe_kc.discovery.result import Finding, VerdictKind
from doe_kc.discovery.screening.disagreement import Map
from doe_kc.discovery.thresholds import (
    GAP_CLEAR,
    GAP_CLOSURE,
    HARM,
    HARM_SHARE,
    HELD_OUT_LIMIT,
    NAME_PROBABILITY,
    NOISE_CHANCE,
)
from doe_kc.discovery.verdict.held_out import HeldOut
from doe_kc.effects.words import hypothesis_words


@dataclass(frozen=True)
class Verdict:
    """The verdict and its objections."""

    kind: VerdictKind
    """named, class, none or unexplained."""
    objections: tuple[str, ...] = ()
    """What speaks against a name, in clauses; empty unless unexplained."""


def verdict(
    findings: Sequence[Finding],
    remaining: Map,
    held_out: Sequence[HeldOut],
    tuned: Fit,
    with_effects: Fit,
) -> Verdict:
    """The verdict on the relevant findings. remaining: map of what the fit with the effects leaves."""
    closure = _gap_closure(tuned, with_effects)
    agrees = remaining.chance >= NOISE_CHANCE
    if not findings:
        return Verdict("none") if agrees else Verdict("unexplained")
    objections = [*_implausible(findings), *_harmed(held_out), *_missed(held_out)]
    if closure < GAP_CLOSURE:
        objections.append(f"it closes only {closure:.0%} of the gap that re-tuning leaves")
    if not agrees:
        worst, z = remaining.worst(1)[0]
        objections.append(
            f"{worst.load_case}, {worst.response}, {worst.shape} still disagrees by {abs(z):.1f} "
            "standard deviations"
        )
    if objections:
        return Verdict("unexplained", tuple(objections))
    return Verdict("class" if any(map(ambiguous, findings)) else "named")


def ambiguous(finding: Finding) -> bool:
    """Whether the effect cannot be told from others of the library."""
    others = sum(r.probability for r in finding.rivals)
    return finding.probability < NAME_PROBABILITY * (finding.probability + others) or bool(finding.alike)


def classes(findings: Sequence[Finding]) -> tuple[tuple[str, ...], ...]:
    """For every effect that is not sure: it and the rivals that it cannot be told from."""
    return tuple(class_of(f) for f in findings if ambiguous(f))


def class_of(finding: Finding) -> tuple[str, ...]:
    """Ids of an effect and of the rivals that it cannot be told from."""
    return tuple(
        dict.fromkeys((finding.hypothesis.effect, *(r.effect for r in finding.rivals), *finding.alike))
    )


def _implausible(findings: Sequence[Finding]) -> list[str]:
    return [
        f"{hypothesis_words(f.hypothesis)} would have to be {f.largest:.1f} times its typical size, more "
        "than such a part is believed to have"
        for f in findings
        if not f.believed
    ]


def _harmed(held_out: Sequence[HeldOut]) -> list[str]:
    total = sum(h.gain for h in held_out)
    if held_out and total <= 0.0:
        return ["load cases held out are not predicted better"]
    allowed = max(HARM, HARM_SHARE * total)
    return [
        f"held-out load case {h.load_case} is predicted worse than without the effect"
        for h in held_out
        if h.gain < -allowed
    ]


def _missed(held_out: Sequence[HeldOut]) -> list[str]:
    """Load cases that the model does not predict, however much better than without the effects."""
    return [
        f"held-out load case {h.load_case} deviates from its prediction by an RMS of "
        f"{h.law_granted.rms:.2f}, {h.law_granted.excess:.0f} standard deviations more than noise"
        for h in held_out
        if h.law_granted.excess > HELD_OUT_LIMIT
    ]


def _gap_closure(tuned: Fit, with_effects: Fit) -> float:
    """Share of the gap beyond noise that is closed; 1 where there is no clear gap."""
    expected = float(tuned.residual.size)
    before, after = tuned.misfit - expected, with_effects.misfit - expected
    if before < GAP_CLEAR * (2.0 * expected) ** 0.5:
        return 1.0
    return 1.0 - max(0.0, after) / before
