"""Exchanges: the last set against sets with a rival or nothing in the place of one effect, until none is
more probable.

To first order an effect that is large, or that parameters at their bounds imitate, can look worse than
another that makes nearly the same deviations. Joint refits tell, and the last set's rivals have those. So do
the sets with one effect fewer: by the laws that came last an effect may be needless, or the set have another
optimum without it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from doe_kc.discovery.fit import Fit
from doe_kc.discovery.gauss_newton import FitStart
from doe_kc.discovery.search.all_places import with_all_places
from doe_kc.discovery.search.effect_search import EffectSearch
from doe_kc.discovery.search.law_exchange import with_exchanged_laws
from doe_kc.discovery.search.refits import temper
from doe_kc.discovery.search.search import search_from
from doe_kc.discovery.search.series_compliance import with_series_compliances
from doe_kc.discovery.thresholds import ACCEPTED_ODDS
from doe_kc.discovery.verdict.alternatives import Alternatives, alternatives_by_group, in_set_order
from doe_kc.discovery.workers import DiscoveryWorkers
from doe_kc.effects.hypothesis import Hypothesis


def exchanged(
    search: EffectSearch, library: Sequence[Hypothesis], workers: DiscoveryWorkers
) -> tuple[EffectSearch, tuple[Alternatives, ...]]:
    """The search, gone on from sets with another law, or with a rival or nothing in one effect's place, as
    long as those are more probable.

    With the alternatives of every member of its last set. It ends, since the probability of the last set, its
    errors its own, grows with each exchange. The first members that are exchanged for something are not
    compared with what follows: the others change with the set.
    """
    while True:
        search = _with_other_laws(search, library, workers)
        compared: list[Alternatives] = []
        for some in alternatives_by_group(search, temper(search.with_law_discrepancy), workers):
            compared += some
            other = _exchanged_by(search, some, library, workers)
            if other is not search:
                break
        else:
            return search, in_set_order(search, compared)
        search = other
        del compared, some, other  # before the next ones: fits of both sets at once took 50 MB more


def _exchanged_by(
    search: EffectSearch,
    some: Sequence[Alternatives],
    library: Sequence[Hypothesis],
    workers: DiscoveryWorkers,
) -> EffectSearch:
    """The search, gone on from the best set by the alternatives of some members; the same where that ends no
    more probable."""
    better = better_set(some)
    if better is None:
        return search
    other = search_from(search, _start(search, better), better.rival, better.gain, library, workers)
    return other if other.log_posterior > search.log_posterior else search


def _start(search: EffectSearch, better: BetterSet) -> FitStart:
    """Of a fit of the better set, beside the last one."""
    last = search.with_effects
    model = last.model.without(better.own)
    return FitStart(model.extended(better.rival) if better.rival else model, better.fit.z, last)


def _with_other_laws(
    search: EffectSearch, library: Sequence[Hypothesis], workers: DiscoveryWorkers
) -> EffectSearch:
    """The search, gone on from sets with an effect in all its places, with another law, or with what a law
    has taken up."""
    joined = with_all_places(search, library, workers)
    return with_series_compliances(with_exchanged_laws(joined, library, workers), library, workers)


@dataclass(frozen=True)
class BetterSet:
    """The last set without one of its effects, maybe with a rival in its place."""

    own: Hypothesis
    """The effect."""
    rival: Hypothesis | None
    """What is in its place; None for nothing."""
    fit: Fit
    """Of the set, the rival as its last member."""
    gain: float
    """ln of its posterior odds against the last set."""


def better_set(compared: Sequence[Alternatives]) -> BetterSet | None:
    """The set of the largest posterior odds against the last one.

    None where no odds reach those at which an effect is accepted.
    """
    sets = [
        (BetterSet(one.hypothesis, rival, fit, gain - one.trials[0].gain), one.temper)
        for one in compared
        for rival, fit, gain in (
            (None, one.without, 0.0),
            *((t.hypothesis, t.fit, t.gain) for t in one.trials[1:]),
        )
    ]
    better = (one for one, divisor in sets if one.gain / divisor > ACCEPTED_ODDS)
    return max(better, key=lambda one: one.gain, default=None)
