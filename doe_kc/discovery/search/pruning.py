"""Backward elimination: effects that later ones have made needless."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from doe_kc.correlation.likelihood import Likelihood
from doe_kc.discovery.fit import Fit
from doe_kc.discovery.gauss_newton import FitStart
from doe_kc.discovery.search.convergence import fit_to_errors, fits_to_errors
from doe_kc.discovery.search.set_prior import SetPrior
from doe_kc.discovery.thresholds import BEYOND_DOUBT, REMOVAL_FACTOR
from doe_kc.discovery.workers import DiscoveryWorkers
from doe_kc.effects.hypothesis import Hypothesis


def backward_elimination(
    fit: Fit,
    least: float,
    workers: DiscoveryWorkers,
    without_own: Mapping[str, Likelihood],
    prior: SetPrior,
) -> Fit:
    """The fit without the members whose posterior odds against their removal are below `least`, ln.

    without_own: of a member whose law has a discrepancy, errors that do not hold it: with it, what the member
    makes would pass for an error of the records.
    """
    while fit.model.members:
        places = list(fit.model.places())
        needed = {h.name: least - _odds(fit.model.members, h, prior) for h, _ in places}
        losses = {h.name: _loss(fit, place) for h, place in places}
        members = [(h, p) for h, p in places if losses[h.name] < REMOVAL_FACTOR * needed[h.name]]
        errors = [without_own.get(h.name, fit.model.likelihood) for h, _ in members]
        withs = fits_to_errors(fit, errors, workers)
        starts = [
            FitStart(w.model.without(h), np.delete(w.z, np.r_[place]), fit, w.cost + 2.0 * BEYOND_DOUBT)
            for w, (h, place) in zip(withs, members, strict=True)
        ]
        fewer = workers.fits(starts, "taking effects out")
        for (h, _), w, f in zip(members, withs, fewer, strict=True):
            if f is not None:
                losses[h.name] = w.evidence - f.evidence
        kept = {h.name: f for (h, _), f in zip(members, fewer, strict=True) if f is not None}
        least_lost = min(kept, key=lambda name: losses[name] - needed[name], default="")
        if not least_lost or losses[least_lost] > needed[least_lost]:
            break
        fit = fit_to_errors(kept[least_lost], fit.model.likelihood, workers)
    return fit


def _odds(members: Sequence[Hypothesis], member: Hypothesis, prior: SetPrior) -> float:
    """ln of the odds of a set against that without one of its members, before the records."""
    return prior.log_odds([h for h in members if h != member], member)


def _loss(fit: Fit, place: slice) -> float:
    """ln likelihood that a member's sizes carry, to second order (Wald); 0 for one without sizes."""
    amplitudes = fit.z[place]
    if not amplitudes.size:
        return 0.0
    return 0.5 * float(amplitudes @ np.linalg.inv(fit.covariance[place, place]) @ amplitudes)
