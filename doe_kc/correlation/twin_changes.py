"""How much of what an outside model changes from design to design its twin changes too."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from doe_kc.correlation.problem import Evaluated, Problem

USEFUL_SHARE = 0.5
"""Of the outside model's changes that a useful twin makes too; with less the search goes on without it. Twins
that lack two effects make 0.99999 of them, and 0.97 with bushings wrong by a factor of two besides."""
LEAST_CHANGE = 1e-6
"""Of the characteristics' scales: below it nothing changes."""


def explained_share(problem: Problem, evaluated: Sequence[Evaluated]) -> float | None:
    """1 - sum |df - dc|^2 / sum |df|^2 over the characteristics with a target, in units of their scales.

    df, dc: changes of the outside model and of the twin from the best design. 1: the same changes; 0: as
    wrong as none; None while there are not two different designs that both answer, or without a twin.
    """
    solved = [e for e in evaluated if e.score is not None]
    if problem.twin is None or len(solved) < 2:
        return None
    scale = np.array([t.scale for t in problem.search.characteristics])
    pairs = [(e.score, problem.twin_answer(e.point).score) for e in sorted(solved, key=lambda e: -e.merit)]
    values = [(a.values, b.values) for a, b in pairs if a is not None and b is not None]
    if len(values) < 2:
        return None
    outside, twin = (np.array([v[i] for v in values]) / scale for i in (0, 1))
    moved, own = outside[1:] - outside[0], twin[1:] - twin[0]
    size = float((moved**2).sum())
    if size <= LEAST_CHANGE**2:
        return None
    return 1.0 - float(((moved - own) ** 2).sum()) / size
