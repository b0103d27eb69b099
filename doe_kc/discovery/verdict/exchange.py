"""Exchanges: the last set against sets with a rival in the place of one effect, until none is more probable.

To first order an effect that is large, or that parameters at their bounds imitate, can look worse than
another that makes nearly the same deviations. Joint refits tell, and the last set's rivals have those.
"""

from __future__ import annotations

from collections.abc import Sequence

from doe_kc.discovery.gauss_newton import FitStart
from doe_kc.discovery.search.decision import temper
from doe_kc.discovery.search.law_exchange import with_exchanged_laws
from doe_kc.discovery.search.refits import HypothesisFit
from doe_kc.discovery.search.search import EffectSearch, search_from
from doe_kc.discovery.thresholds import ACCEPTED_ODDS
from doe_kc.discovery.verdict.alternatives import Alternatives, alternatives
from doe_kc.discovery.workers import DiscoveryWorkers
from doe_kc.effects.hypothesis import Hypothesis


def exchanged(
    search: EffectSearch, library: Sequence[Hypothesis], workers: DiscoveryWorkers
) -> tuple[EffectSearch, tuple[Alternatives, ...]]:
    """The search, gone on from sets with another law or a rival in one effect's place as long as those are
    more probable.

    With the alternatives of every member of its last set. It ends, since the probability of the last set, its
    errors its own, grows with each exchange.
    """
    search = with_exchanged_laws(search, library, workers)
    compared = alternatives(search, temper(search.with_law_discrepancy), workers)
    while (better := better_rival(compared)) is not None:
        own, rival, gain = better
        last = search.with_effects
        start = FitStart(last.model.without(own).extended(rival.hypothesis), rival.fit.z, last)
        other = search_from(search, start, rival.hypothesis, gain, library, workers)
        if other.log_posterior <= search.log_posterior:
            break
        search = with_exchanged_laws(other, library, workers)
        compared = alternatives(search, temper(search.with_law_discrepancy), workers)
    return search, compared


def better_rival(compared: Sequence[Alternatives]) -> tuple[Hypothesis, HypothesisFit, float] | None:
    """An effect, the rival with the largest posterior odds against it in its place, and ln of those odds.

    None where no odds reach those at which an effect is accepted.
    """
    rivals = [
        (one.hypothesis, t, t.gain - one.trials[0].gain)
        for one in compared
        for t in one.trials[1:]
        if (t.gain - one.trials[0].gain) / one.temper > ACCEPTED_ODDS
    ]
    return max(rivals, key=lambda rival: rival[2], default=None)
