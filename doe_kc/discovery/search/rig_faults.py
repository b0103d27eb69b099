"""Before a fault of the rig comes in: whether an effect of the car explains what it explains.

Where sensors are calibrated, a fault of the rig that gains much is mostly what a fit sees of an effect of the
car. Screenings of earlier steps hide that one: beside a free play, whose contact moves with every other
effect, they are about another axle.
"""

from __future__ import annotations

from collections.abc import Sequence

from doe_kc.discovery.fit import Fit
from doe_kc.discovery.screening.screen import Screened, shape_of
from doe_kc.discovery.search.refits import HypothesisFit, joint_refits, leaders
from doe_kc.discovery.search.set_prior import SetPrior
from doe_kc.discovery.thresholds import ACCEPTED_ODDS
from doe_kc.discovery.workers import DiscoveryWorkers
from doe_kc.effects import EFFECTS
from doe_kc.effects.hypothesis import Hypothesis


def leading_rig_fault(trials: Sequence[HypothesisFit]) -> Hypothesis | None:
    """The fault of the rig that is the best refit and gains enough to be taken, if one is.

    A ride height 7 mm off gave 403 of ln evidence to a gain of the tyre load, and lost 890 beside it.
    """
    best = max(trials, key=lambda t: t.gain, default=None)
    if best is None or best.gain <= ACCEPTED_ODDS or not EFFECTS[best.hypothesis.effect].on_rig:
        return None
    return best.hypothesis


def refits_of_the_car(
    current: Fit,
    screened: Sequence[Screened],
    least: float,
    trials: Sequence[HypothesisFit],
    prior: SetPrior,
    workers: DiscoveryWorkers,
) -> list[HypothesisFit]:
    """Where a fault of the rig that has a size leads, refits of the car's effects that a new screening has
    first; a technique is there or not, and looks like nothing else.

    Tyres beside a free play had no gain by their screening from before rubber came in, 26 by a new one and
    245 by their refit; a gain of the camber sensor that gained 88 was named instead.
    least: ln evidence to first order below which none is refitted. trials: other refits of the same step.
    """
    fault = leading_rig_fault(trials)
    if fault is None or not fault.sizes:
        return []
    done = {t.hypothesis.name for t in trials}
    car = [s for s in screened if not EFFECTS[s.hypothesis.effect].on_rig and s.hypothesis.name not in done]
    anew = workers.screenings(current, [s.hypothesis for s in car], shapes=[shape_of(s) for s in car])
    first = leaders(sorted(anew, key=lambda s: -s.gain), current, least, decoy=False)
    return joint_refits(current, first, prior, workers, ACCEPTED_ODDS)
