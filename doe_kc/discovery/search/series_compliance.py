"""A compliance in series with a friction, whose part the law of the friction has taken.

A friction on a mount that yields makes nearly the loops of half the friction on a rigid one: the mount takes
up the motion that the friction has before it slides. Beside a law that fits without it, such a compliance
promises nothing to first order, and by another law it would be in the set. So compliances in series with a
friction are fitted at their typical size, and what is less probable with them counts for the friction's size.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from doe_kc.discovery.fit import Fit
from doe_kc.discovery.gauss_newton import FitStart
from doe_kc.discovery.search.compatibility import compatible
from doe_kc.discovery.search.effect_search import EffectSearch
from doe_kc.discovery.search.free_shapes import within_trace
from doe_kc.discovery.search.law_variants import default_law, frictions, other_laws, with_law
from doe_kc.discovery.search.laws_first import laws_of
from doe_kc.discovery.search.refits import HypothesisFit
from doe_kc.discovery.search.search import search_from
from doe_kc.discovery.search.series_start import in_series, series_starts
from doe_kc.discovery.thresholds import (
    ACCEPTED_ODDS,
    BEYOND_DOUBT,
    FREE_SHAPE_LOSS,
    LARGER_SET_ODDS,
    NOISE_CHANCE,
)
from doe_kc.discovery.workers import DiscoveryWorkers
from doe_kc.effects.hypothesis import Hypothesis


def with_series_compliances(
    search: EffectSearch, library: Sequence[Hypothesis], workers: DiscoveryWorkers
) -> EffectSearch:
    """The search, gone on from its last set with a compliance in series with one of its frictions, where that
    leads to a better one; with those sets that it does not go on from, as `larger`.

    A set that leaves something unexplained is left only for one that noise explains: else what is missing
    asks for anything. A set by the friction's own law is the better one where it is the more probable one; by
    another law it must fit better than any free shape could: a friction of two stages, 276 N, became 397 +-
    33 N on a mount that is not there. Every closed law is asked, and the own one from where it makes the same
    loops: a steering friction of 190 N on a mount of 4130 N/mm had become 95.2 +- 1.2 N by Duhem's law, one
    of 236 N on 7600 N/mm 155.1 +- 4.0 N by a free shape, one of 332 N by a law of other yield distances on
    4250 N/mm 201.0 +- 2.3 N by Prandtl-Iwan's, by which a mount brings nothing, and one of two stages, 240 N
    on 3040 N/mm, 133 +- 1 N by a free shape that did not find it. Not of a trace: half of it is one too.

    Asked again of the better set: by the law that the friction has with the compliance it may do without. 201
    N of sliders by a law of wide spread were 133.0 +- 1.6 N, that law beside no mount, with nothing said of
    184 to 203 N on mounts of 4700 to 5800 N/mm, as probable and better fits.
    """
    explained = search.with_law_discrepancy.residual_map.chance >= NOISE_CHANCE
    last, pairs = search.with_effects, _pairs(search, library)
    firsts = [_start(last, member, compliance, member) for member, compliance in pairs]
    larger: list[HypothesisFit] = []
    for pair, start, fit in zip(pairs, firsts, _fits(firsts, workers), strict=True):
        best = _best(search, pair, start, fit, workers)
        if best is None:
            continue
        compliance, gain, following = pair[1], best.gain, best.start
        if best.allowed and gain > ACCEPTED_ODDS and (explained or _explains(following, workers)):
            other = search_from(search, following, compliance, gain, library, workers)
            if other.log_posterior > search.log_posterior:
                same = laws_of(other.with_effects) == laws_of(last)
                return other if same else with_series_compliances(other, library, workers)
            gain = min(gain, other.log_posterior - search.log_posterior)
        if explained:
            sets = [HypothesisFit(compliance, best.fit, gain, best.odds), *best.alike]
            larger += [one for one in sets if one.gain > -LARGER_SET_ODDS]
    return replace(search, larger=tuple(larger)) if larger else search


@dataclass(frozen=True)
class _Reached:
    """The most probable set that the last one makes with a compliance."""

    start: FitStart
    """At its fit."""
    fit: Fit
    """Without derivatives."""
    gain: float
    """ln of its posterior odds against the last set, for the friction's size at least."""
    odds: float
    """ln of those before the records."""
    allowed: bool
    """Whether the search may go on from it."""
    alike: tuple[HypothesisFit, ...]
    """Sets by the friction's own law, where it has more numbers than the default one, by what the records
    alone say of them."""


