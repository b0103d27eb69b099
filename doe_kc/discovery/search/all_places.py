"""The last set with one effect in all its places for those in single ones."""

from __future__ import annotations

from collections.abc import Sequence

from doe_kc.discovery.gauss_newton import FitStart
from doe_kc.discovery.search.effect_search import EffectSearch
from doe_kc.discovery.search.joined_places import joined_starts
from doe_kc.discovery.search.search import search_from
from doe_kc.discovery.workers import DiscoveryWorkers
from doe_kc.effects.hypothesis import Hypothesis


def with_all_places(
    search: EffectSearch, library: Sequence[Hypothesis], workers: DiscoveryWorkers
) -> EffectSearch:
    """The search, gone on from its last set with one effect in all its places for those in single ones, where
    that leads to a more probable set: by the laws that came last it may be, although it was not in the step
    that brought in a further place."""
    last = search.with_effects
    for everywhere, start in joined_starts(last, library):
        (fit,) = workers.fits([start], "joining places")
        if fit is None:
            continue
        prior = search.prior.log(fit.model.members) - search.prior.log(last.model.members)
        gain = fit.evidence - last.evidence + prior
        if gain <= 0.0:
            continue
        other = search_from(search, FitStart(fit.model, fit.z, fit), everywhere, gain, library, workers)
        if other.log_posterior > search.log_posterior:
            return other
    return search
