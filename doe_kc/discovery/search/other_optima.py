"""Fits from other values of the numbers along which the cost has several optima."""

from __future__ import annotations

from doe_kc.discovery.fit import Fit
from doe_kc.discovery.gauss_newton import FitStart
from doe_kc.discovery.model import EffectModel
from doe_kc.discovery.search.law_variants import frictions
from doe_kc.discovery.thresholds import (
    ACCEPTED_ODDS,
    BEYOND_DOUBT,
    COMPLIANT_LIMIT,
    COMPLIANT_TRAVEL,
    NEAR_START,
)
from doe_kc.discovery.workers import DiscoveryWorkers
from doe_kc.effects import EFFECTS
from doe_kc.effects._friction import LIMIT, TRAVEL
from doe_kc.effects.hypothesis import Hypothesis
from doe_kc.ground.typing import FloatArray


def at_best_optimum(current: Fit, workers: DiscoveryWorkers) -> Fit:
    """The same set and laws at the best optimum that its fits reach from other starts; the same fit where
    none is better by more than an effect needs.

    A few sliders in place of the many of real rubber make the cost rough. A fit ended at a spread of 0.84 +-
    0.02 where the car's was 1.35, 46 of ln evidence behind the fit that ends there, with 70 of cost between.
    Shorter travels are asked for again from each better optimum.
    """
    starts = [*other_shapes(current), *shorter_travels(current)]
    while True:
        fits = workers.fits(starts, "refitting from other shapes")
        best = max((f for f in fits if f is not None), key=lambda f: f.evidence, default=current)
        if best.evidence - current.evidence <= ACCEPTED_ODDS:
            return current
        current, starts = best, shorter_travels(best)


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


def shorter_travels(current: Fit) -> list[FitStart]:
    """The fit's own point with a friction beside a compliance in series from where it may be there, with its
    own limit and with a larger one.

    A steering friction of two stages, 361 N over 0.047 mm on a mount of 3120 N/mm, ended at 272 N over 0.280
    mm, 145 of ln evidence behind, on the way from where the first of these fits ends at 316 N.
    """
    return [
        FitStart(current.model, yielding_start(current.model, current.z, member, limit), current)
        for member in _on_compliances(current)
        for limit in (1.0, COMPLIANT_LIMIT)
    ]


def _on_compliances(current: Fit) -> list[Hypothesis]:
    """Frictions of the set beside a compliance of the same part that is in it too."""
    compliant = {
        EFFECTS[h.effect].part
        for h in current.model.members
        if any(size.growth == "compliance" for size in h.sizes)
    }
    return [h for h in frictions(current) if EFFECTS[h.effect].part in compliant - {"axle"}]


def yielding_start(
    model: EffectModel, z: FloatArray, friction: Hypothesis, limit: float = COMPLIANT_LIMIT
) -> FloatArray:
    """A point with a friction of shorter travel, its limit larger by a factor: beside a compliance in series
    that makes nearly the same loops.

    One of 370 N over 0.037 mm on a mount of the rack of 3020 N/mm ended at 294 N over 0.168 mm on 6320 N/mm,
    55 of ln evidence behind the fit from there.
    """
    out, place = z.copy(), model.place(friction)
    for i, size in enumerate(friction.sizes, start=place.start):
        factor = {LIMIT: limit, TRAVEL: COMPLIANT_TRAVEL}.get(size.key, 1.0)
        out[i] = size.amplitude(factor * size.value(z[i]))
    return out
