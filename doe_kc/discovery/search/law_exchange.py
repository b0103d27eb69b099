"""The law of a friction once the search has ended and noise does not explain what remains.

A law is worth what it explains together with the effects that it asks for: beside a wrong law a missing
effect hides and others stand in its place, and the right law may be the less probable one beside those.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from doe_kc.discovery.fit import Fit
from doe_kc.discovery.gauss_newton import FitStart
from doe_kc.discovery.screening.screen import rewhitened_screenings
from doe_kc.discovery.search.compatibility import compatible
from doe_kc.discovery.search.laws import other_laws, with_law
from doe_kc.discovery.search.proposals import LinearSets
from doe_kc.discovery.search.search import EffectSearch, search_from
from doe_kc.discovery.thresholds import ACCEPTED_ODDS, NOISE_CHANCE
from doe_kc.discovery.workers import DiscoveryWorkers
from doe_kc.effects.hypothesis import Hypothesis


def with_exchanged_laws(
    search: EffectSearch, library: Sequence[Hypothesis], workers: DiscoveryWorkers
) -> EffectSearch:
    """The search, gone on from its last set with another law of a friction where that leads to a better one.

    Where noise explains what remains no law is asked for.
    """
    if search.with_law_discrepancy.residual_map.chance >= NOISE_CHANCE:
        return search
    last = search.with_effects
    for member in last.model.members:
        starts = [FitStart(*with_law(last, member, law), last) for law in other_laws(member)]
        refits = [f for f in workers.fits(starts, "exchanging laws") if f is not None]
        gains = [f.evidence + promise(search, f) - search.evidence for f in refits]
        if max(gains, default=0.0) <= ACCEPTED_ODDS:
            continue
        best = refits[int(np.argmax(gains))]
        changed = next(h for h in best.model.members if h.name == member.name)
        start = FitStart(best.model, best.z, best)
        other = search_from(search, start, changed, max(gains), library, workers)
        if other.log_posterior > search.log_posterior:
            return other
    return search


def promise(search: EffectSearch, fit: Fit) -> float:
    """ln posterior odds of the most probable set to first order about a fit, against its own; at least 0."""
    errors = search.with_law_discrepancy.model.likelihood, fit.model.likelihood
    there = [s for s in search.screened if compatible(fit.model, s.hypothesis)]
    sets = LinearSets.of(fit, rewhitened_screenings(there, *errors), search.prior)
    return max([0.0, *(p.gain for p in sets.proposals()[:1])])
