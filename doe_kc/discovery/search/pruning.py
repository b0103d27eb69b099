"""Backward elimination: effects that later ones have made needless."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from doe_kc.correlation.likelihood import Likelihood
from doe_kc.discovery.fit import Fit, to_errors
from doe_kc.discovery.thresholds import DOUBTFUL
from doe_kc.discovery.workers import DiscoveryWorkers


def pruned(fit: Fit, least: float, bench: DiscoveryWorkers, without_law: Mapping[str, Likelihood]) -> Fit:
    """The fit without the members, but the latest, that cost more evidence than they bring.

    without_law: of a member whose law is open, errors that do not grant it, or what it makes would pass for
    an error of the records.
    """
    while len(fit.model.members) > 1:
        losses = {h.name: _loss(fit, place) for h, place in list(fit.model.places())[:-1]}
        members = [(h, p) for h, p in fit.model.places() if losses.get(h.name, np.inf) < DOUBTFUL * least]
        withs = [to_errors(fit, without_law.get(h.name, fit.model.likelihood)) for h, _ in members]
        starts = [
            (w.model.without(h), np.delete(w.z, np.r_[place]))
            for w, (h, place) in zip(withs, members, strict=True)
        ]
        tuning = fit.jacobian[:, : fit.model.dimension]
        fewer = bench.fitted(starts, "taking effects out", tuning)
        for (h, _), w, f in zip(members, withs, fewer, strict=True):
            if f is not None:
                losses[h.name] = w.evidence - f.evidence
        kept = {h.name: f for (h, _), f in zip(members, fewer, strict=True) if f is not None}
        least_lost = min(kept, key=lambda name: losses[name], default="")
        if not least_lost or losses[least_lost] > least:
            break
        fit = to_errors(kept[least_lost], fit.model.likelihood)
    return fit


def _loss(fit: Fit, place: slice) -> float:
    """ln likelihood that a member's sizes carry, to second order (Wald); 0 for one without sizes."""
    amplitudes = fit.z[place]
    if not amplitudes.size:
        return 0.0
    return 0.5 * float(amplitudes @ np.linalg.inv(fit.covariance[place, place]) @ amplitudes)
