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
    member: Hypothesis, amplitudes: FloatArray, sd: FloatArray, larger: Sequence[HypothesisFit]
) -> FloatArray:
    """(m,) root of the mean square by which a member's amplitudes differ in sets with one effect more, which
    it may hide, and are less sure there; those of its law only where it has the same.

    amplitudes, sd: (m,) in the last set, with their standard deviations. 215 N on a mount of 6720 N/mm were
    159 N without it, and 160 to 195 N with it.
    """
    weights, squares = 1.0, np.zeros(amplitudes.size)
    for other in larger:
        weight = float(np.exp(min(other.gain, LAW_WINDOW)))
        weights += weight
        apart, own = _apart(member, amplitudes, other.fit), _sd_there(member, sd, other.fit)
        squares += weight * (apart**2 + np.maximum(own**2 - sd**2, 0.0))
    return np.asarray(np.sqrt(squares / weights))


def spread_between_optima(member: Hypothesis, amplitudes: FloatArray, optima: Sequence[Fit]) -> FloatArray:
    """(m,) root of the mean square by which a member's amplitudes differ at other optima that fit as well.

    amplitudes: (m,) at the one that is told. optima: see `EffectSearch.optima`; none is more probable than
    another by more than the sliders of a free shape can tell, so that all count alike.
    """
    squares = [_apart(member, amplitudes, other) ** 2 for other in optima]
    return np.asarray(np.sqrt(np.sum([np.zeros(amplitudes.size), *squares], axis=0) / (1 + len(optima))))


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
    there, _ = amplitude_estimates(other, other.model.member(member.name))
    return _by_name(member, there, other, amplitudes) - amplitudes


def _sd_there(member: Hypothesis, sd: FloatArray, other: Fit) -> FloatArray:
    """(m,) standard deviations of a member's amplitudes in such a fit; sd for those of its law where that is
    another one."""
    _, there = amplitude_estimates(other, other.model.member(member.name))
    return _by_name(member, there, other, sd)


def _by_name(member: Hypothesis, numbers: FloatArray, other: Fit, own: FloatArray) -> FloatArray:
    """(m,) numbers (k,) of a member's sizes in another fit, in the order of its own; `own` for those that the
    other law does not have, or in another sense."""
    there = other.model.member(member.name)
    known = dict(zip((s.name for s in there.sizes), numbers.tolist(), strict=True))
    same = [there.law == member.law or not s.shape for s in member.sizes]
    return np.array(
        [
            known.get(s.name, a) if counts else a
            for s, a, counts in zip(member.sizes, own.tolist(), same, strict=True)
        ]
    )


def _sets(compared: Sequence[Alternatives]) -> Iterator[tuple[float, Fit]]:
    """ln posterior odds of every other set against the last one, with its fit."""
    for one in compared:
        own, *rivals = one.trials
        yield -own.gain / one.temper, one.without
        for t in rivals:
            yield (t.gain - own.gain) / one.temper, t.fit
