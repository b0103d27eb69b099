"""Fits with frictions of free shape.

Which effects are there, laws of few numbers tell as well as any; how large they are, they do not. A motion
that stays in presliding is a spring by the law's shape, and a compliance beside it takes up what that shape
lacks. Closed forms that noise does not tell apart, or nearly so, then give sizes that differ by more than any
of them allows, and their evidence measures which is the least wrong one. So sizes are estimated beside
frictions of free shape, of which closed forms are special cases: the discrepancy of the law at its source,
as numbers of the fit. A friction that is a trace has a closed form.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from doe_kc.discovery.fit import Fit, amplitude_estimates
from doe_kc.discovery.gauss_newton import FitStart
from doe_kc.discovery.search.law_variants import default_law, frictions, open_laws, with_law
from doe_kc.discovery.search.refits import more_than_trace, no_more_than_trace
from doe_kc.discovery.thresholds import FREE_SHAPE_LOSS, FREE_TRAVELS, NOISE_CHANCE
from doe_kc.discovery.workers import DiscoveryWorkers
from doe_kc.effects import EFFECTS
from doe_kc.effects._friction import SHARES, TRAVEL
from doe_kc.effects.hypothesis import Hypothesis, Size


def with_free_shapes(current: Fit, workers: DiscoveryWorkers) -> tuple[Fit, Fit | None]:
    """The fit with every friction by the law of most numbers, where sizes may hang on it; and the other one
    of both, None where no such law fits as well.

    Its evidence is not asked: what a law of free shape loses is the width of its prior.
    """
    return _with_shapes(current, frictions_to_free(current), workers)


def with_unlike_bushings(current: Fit, workers: DiscoveryWorkers) -> Fit:
    """The fit with rubber whose bushings differ, where sizes may hang on it and it fits as well.

    Bushings that differ are never worse than bushings alike, by which rubber's share is surer than its mean
    can be: beside frictions that no free shape came near it was told 12 standard deviations too large or too
    small. And further effects are asked for beside it: what one bushing has more than the others can hide an
    effect.
    """
    rubber = [h for h in frictions_to_free(current) if is_rubber(h)]
    return _with_shapes(current, rubber, workers)[0]


def _with_shapes(
    current: Fit, members: Sequence[Hypothesis], workers: DiscoveryWorkers
) -> tuple[Fit, Fit | None]:
    """Of some frictions, as `with_free_shapes`.

    It begins from other travels too where the first ends above the closed law, which it could all but follow:
    on a car with two frictions and rubber that left a contrast of 4.3 standard deviations, and 10 of ln
    likelihood. Nor is it taken where it leaves what the closed law explains: one of the same cost left a
    contrast of 6.6.
    """
    start = with_most_numbers(current, members)
    if start.model is current.model:
        return current, None
    explained = current.residual_map.chance >= NOISE_CHANCE

    def explains(refit: Fit) -> bool:
        return not explained or refit.residual_map.chance >= NOISE_CHANCE

    refits = workers.fits(
        [start, *_other_travels(start)],
        "freeing laws",
        enough=lambda refit: refit is not None and refit.cost <= current.cost and explains(refit),
    )
    near = [f for f in refits if f is not None and f.cost <= current.cost + 2.0 * FREE_SHAPE_LOSS]
    if not near:
        return current, None
    best = min(near, key=lambda f: (not explains(f), f.cost))
    return (best, current) if explains(best) else (current, best)


def with_most_numbers(current: Fit, members: Sequence[Hypothesis]) -> FitStart:
    """Where a fit with the law of most numbers for some members begins."""
    model, z = current.model, current.z
    for member in members:
        for law in open_laws(member)[-1:]:
            model, z = with_law(model, z, member, law)
    return FitStart(model, z, current)


def frictions_to_free(current: Fit) -> list[Hypothesis]:
    """Frictions of the set on whose law sizes hang: all that are more than traces where it has other effects
    of the car too, else rubber alone, whose share is a mean of bushings that differ."""
    free = [h for h in frictions(current) if len(EFFECTS[h.effect].variants(default_law(h))) > 1]
    others = [h for h in current.model.members if h not in free and not EFFECTS[h.effect].on_rig]
    if not others:
        return [h for h in free if is_rubber(h)]
    return [h for h in free if beyond_trace(current, h)]


def is_rubber(member: Hypothesis) -> bool:
    """Whether a friction is that of bushings: dry ones have several laws."""
    return not EFFECTS[member.effect].laws


def beyond_trace(current: Fit, member: Hypothesis) -> bool:
    """Whether a member of the set is surely more than a trace."""
    return more_than_trace(_amounts(current, member))


def within_trace(current: Fit, member: Hypothesis) -> bool:
    """Whether a member of the set is surely no more than a trace."""
    return no_more_than_trace(_amounts(current, member))


def _amounts(current: Fit, member: Hypothesis) -> list[tuple[Size, float, float]]:
    """Sizes that say how much, in typical ones, with their standard deviations."""
    amplitudes, sds = amplitude_estimates(current, member)
    numbers = zip(member.sizes, np.abs(amplitudes).tolist(), sds.tolist(), strict=True)
    return [(size, a, sd) for size, a, sd in numbers if not size.shape]


def best_fit(start: FitStart, workers: DiscoveryWorkers) -> Fit | None:
    """The fit with an opened law; where noise does not explain what it leaves, the best of several starts.

    The sliders of a free backbone make the cost rough. From Duhem's law, 235 N over 0.81 mm, a friction of
    two stages ended 160 of ln evidence behind the fit from 0.7 of that travel: 224.7 N over 0.38 mm, the
    car's.
    """
    fits = workers.fits(
        [start, *_other_travels(start)],
        "freeing laws",
        enough=lambda refit: refit is not None and refit.residual_map.chance >= NOISE_CHANCE,
    )
    return max((f for f in fits if f is not None), key=lambda f: f.evidence, default=None)


def _other_travels(start: FitStart) -> list[FitStart]:
    """The same start with other travels of the frictions of free shape; none without one."""
    places = [
        (place.start + i, size.log_sd)
        for h, place in start.model.places()
        if any(size.key == SHARES for size in h.sizes)
        for i, size in enumerate(h.sizes)
        if size.key == TRAVEL
    ]
    out = []
    for factor in FREE_TRAVELS if places else ():
        z = start.z.copy()
        for place, log_sd in places:
            z[place] += np.log(factor) / log_sd
        out.append(replace(start, z=z))
    return out
