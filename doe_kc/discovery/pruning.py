"""Backward elimination: effects that later ones have made needless."""

from __future__ import annotations

import numpy as np

from doe_kc.discovery.bench import Bench
from doe_kc.discovery.fit import Fit

DOUBTFUL = 10.0
"""Times the threshold: a member that carries more is not tried without."""


def pruned(found: Fit, least: float, bench: Bench) -> tuple[Fit, dict[str, float]]:
    """The fit without the members that cost more evidence than they bring.

    Also what the model would lose without each but the latest, ln evidence.
    """
    losses: dict[str, float] = {}
    while len(found.model.members) > 1:
        losses = {h.name: _loss(found, place) for h, place in list(found.model.places())[:-1]}
        members = [(h, p) for h, p in found.model.places() if losses.get(h.name, np.inf) < DOUBTFUL * least]
        starts = [(found.model.without(h), np.delete(found.z, np.r_[place])) for h, place in members]
        tuning = found.jacobian[:, : found.model.dimension]
        fewer = bench.fitted(starts, "taking effects out", tuning)
        for (h, _), f in zip(members, fewer, strict=True):
            if f is not None:
                losses[h.name] = found.evidence - f.evidence
        kept = [f for f in fewer if f is not None]
        best = max(kept, key=lambda f: f.evidence, default=None)
        if best is None or found.evidence - best.evidence > least:
            break
        found = best
    return found, losses


def _loss(found: Fit, place: slice) -> float:
    """ln likelihood that a member's sizes carry, to second order (Wald); 0 for one without sizes."""
    amplitudes = found.z[place]
    if not amplitudes.size:
        return 0.0
    return 0.5 * float(amplitudes @ np.linalg.inv(found.covariance[place, place]) @ amplitudes)
