"""Shares of variance by Saltelli's sample.

References: I. M. Sobol, Math. Comput. Simul. 55, 2001; A. Saltelli et al., Computer Physics Communications
181(2), 2010.
"""

from __future__ import annotations

import warnings
from typing import Any, ClassVar

import numpy as np

from doe_kc.ground.typing import FloatArray
from doe_kc.parameter_influence.global_methods._base import (
    RESAMPLES,
    GlobalIndex,
    GlobalMethod,
    global_method,
    problem,
    salib,
    stacked,
)

EXACT_PLANE = 1e-9
"""Share of the output's range below which what the slopes miss is rounding."""


@global_method
class SobolIndices(GlobalMethod):
    """first: share of the variance by the variable alone. total: that it takes part in, interactions
    included. missed: total share of what the slopes at the start miss, in the variance of the output: 0 of a
    plane."""

    id: ClassVar[str] = "sobol"
    label: ClassVar[str] = "Sobol"
    main: ClassVar[str] = "total"

    def block(self, d: int) -> int:
        """A base sample: two independent points, and between them one for each variable."""
        return d + 2

    def points(self, d: int, size: int, seed: int) -> FloatArray:
        sample = salib("sample.sobol", self.label).sample
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of a size that is no power of two; of scipy's word for a seed
            out: FloatArray = sample(problem(d), size, calc_second_order=False, seed=seed)
        return out

    def indices(
        self, points: FloatArray, values: FloatArray, plane: FloatArray, seed: int
    ) -> tuple[GlobalIndex, ...]:
        d, rest = points.shape[1], values - plane
        done = _analyzed(d, values, seed)
        left = np.ptp(rest, axis=0) > EXACT_PLANE * np.ptp(values, axis=0)
        missed, error = np.zeros((2, d, values.shape[1]))
        if left.any():
            beyond = _analyzed(d, rest[:, left], seed)
            base = np.arange(len(values)) % (d + 2) % (d + 1) == 0  # the independent points, as SALib
            ratio = rest[base][:, left].var(axis=0) / values[base][:, left].var(axis=0)
            missed[:, left], error[:, left] = (ratio * stacked(beyond, key) for key in ("ST", "ST_conf"))
        return (
            GlobalIndex("total", "total share", stacked(done, "ST"), stacked(done, "ST_conf")),
            GlobalIndex("first", "share alone", stacked(done, "S1"), stacked(done, "S1_conf")),
            GlobalIndex("missed", "share beyond the slope", missed, error),
        )


def _analyzed(d: int, values: FloatArray, seed: int) -> list[Any]:
    analyze = salib("analyze.sobol", SobolIndices.label).analyze
    # SALib takes a seed of 0 for none.
    options = {"calc_second_order": False, "num_resamples": RESAMPLES, "seed": seed + 1}
    return [analyze(problem(d), column, **options) for column in values.T]
