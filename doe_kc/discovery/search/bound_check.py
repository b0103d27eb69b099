"""Bounds that the records ask to be wider: a whole series off nominal, or scattering more than thought.

What parameters at their bounds leave open, re-tuning would absorb: it must not count as a missing effect.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from doe_kc.discovery.fit import Fit
from doe_kc.discovery.gauss_newton import FitStart
from doe_kc.discovery.model import EffectModel
from doe_kc.discovery.search.effect_search import EffectSearch
from doe_kc.discovery.search.search import search
from doe_kc.discovery.thresholds import BOUND_EVIDENCE, BOUND_FACTORS, BOUND_ROUNDING, SHARE_AT_BOUNDS
from doe_kc.discovery.workers import DiscoveryWorkers
from doe_kc.effects.hypothesis import Hypothesis
from doe_kc.ground.typing import FloatArray
from doe_kc.variables import Space


def search_within_bounds(
    model: EffectModel, library: Sequence[Hypothesis], workers: DiscoveryWorkers
) -> EffectSearch:
    """The search, its ranges wider than the model's where the records ask for that.

    Wider ranges are tried only where what re-tuning could not absorb agrees with noise, so that they
    cannot bend parameters in place of an effect; then the search begins anew between them. The first one is
    let go meanwhile, some 80 MB of a car of six effects: where it is the better one after all, against what a
    fit between those bounds promised, it is run again, of what the cache remembers.
    NotConverged when the nominal axle has no equilibrium.
    """
    first = search(model, library, workers)
    factor = bound_evidence(first.with_law_discrepancy, workers)
    if factor == 1.0:
        return first
    least = first.evidence + BOUND_EVIDENCE
    del first
    wider = search(_widened(model, factor), library, workers)
    if wider.evidence > least:
        return wider
    del wider
    return search(model, library, workers)


def bound_evidence(fit: Fit, workers: DiscoveryWorkers) -> float:
    """By how much wider the ranges are with the largest evidence, 1 unless it is clear."""
    few = np.mean(at_bounds(fit)) < SHARE_AT_BOUNDS
    if few or not fit.residual_map.agrees:
        return 1.0
    best, most = 1.0, fit.evidence + BOUND_EVIDENCE
    for factor in BOUND_FACTORS:
        model, z = with_wider_bounds(fit, factor)
        near = replace(fit, jacobian=fit.jacobian.scaled(_stretch(fit, model, z)))
        (wider,) = workers.fits([FitStart(model, z, near)], "wider bounds")
        if wider is None or wider.evidence < most:
            break
        best, most = factor, wider.evidence
    return best


def at_bounds(fit: Fit) -> NDArray[np.bool_]:
    """(d,) whether each tunable parameter is held at a bound."""
    model = fit.model
    u, low, high = (a[: model.parameters] for a in (fit.z, model.lower, model.upper))
    return np.asarray((u <= low) | (u >= high))


def with_wider_bounds(fit: Fit, factor: float) -> tuple[EffectModel, FloatArray]:
    """The model with wider ranges, and the fit's point in it."""
    count, wider = fit.model.parameters, _widened(fit.model, factor)
    places = wider.space.unit(fit.model.space.values(fit.z[:count]))
    return wider, np.concatenate([places, fit.z[count:]])


def _widened(model: EffectModel, factor: float) -> EffectModel:
    return replace(model, space=model.space.widened(factor), widened=factor)


def _stretch(fit: Fit, wider: EffectModel, z: FloatArray) -> FloatArray:
    """(d + m,) by what derivatives grow from the one model's places to the wider one's."""
    count = wider.parameters
    own = fit.model.space.slopes(fit.z[:count])
    return np.concatenate([wider.space.slopes(z[:count]) / own, np.ones(z.size - count)])


def beyond(space: Space, fit: Fit) -> tuple[str, ...]:
    """Paths of the parameters that the fit puts outside the bounds of `space`."""
    values = fit.model.space.values(fit.z[: fit.model.parameters])
    places = {v.path: v.place(values[v.path]) for v in space.variables}
    return tuple(path for path, u in places.items() if not -BOUND_ROUNDING <= u <= 1.0 + BOUND_ROUNDING)
