"""Shares of variance by Saltelli's sample.

References: I. M. Sobol, Math. Comput. Simul. 55, 2001; A. Saltelli et al., Computer Physics Communications
181(2), 2010.
"""

from __future__ import annotations

import warnings
from typing import ClassVar

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


@global_method
class SobolIndices(GlobalMethod):
    """first: share of the variance by the variable alone. total: that it takes part in, interactions
    included."""

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

    def indices(self, points: FloatArray, values: FloatArray, seed: int) -> tuple[GlobalIndex, ...]:
        analyze = salib("analyze.sobol", self.label).analyze
        d = points.shape[1]
        # SALib takes a seed of 0 for none.
        done = [
            analyze(problem(d), column, calc_second_order=False, num_resamples=RESAMPLES, seed=seed + 1)
            for column in values.T
        ]
        return (
            GlobalIndex("total", "total share", stacked(done, "ST"), stacked(done, "ST_conf")),
            GlobalIndex("first", "share alone", stacked(done, "S1"), stacked(done, "S1_conf")),
        )
