"""Fits from other values of the numbers along which the cost has several optima."""

from __future__ import annotations

from collections.abc import Sequence, Set

import numpy as np

from doe_kc.discovery.fit import Fit
from doe_kc.discovery.gauss_newton import FitStart
from doe_kc.discovery.search.law_variants import amplitude_by, frictions
from doe_kc.discovery.search.series_start import series_starts
from doe_kc.discovery.thresholds import (
    ACCEPTED_ODDS,
    BEYOND_DOUBT,
    COMPLIANCE_FACTORS,
    FREE_SHAPE_LOSS,
    GRID_FACTORS,
    NEAR_START,
    SAME_OPTIMUM,
)
from doe_kc.discovery.workers import DiscoveryWorkers
from doe_kc.effects import EFFECTS
from doe_kc.effects._friction import FREE_LAW, DryFriction


def at_best_optimum(current: Fit, workers: DiscoveryWorkers) -> Fit:
    """The same set and laws at the best optimum that its fits reach from other starts; the same fit where
    none is better by more than an effect needs.

    A few sliders in place of the many of real rubber make the cost rough. A fit ended at a spread of 0.84 +-
    0.02 where the car's was 1.35, 46 of ln evidence behind the fit that ends there, with 70 of cost between.
    Other stiffnesses and compliances are asked for again from each better optimum.
    """
    starts = [*other_shapes(current), *other_stiffnesses(current), *other_compliances(current)]
    while True:
        fits = workers.fits(starts, "refitting from other shapes")
        best = max((f for f in fits if f is not None), key=lambda f: f.evidence, default=current)
        if best.evidence - current.evidence <= ACCEPTED_ODDS:
            return current
        current, starts = best, [*other_stiffnesses(best), *other_compliances(best)]


def other_shapes(current: Fit) -> list[FitStart]:
    """The fit's own point with one of its numbers at another start of `Size.starts`, given up where it
    promises nothing."""
    most = current.cost + 2.0 * BEYOND_DOUBT
    out = []
    for member, place in current.model.places():
        for i, size in enumerate(member.sizes, start=place.start):
            for amplitude in size.starts:
                if abs(amplitude - current.z[i]) > NEAR_START:
                    z = current.z.copy()
                    z[i] = amplitude
                    out.append(FitStart(current.model, z, current, most))
    return out


def other_compliances(current: Fit) -> list[FitStart]:
    """Beside a free play, the fit's own point with one of its compliances larger or smaller.

    The play's contact makes the cost rough along all that yields: tyres of 146 N/mm along x, beside a play of
    0.30 mm, ended at 197 +- 9, 23 of ln evidence behind the fit that begins at 146.
    """
    model = current.model
    if not any(size.needed for size in model.sizes):
        return []
    out = []
    for i, size in enumerate(model.sizes, start=model.dimension):
        if size.growth == "compliance":
            for factor in COMPLIANCE_FACTORS:
                z = current.z.copy()
                z[i] *= factor
                out.append(FitStart(model, z, current))
    return out


def at_best_free_shape(current: Fit, own: Set[str], workers: DiscoveryWorkers) -> tuple[Fit, tuple[Fit, ...]]:
    """The set with frictions of free shape at the best optimum that fits reach from where they make nearly
    the same loops; and the other optima, without derivatives, that cost no more than such a shape may.

    own: names of those that have no closed law. Theirs begin from other sliders too, and all from other
    stiffnesses of what they stand on. Along those nothing but the law's shape and the spring's prior tells
    one optimum from another, and the sliders make the cost rough: 240 N of two stages on a mount of 3090
    N/mm, the car's, ended 9 of ln evidence behind 173 N on 6060, and 195 N on 3510 6 behind 157 N on 6510.
    """

    def starts(fit: Fit) -> list[FitStart]:
        return [*other_stiffnesses(fit, free=True), *other_sliders(fit, own)]

    reached, following = [current], starts(current)
    while following:
        fits = [f for f in workers.fits(following, "refitting free shapes") if f is not None]
        best = max(fits, key=lambda f: f.evidence, default=current)
        reached += [f.without_derivatives for f in fits]
        if best.evidence - current.evidence <= ACCEPTED_ODDS:
            break
        current, following = best, starts(best)
    most = min(f.cost for f in reached) + 2.0 * FREE_SHAPE_LOSS
    return current, tuple(_distinct(current, [f for f in reached if f.cost <= most]))


def _distinct(current: Fit, fits: Sequence[Fit]) -> list[Fit]:
    """Those, without derivatives, that are at optima of their own, and not at that of the current one."""
    known, amount = [current], [not size.shape for size in current.model.sizes]
    for fit in sorted(fits, key=lambda f: f.cost):
        apart = [np.abs(fit.amplitudes - other.amplitudes)[amount] for other in known]
        scale = np.abs(fit.amplitudes)[amount]
        if all((step > SAME_OPTIMUM * scale).any() for step in apart):
            known.append(fit.without_derivatives)
    return known[1:]


def other_sliders(current: Fit, names: Set[str]) -> list[FitStart]:
    """The fit's own set with a friction of free shape whose sliders yield elsewhere, where they make nearly
    the same loops. names: of those frictions.

    One of two stages, 421 N over 0.044 mm, ended at 373.8 +- 2.1 N over 0.125 mm, 52 of ln evidence behind
    the fit that begins at 0.55 of that travel and ends at 420.8 N.
    """
    out = []
    for friction in frictions(current):
        effect = EFFECTS[friction.effect]
        if friction.law != FREE_LAW or friction.name not in names or not isinstance(effect, DryFriction):
            continue
        known = friction.options(current.model.sizes_at(current.z, friction))
        for factor in GRID_FACTORS:
            numbers, z = effect.with_travel(known, factor), current.z.copy()
            for i, size in enumerate(friction.sizes, start=current.model.place(friction).start):
                z[i] = amplitude_by(size, numbers)
            out.append(FitStart(current.model, z, current))
    return out


def other_stiffnesses(current: Fit, *, free: bool = False) -> list[FitStart]:
    """The fit's own set with a compliance in series with a friction softer or stiffer, where they make nearly
    the same loops. free: of frictions of free shape alone.

    A steering friction of two stages, 361 N over 0.047 mm on a mount of 3120 N/mm, ended at 272 N over 0.280
    mm, 145 of ln evidence behind.
    """
    return [
        start
        for friction in frictions(current)
        if not free or friction.law == FREE_LAW
        for compliance in current.model.members
        for start in series_starts(current, friction, friction, compliance)
    ]
