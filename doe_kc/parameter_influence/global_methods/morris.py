"""Elementary effects: trajectories through the box on which one variable after the other moves.

References: M. D. Morris, Technometrics 33(2), 1991; F. Campolongo, J. Cariboni, A. Saltelli, Environ. Model.
Softw. 22(10), 2007 (mean of the magnitudes).
"""

from __future__ import annotations

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

GRID_LEVELS = 4
"""Of each variable (the default of SALib, and of Morris's own examples)."""


@global_method
class Morris(GlobalMethod):
    """mu_star: mean magnitude of the output's change per whole range of the variable. sigma: standard
    deviation of the change: 0 where the output is a plane. missed: root mean square of the change minus that
    by the slope. Over the bounds, whatever the distribution."""

    id: ClassVar[str] = "morris"
    label: ClassVar[str] = "Morris"
    main: ClassVar[str] = "mu_star"
    distributed: ClassVar[bool] = False

    def block(self, d: int) -> int:
        """A trajectory."""
        return d + 1

    def points(self, d: int, size: int, seed: int) -> FloatArray:
        sample = salib("sample.morris", self.label).sample
        out: FloatArray = sample(problem(d), size, num_levels=GRID_LEVELS, seed=seed)
        return out

    def indices(
        self, points: FloatArray, values: FloatArray, plane: FloatArray, seed: int
    ) -> tuple[GlobalIndex, ...]:
        done, rest = (_analyzed(points, columns, seed) for columns in (values, values - plane))
        mean, sigma = stacked(done, "mu_star"), stacked(done, "sigma")
        missed = np.hypot(stacked(rest, "mu"), stacked(rest, "sigma"))
        none = np.full_like(mean, np.nan)
        return (
            GlobalIndex("mu_star", "mean effect μ*", mean, stacked(done, "mu_star_conf")),
            GlobalIndex("sigma", "scatter of the effect σ", sigma, none),
            GlobalIndex("missed", "effect beyond the slope", missed, none),
        )


def _analyzed(points: FloatArray, values: FloatArray, seed: int) -> list[Any]:
    analyze = salib("analyze.morris", Morris.label).analyze
    options = {"num_resamples": RESAMPLES, "num_levels": GRID_LEVELS, "seed": seed}
    return [analyze(problem(points.shape[1]), points, column, **options) for column in values.T]