def _best(
    search: EffectSearch,
    pair: tuple[Hypothesis, Hypothesis],
    first: FitStart,
    fit: Fit | None,
    workers: DiscoveryWorkers,
) -> _Reached | None:
    """Of the fits from every start. first: that by the friction's own law, and where it ends."""
    last, (_, compliance) = search.with_effects, pair
    odds = search.prior.log_odds(last.model.members, compliance)
    probable = fit is not None and fit.evidence - last.evidence + odds > 0.0
    starts = _other_starts(search, *pair, both=probable)
    reached = [(first, fit), *zip(starts, _fits(starts, workers), strict=True)]
    there = [(f.evidence, k, f) for k, (_, f) in enumerate(reached) if f is not None]
    if not there:
        return None
    evidence, k, best = max(there)
    gain, model = evidence - search.evidence + odds, reached[k][0].model
    allowed = probable or _by_own_law(reached[k][0], last) or best.cost + 2.0 * FREE_SHAPE_LOSS < last.cost
    if not allowed:
        gain = min(gain, 0.5 * (last.cost - best.cost) + odds)
    flexible = _has_more_numbers(search, pair[0])
    ends = [f for start, f in reached if f is not None and flexible and _by_own_law(start, last)]
    alike = tuple(HypothesisFit(compliance, f, 0.5 * (last.cost - f.cost)) for f in ends)
    return _Reached(FitStart(model, best.z, last), best, gain, odds, allowed, alike)


def _by_own_law(start: FitStart, last: Fit) -> bool:
    """Whether a start is of the last set itself, with a compliance beside it."""
    return start.model.members[:-1] == last.model.members


def _explains(start: FitStart, workers: DiscoveryWorkers) -> bool:
    """Whether noise explains what the fit from a start leaves."""
    (refit,) = workers.fits([start], "adding compliances")
    return refit is not None and refit.residual_map.chance >= NOISE_CHANCE


def _fits(starts: Sequence[FitStart], workers: DiscoveryWorkers) -> list[Fit | None]:
    """Without derivatives: nine of 10 MB each, at the end of a search."""
    return workers.fits(starts, "adding compliances", derivatives=lambda _: False)


def _pairs(search: EffectSearch, library: Sequence[Hypothesis]) -> list[tuple[Hypothesis, Hypothesis]]:
    """Each friction of the last set with each absent compliance in series with it."""
    last = search.with_effects
    return [
        (member, h)
        for member in frictions(last)
        for h in library
        if in_series(member, h) and compatible(last.model, h)
    ]


def _has_more_numbers(search: EffectSearch, member: Hypothesis) -> bool:
    """Whether the closed law of a friction, its own or that in whose place it has a free shape, has more
    numbers than the default one."""
    fits = [f for f in (search.with_effects, search.with_other_laws) if f is not None]
    numbers = [len(h.sizes) for f in fits for h in f.model.members if h.name == member.name]
    return min(numbers) > len(default_law(member).sizes)


def _closed_laws(member: Hypothesis) -> list[Hypothesis]:
    """The member by every closed law."""
    default = default_law(member)
    return [default, *other_laws(default)]


def _other_starts(
    search: EffectSearch, member: Hypothesis, compliance: Hypothesis, *, both: bool
) -> list[FitStart]:
    """By every closed law of a friction that is no trace, and by its own one: from the limit and travel that
    it may have there.

    From its own limit and travel too with `both`, and where a closed law of more numbers than the default one
    was the best.
    """
    last = search.with_effects
    if within_trace(last, member):
        return []
    closed = _closed_laws(member)
    near = [_start(last, member, compliance, law) for law in closed]
    laws = closed if member.law in {h.law for h in closed} else [*closed, member]
    far = [
        start
        for law in laws
        for start in series_starts(last, member, law, compliance, np.inf if law == member else _most(last))
    ]
    return [*near, *far] if both or _has_more_numbers(search, member) else far


def _start(last: Fit, member: Hypothesis, compliance: Hypothesis, law: Hypothesis) -> FitStart:
    """The last set with a typical compliance, a friction by its own law or another one."""
    model, z = with_law(last.model, last.z, member, law)
    typical = [0.0 if size.shape else 1.0 for size in compliance.sizes]
    return FitStart(model.extended(compliance), np.append(z, typical), last, _most(last))


def _most(last: Fit) -> float:
    """Cost above which a fit beside the last one is given up."""
    return last.cost + 2.0 * BEYOND_DOUBT
