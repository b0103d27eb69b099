"""The law of a friction once the search has ended and noise does not explain what remains.

A law is worth what it explains together with the effects that it asks for: beside a wrong law a missing
effect hides and others stand in its place, and the right law may be the less probable one beside those.
"""

from __future__ import annotations

from collections.abc import Sequence

from doe_kc.discovery.fit import Fit
from doe_kc.discovery.gauss_newton import FitStart
from doe_kc.discovery.screening.screen import rewhitened_screenings
from doe_kc.discovery.search.compatibility import compatible
from doe_kc.discovery.search.effect_search import EffectSearch
from doe_kc.discovery.search.law_variants import open_laws, other_laws, with_law
from doe_kc.discovery.search.proposals import LinearSets, SetProposal
from doe_kc.discovery.search.refits import set_refits
from doe_kc.discovery.search.search import search_from
from doe_kc.discovery.thresholds import ACCEPTED_ODDS, BEYOND_DOUBT, HOPELESS_SHARE, NOISE_CHANCE
from doe_kc.discovery.workers import DiscoveryWorkers
from doe_kc.effects import EFFECTS
from doe_kc.effects.hypothesis import Hypothesis


def with_exchanged_laws(
    search: EffectSearch, library: Sequence[Hypothesis], workers: DiscoveryWorkers
) -> EffectSearch:
    """The search, gone on from its last set with another law of a friction where that leads to a better one.

    Where noise explains what remains only frictions are asked for another law that the search gave a free
    one: that can take up an effect which came too late. A steering friction of 412 N beside a mount of the
    rack of 3570 N/mm was 237 N without the mount, 40 of ln evidence behind Prandtl-Iwan's law with it.
    """
    explained = search.with_law_discrepancy.residual_map.chance >= NOISE_CHANCE
    last, freed = search.with_effects, _freed(search)
    for member in last.model.members:
        if explained and member.name not in freed:
            continue
        most = last.cost + 2.0 * BEYOND_DOUBT
        starts = [
            FitStart(*with_law(last.model, last.z, member, law), last, most) for law in other_laws(member)
        ]
        refits = [f for f in workers.fits(starts, "exchanging laws") if f is not None and f.cost <= most]
        sets = [_best_set(search, f, workers) for f in refits]
        best, gain = max(sets, key=lambda one: one[1], default=(last, 0.0))
        if gain <= ACCEPTED_ODDS:
            continue
        changed = _changed(best.model.members, member, last.model.members)
        start = FitStart(best.model, best.z, best)
        other = search_from(search, start, changed, gain, library, workers)
        if other.log_posterior > search.log_posterior:
            return other
    return search


def _changed(
    members: Sequence[Hypothesis], member: Hypothesis, before: Sequence[Hypothesis]
) -> Hypothesis | None:
    """The member by its other law; of a set that asked for none of it an effect that is new; None without."""
    own = [h for h in members if h.name == member.name]
    return next(iter([*own, *(h for h in members if h not in before)]), None)


def _freed(search: EffectSearch) -> set[str]:
    """Names of the frictions whose law the search itself gave a free shape."""
    last = search.steps[-1].members
    return {h.name for h in last if h.law and EFFECTS[h.effect].frictional and not open_laws(h)}


def _best_set(search: EffectSearch, fit: Fit, workers: DiscoveryWorkers) -> tuple[Fit, float]:
    """Of a fit by another law and of the set that it asks for the better one, with ln of the posterior odds
    against the last set, of the fit with what it promises to first order.

    The set itself is refitted where the promise alone is too little, by no more than half of it.
    """
    gain = fit.evidence - search.evidence
    asked = proposed(search, fit)
    if asked is None or gain + asked.gain > ACCEPTED_ODDS:
        return fit, gain + (asked.gain if asked else 0.0)
    if gain + (1.0 + HOPELESS_SHARE) * asked.gain <= ACCEPTED_ODDS:
        return fit, gain
    trials = set_refits(fit, [asked], search.prior, workers)
    return next(((t.fit, gain + t.gain) for t in trials if t.gain > 0.0), (fit, gain))


def proposed(search: EffectSearch, fit: Fit) -> SetProposal | None:
    """The most probable set to first order about a fit; None where that is its own."""
    errors = search.with_law_discrepancy.model.likelihood, fit.model.likelihood
    there = [s for s in search.screened if compatible(fit.model, s.hypothesis)]
    sets = LinearSets.of(fit, rewhitened_screenings(there, *errors), search.prior)
    return next((p for p in sets.proposals()[:1] if p.gain > 0.0), None)
