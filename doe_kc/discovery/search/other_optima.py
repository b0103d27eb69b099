"""Fits from other values of the numbers along which the cost has several optima."""

from __future__ import annotations

from doe_kc.discovery.fit import Fit
from doe_kc.discovery.gauss_newton import FitStart
from doe_kc.discovery.search.law_variants import frictions
from doe_kc.discovery.search.series_start import series_starts
from doe_kc.discovery.thresholds import (
    ACCEPTED_ODDS,
    BEYOND_DOUBT,
    FREE_SHAPE_LOSS,
    NEAR_START,
)
from doe_kc.discovery.workers import DiscoveryWorkers
from doe_kc.effects._friction import FREE_LAW


def at_best_optimum(current: Fit, workers: DiscoveryWorkers) -> Fit:
    """The same set and laws at the best optimum that its fits reach from other starts; the same fit where
    none is better by more than an effect needs.

    A few sliders in place of the many of real rubber make the cost rough. A fit ended at a spread of 0.84 +-
    0.02 where the car's was 1.35, 46 of ln evidence behind the fit that ends there, with 70 of cost between.
    Other stiffnesses are asked for again from each better optimum.
    """
    starts = [*other_shapes(current), *other_stiffnesses(current)]
    while True:
        fits = workers.fits(starts, "refitting from other shapes")
        best = max((f for f in fits if f is not None), key=lambda f: f.evidence, default=current)
        if best.evidence - current.evidence <= ACCEPTED_ODDS:
            return current
        current, starts = best, other_stiffnesses(best)


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


def at_best_stiffness(current: Fit, workers: DiscoveryWorkers) -> tuple[Fit, tuple[Fit, ...]]:
    """The set with frictions of free shape at the best optimum along the stiffnesses of what they stand on;
    and the fits, without derivatives, that end elsewhere or there and cost no more than such a shape may.

    Along them nothing but the law's shape and the spring's prior tells one optimum from another, and the
    sliders make the cost rough: 240 N of two stages on a mount of 3090 N/mm, the car's, ended 9 of ln
    evidence behind 173 N on 6060, and 195 N on 3510 6 behind 157 N on 6510.
    """
    reached, starts = [current], other_stiffnesses(current, free=True)
    while starts:
        fits = [f for f in workers.fits(starts, "refitting other stiffnesses") if f is not None]
        reached += [f.without_derivatives for f in fits]
        best = max(fits, key=lambda f: f.evidence, default=current)
        if best.evidence - current.evidence <= ACCEPTED_ODDS:
            break
        current, starts = best, other_stiffnesses(best, free=True)
    most = min(f.cost for f in reached) + 2.0 * FREE_SHAPE_LOSS
    others = (f for f in reached if f.z is not current.z)  # copies without derivatives keep their point
    return current, tuple(f.without_derivatives for f in others if f.cost <= most)


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
