"""Score tests: what hypotheses would gain at another model, by derivatives known from an earlier one."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np

from doe_kc.discovery.fit import Fit
from doe_kc.discovery.screening.screen import Screened, size_detectability
from doe_kc.ground.typing import FloatArray


def score_tests(fit: Fit, known: Sequence[Screened]) -> list[Screened]:
    """The score test at another model with the columns known from an earlier one: no new solution.

    known: their changes in the other model's errors. amplitudes and gain to first order; hypotheses without
    sizes keep their amplitude, there or not.
    """
    there = [s for s in known if not s.failed]
    if not there:
        return list(known)
    own = [s.columns if s.amplitudes.size else s.change[:, None] for s in there]
    ends = np.cumsum([0, *(columns.shape[1] for columns in own)])
    columns = fit.changes(np.hstack(own))
    changes = fit.changes(np.array([s.change for s in there]).T)
    seen = np.sqrt(fit.without_traces.squares(changes))
    slopes = fit.projection.inner(columns, fit.remainder)[:, 0]
    gram, alone = fit.projection.gram_of(columns), fit.without_traces.gram_of(columns)
    places = [slice(a, b) for a, b in pairwise(ends)]
    tested = {
        s.hypothesis.name: _tested(s, gram[p, p], alone[p, p], slopes[p], float(d))
        for s, p, d in zip(there, places, seen, strict=True)
    }
    return [tested.get(s.hypothesis.name, s) for s in known]


def _tested(
    known: Screened, gram: FloatArray, alone: FloatArray, slope: FloatArray, detectability: float
) -> Screened:
    """gram, alone: (m, m) of its columns, re-tuning projected out, traces held in the second. slope: (m,) of
    the cost along them, halved."""
    hessian = gram + np.eye(slope.size)
    amplitudes = np.asarray(-np.linalg.solve(hessian, slope), dtype=np.float64)
    gain = 0.5 * float(-slope @ amplitudes) - 0.5 * float(np.linalg.slogdet(hessian)[1])
    square = float(known.change @ known.change)
    return replace(
        known,
        amplitudes=amplitudes if known.amplitudes.size else known.amplitudes,
        sd=np.sqrt(np.diag(np.linalg.inv(hessian)))[: known.amplitudes.size],
        gain=gain,
        detectability=detectability,
        absorbed=1.0 - detectability**2 / square if square > 0.0 else 0.0,
        size_detectability=size_detectability(known.hypothesis, alone, detectability),
    )
