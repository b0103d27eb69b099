"""Why the size of a friction is told so widely: what it would be beside a compliance in series with it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from doe_kc.discovery.fit import Fit, amplitude_estimates
from doe_kc.discovery.result import Finding
from doe_kc.discovery.search.effect_search import EffectSearch
from doe_kc.discovery.search.series_start import in_series
from doe_kc.discovery.thresholds import LARGER_SET_ODDS, RELEVANT, SIZE_APART
from doe_kc.discovery.verdict.alternatives import Alternatives
from doe_kc.effects.hypothesis import Hypothesis, Size
from doe_kc.effects.words import hypothesis_words
from doe_kc.ground.numbers import number, unit_words

OTHER_SIZE = "Another size: "
"""Begins such a sentence."""
HARDLY_TOLD = (
    "the records hardly tell a friction on a mount that yields from a smaller one on a stiffer mount, so "
    "that its size is told as wide as both."
)


def other_sizes(
    search: EffectSearch, compared: Sequence[Alternatives], findings: Sequence[Finding]
) -> tuple[str, ...]:
    """A sentence for each friction that would be another one beside another stiffness in series with it.

    Of the sets and optima that count for its standard deviation, the one with the size furthest off: see
    `EffectSearch.larger` and `optima`, and those without a compliance of the last set, by `compared`.
    """
    return tuple(sentence for f in findings for sentence in _sentence(search, compared, f))


def _sentence(search: EffectSearch, compared: Sequence[Alternatives], finding: Finding) -> Iterator[str]:
    own = finding.hypothesis
    told = finding.estimates[0].value if finding.estimates else 0.0
    others = [*_beside(search, own), *_without(compared, own)]
    value, beside = max(others, key=lambda one: abs(one[0] - told), default=(told, ""))
    if abs(value - told) > SIZE_APART * abs(told):
        size = _words(_size(own), value)
        yield f"{OTHER_SIZE}{hypothesis_words(own)} would be {size} {beside}; {HARDLY_TOLD}"


def _beside(search: EffectSearch, own: Hypothesis) -> Iterator[tuple[float, str]]:
    """What a friction is with a compliance, and which; without it where it is a trace."""
    for fit in (*(one.fit for one in search.larger), *search.optima):
        for compliance in (h for h in fit.model.members if in_series(own, h)):
            if _amplitude(compliance, fit) < RELEVANT:
                beside = f"without {hypothesis_words(compliance)}"
            else:
                stiffness = _words(_size(compliance), _value(compliance, fit))
                beside = f"with {hypothesis_words(compliance)} of {stiffness}"
            yield _value(own, fit), beside


def _without(compared: Sequence[Alternatives], own: Hypothesis) -> Iterator[tuple[float, str]]:
    """What it is without one of the last set, where that is no less probable than such sets may be."""
    for one in compared:
        if in_series(own, one.hypothesis) and one.trials[0].gain / one.temper < LARGER_SET_ODDS:
            yield _value(own, one.without), f"without {hypothesis_words(one.hypothesis)}"


def _value(member: Hypothesis, fit: Fit) -> float:
    """Of the size that says how much, in a fit that has the member by any law."""
    return _size(member).value(_amplitude(member, fit))


def _amplitude(member: Hypothesis, fit: Fit) -> float:
    """Of that size, in typical ones."""
    there = fit.model.member(member.name)
    amplitudes, _ = amplitude_estimates(fit, there)
    return float(amplitudes[there.sizes.index(_size(there))])


def _size(member: Hypothesis) -> Size:
    return next(size for size in member.sizes if not size.shape)


def _words(size: Size, value: float) -> str:
    return f"{number(value)}{unit_words(size.unit)}"
