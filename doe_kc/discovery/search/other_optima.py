"""Fits from other values of the numbers along which the cost has several optima."""

from __future__ import annotations

from collections.abc import Iterator

from doe_kc.discovery.fit import Fit
from doe_kc.discovery.gauss_newton import FitStart
from doe_kc.discovery.thresholds import ACCEPTED_ODDS, BEYOND_DOUBT, NEAR_START
from doe_kc.discovery.workers import DiscoveryWorkers


def at_best_optimum(current: Fit, workers: DiscoveryWorkers) -> Fit:
    """The same set and laws at the best optimum that its fits reach from `Size.starts`; the same fit where
    none is better by more than an effect needs.

    A few sliders in place of the many of real rubber make the cost rough. A fit ended at a spread of 0.84 +-
    0.02 where the car's was 1.35, 46 of ln evidence behind the fit that ends there, with 70 of cost between.
    """
    fits = workers.fits(list(other_starts(current)), "refitting from other shapes")
    best = max((f for f in fits if f is not None), key=lambda f: f.evidence, default=current)
    return best if best.evidence - current.evidence > ACCEPTED_ODDS else current


def other_starts(current: Fit) -> Iterator[FitStart]:
    """The fit's own point with one of its numbers at another start, given up where it promises nothing."""
    most = current.cost + 2.0 * BEYOND_DOUBT
    for member, place in current.model.places():
        for i, size in enumerate(member.sizes, start=place.start):
            for amplitude in size.starts:
                if abs(amplitude - current.z[i]) > NEAR_START:
                    z = current.z.copy()
                    z[i] = amplitude
                    yield FitStart(current.model, z, current, most)
