"""Sizes over all sets that were refitted, and over the laws of frictions: how far they move where another set
is nearly as probable, or another law fits as well.

The variance of a size holds that between sets (A. E. Raftery, D. Madigan, J. A. Hoeting, Journal of the
American Statistical Association 92, 1997).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
from scipy.special import expit

from doe_kc.discovery.fit import Fit, amplitude_estimates
from doe_kc.discovery.search.refits import HypothesisFit
from doe_kc.discovery.thresholds import LAW_WINDOW
from doe_kc.discovery.verdict.alternatives import Alternatives
from doe_kc.effects.hypothesis import Hypothesis
from doe_kc.ground.typing import FloatArray


def spread_between_sets(
    member: Hypothesis, amplitudes: FloatArray, compared: Sequence[Alternatives]
) -> FloatArray:
    """(m,) root of the mean square by which a member's amplitudes differ in other sets that have it.

    amplitudes: (m,) in the last set.
    """
    weights, squares = 1.0, np.zeros(amplitudes.size)
    for log, fit in _sets(compared):
        if log > -LAW_WINDOW and member in fit.model.members:
            weight = float(np.exp(min(log, LAW_WINDOW)))
            weights += weight
            squares += weight * (amplitude_estimates(fit, member)[0] - amplitudes) ** 2
    return np.asarray(np.sqrt(squares / weights))


def spread_in_larger_sets(
    member: Hypothesis, amplitudes: FloatArray, larger: Sequence[HypothesisFit]
) -> FloatArray:
    """(m,) root of the mean square by which a member's amplitudes differ in sets with one effect more, which
    it may hide; those of its law only where it has the same. amplitudes: (m,) in the last set."""
    weights, squares = 1.0, np.zeros(amplitudes.size)
    for other in larger:
        weight = float(np.exp(min(other.gain, LAW_WINDOW)))
        weights += weight
        squares += weight * _apart(member, amplitudes, other.fit) ** 2
    return np.asarray(np.sqrt(squares / weights))


def spread_between_laws(
    member: Hypothesis, amplitudes: FloatArray, last: Fit, other: Fit | None
) -> FloatArray:
    """(m,) root of the mean square by which a member's amplitudes differ by other laws of the frictions.

    amplitudes: (m,) in `last`. other: see `EffectSearch.with_other_laws`. A free shape comes near every
    closed law, so that it should fit as well; its sliders make the cost rough. One that ended 8 of cost above
    Iwan's law had 548 +- 5 N for 452, by that law 470, and a mount of the rack a third too soft beside it. So
    both count by how well they fit: evidence would only say which law has fewer numbers.
    """
    if other is None:
        return np.zeros(amplitudes.size)
    share = float(expit(0.5 * (last.cost - other.cost)))
    return np.asarray(np.sqrt(share) * np.abs(_apart(member, amplitudes, other)))


def _apart(member: Hypothesis, amplitudes: FloatArray, other: Fit) -> FloatArray:
    """(m,) by which a member's amplitudes differ in a fit that has it by any law; 0 for those of its law
    where that is another one."""
    there = next(h for h in other.model.members if h.name == member.name)
    known = dict(zip((s.name for s in there.sizes), amplitude_estimates(other, there)[0], strict=True))
    same = [there.law == member.law or not s.shape for s in member.sizes]
    return np.array(
        [
            known.get(s.name, a) - a if counts else 0.0
            for s, a, counts in zip(member.sizes, amplitudes, same, strict=True)
        ]
    )


def _sets(compared: Sequence[Alternatives]) -> Iterator[tuple[float, Fit]]:
    """ln posterior odds of every other set against the last one, with its fit."""
    for one in compared:
        own, *rivals = one.trials
        yield -own.gain / one.temper, one.without
        for t in rivals:
            yield (t.gain - own.gain) / one.temper, t.fit
