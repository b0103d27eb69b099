"""An effect that a set has in several places, as one effect in all its places.

Each place comes in by itself, and to first order none is exchanged for the whole. Rubber of one axle was told
as that of the lower arms' rear bushings and that of the others.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from doe_kc.discovery.fit import Fit
from doe_kc.discovery.gauss_newton import FitStart
from doe_kc.discovery.search.effect_search import EffectSearch
from doe_kc.discovery.search.law_variants import open_laws, with_law
from doe_kc.discovery.search.search import search_from
from doe_kc.discovery.thresholds import BEYOND_DOUBT
from doe_kc.discovery.workers import DiscoveryWorkers
from doe_kc.effects.hypothesis import Hypothesis


def with_all_places(
    search: EffectSearch, library: Sequence[Hypothesis], workers: DiscoveryWorkers
) -> EffectSearch:
    """The search, gone on from its last set with one effect in all its places for those in single ones, where
    that leads to a more probable set."""
    last = search.with_effects
    for everywhere in (h for h in library if h.location is None):
        own = [h for h in last.model.members if h.effect == everywhere.effect]
        if len(own) < 2:
            continue
        start = _start(last, own, everywhere)
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


def _start(last: Fit, own: Sequence[Hypothesis], everywhere: Hypothesis) -> FitStart:
    """From the mean of the sizes in single places; by the law of most numbers where one of them has that."""
    amplitudes = [dict(zip((s.name for s in h.sizes), last.z[last.model.place(h)], strict=True)) for h in own]
    known = [[a[size.name] for a in amplitudes if size.name in a] for size in everywhere.sizes]
    sizes = [float(np.mean(values)) if values else 0.0 for values in known]
    kept = np.ones(last.z.size, dtype=bool)
    model = last.model
    for h in own:
        kept[last.model.place(h)] = False
        model = model.without(h)
    model, z = model.extended(everywhere), np.append(last.z[kept], sizes)
    if any(h.law for h in own):
        for law in open_laws(everywhere)[-1:]:
            model, z = with_law(model, z, everywhere, law)
    return FitStart(model, z, last, last.cost + 2.0 * BEYOND_DOUBT)
