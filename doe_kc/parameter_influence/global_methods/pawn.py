"""PAWN: how far the distribution of the output moves when a variable is held within a slice of its range.

Reference: F. Pianosi, T. Wagener, Environ. Model. Softw. 108, 2018, doi:10.1016/j.envsoft.2018.07.019. Values
are those of SALib's `pawn.analyze`, which takes 0.6 s for one output of 1000 designs of 72 variables, so that
its bootstrap over 30 outputs would take nine minutes: here all variables' slices are counted together, in 15
s.
"""

from __future__ import annotations

from typing import ClassVar

import numpy as np

from doe_kc.ground.typing import FloatArray
from doe_kc.parameter_influence.global_methods._base import (
    GlobalIndex,
    GlobalMethod,
    global_method,
)

PAWN_SLICES = 10
"""Of each variable's range, equally probable (the default of SALib)."""
PAWN_RESAMPLES = 30
"""Bootstrap samples: half the width of an interval to 13 %."""
IRRELEVANT = 40
"""Columns of chance, whose index is what no influence looks like."""
INTERVAL_WIDTH = 1.959963984540054
"""Standard deviations to either side that hold 95 % of a normal distribution."""


@global_method
class Pawn(GlobalMethod):
    """median: of the Kolmogorov-Smirnov distances over the slices, in [0, 1]. chance: the distance that 95 %
    of variables without influence stay below with as many designs, the same for all."""

    id: ClassVar[str] = "pawn"
    label: ClassVar[str] = "PAWN"
    main: ClassVar[str] = "median"

    def block(self, d: int) -> int:
        """A design alone."""
        return 1

    def points(self, d: int, size: int, seed: int) -> FloatArray:
        from scipy.stats import qmc

        out: FloatArray = qmc.LatinHypercube(d, rng=np.random.default_rng(seed)).random(size)
        return out

    def indices(
        self, points: FloatArray, values: FloatArray, plane: FloatArray, seed: int
    ) -> tuple[GlobalIndex, ...]:
        del plane
        rng = np.random.default_rng(seed)
        n, d = points.shape
        median = pawn_medians(points, values)
        again = []
        for _ in range(PAWN_RESAMPLES):
            rows = rng.integers(n, size=n)
            again.append(pawn_medians(points[rows], values[rows]))
        error = INTERVAL_WIDTH * np.std(again, axis=0, ddof=1)
        chance = np.percentile(pawn_medians(rng.random((n, IRRELEVANT)), values), 95.0, axis=0)
        chances = np.tile(chance, (d, 1))
        return (
            GlobalIndex("median", "shift of the distribution", median, np.asarray(error)),
            GlobalIndex("chance", "shift by chance", chances, np.full_like(chances, np.nan)),
        )


def pawn_medians(points: FloatArray, values: FloatArray) -> FloatArray:
    """(d, k) median over the slices of the largest distance between the distribution of the output within a
    slice and that of all designs; points (n, d), values (n, k).

    A slice is [q_s, q_s+1) of the variable's quantiles, as in SALib.
    """
    n, d = points.shape
    edges = np.quantile(points, np.arange(PAWN_SLICES + 1) / PAWN_SLICES, axis=0)
    member = np.stack([(points >= edges[s]) & (points < edges[s + 1]) for s in range(PAWN_SLICES)])
    count = member.sum(axis=1)
    out = np.empty((d, values.shape[1]))
    for k, column in enumerate(values.T):
        order = np.argsort(column, kind="stable")
        ordered = column[order]
        last = np.append(ordered[1:] != ordered[:-1], True)  # of equal values: where both curves have risen
        inside = np.cumsum(member[:, order], axis=1, dtype=np.int32)[:, last]
        overall = (np.flatnonzero(last) + 1.0) / n
        with np.errstate(invalid="ignore"):
            gap = np.abs(inside / count[:, None, :] - overall[None, :, None]).max(axis=1)
        out[:, k] = np.nanmedian(gap, axis=0)
    return out
