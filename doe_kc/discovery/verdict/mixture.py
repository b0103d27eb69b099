"""Sizes over all sets that were refitted: how far they move where another set is nearly as probable.

The variance of a size holds that between sets (A. E. Raftery, D. Madigan, J. A. Hoeting, Journal of the
American Statistical Association 92, 1997).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from doe_kc.discovery.fit import Fit, amplitude_estimates
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


def _sets(compared: Sequence[Alternatives]) -> Iterator[tuple[float, Fit]]:
    """ln posterior odds of every other set against the last one, with its fit."""
    for one in compared:
        own, *rivals = one.trials
        yield -own.gain / one.temper, one.without
        for t in rivals:
            yield (t.gain - own.gain) / one.temper, t.fit
