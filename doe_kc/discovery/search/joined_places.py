"""An effect that a set has in several places, as one effect in all its places.

Each place comes in by itself, and to first order none is exchanged for the whole. Rubber of one axle was told
as that of the lower arms' rear bushings and that of the others.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from doe_kc.discovery.fit import Fit
from doe_kc.discovery.gauss_newton import FitStart
from doe_kc.discovery.search.law_variants import open_laws, with_law
from doe_kc.discovery.search.refits import HypothesisFit, set_fit
from doe_kc.discovery.search.set_prior import SetPrior
from doe_kc.discovery.thresholds import BEYOND_DOUBT
from doe_kc.discovery.workers import DiscoveryWorkers
from doe_kc.effects.hypothesis import Hypothesis


def joined_refits(
    current: Fit,
    trial: HypothesisFit,
    library: Sequence[Hypothesis],
    prior: SetPrior,
    workers: DiscoveryWorkers,
) -> list[HypothesisFit]:
    """The set of a trial with each of its effects that has several places in all of them, against the set of
    `current`.

    Beside rubber of the lower arms' rear bushings that of the others gained 142 of ln posterior odds, and
    rubber of all bushings in the place of both 254.
    """
    starts = [start for _, start in joined_starts(trial.fit, library)]
    fits = workers.fits(starts, "joining places")
    return [set_fit(fit, current, prior) for fit in fits if fit is not None]


def joined_starts(fit: Fit, library: Sequence[Hypothesis]) -> Iterator[tuple[Hypothesis, FitStart]]:
    """Each effect in all its places that a set has in several, and the start of the set with it, its last
    member, for those."""
    for everywhere in (h for h in library if h.location is None):
        own = [h for h in fit.model.members if h.effect == everywhere.effect]
        if len(own) > 1:
            yield everywhere, _start(fit, own, everywhere)


def _start(fit: Fit, own: Sequence[Hypothesis], everywhere: Hypothesis) -> FitStart:
    """From the mean of the sizes in single places; by the law of most numbers where one of them has that."""
    amplitudes = [dict(zip((s.name for s in h.sizes), fit.z[fit.model.place(h)], strict=True)) for h in own]
    known = [[a[size.name] for a in amplitudes if size.name in a] for size in everywhere.sizes]
    sizes = [float(np.mean(values)) if values else 0.0 for values in known]
    kept = np.ones(fit.z.size, dtype=bool)
    model = fit.model
    for h in own:
        kept[fit.model.place(h)] = False
        model = model.without(h)
    model, z = model.extended(everywhere), np.append(fit.z[kept], sizes)
    if any(h.law for h in own):
        for law in open_laws(everywhere)[-1:]:
            model, z = with_law(model, z, everywhere, law)
    return FitStart(model, z, fit, fit.cost + 2.0 * BEYOND_DOUBT)
