"""`gp_ard`: a length-scale of every variable and output by maximum likelihood, for fewer designs than `gp`
needs to tell the variables apart by their linear parts.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, final

import numpy as np

from doe_kc.ground.typing import FloatArray
from doe_kc.surrogate_models import posterior as gp
from doe_kc.surrogate_models.ard_likelihood import (
    Belief,
    Pairs,
    Scales,
    best_start,
    even_scales,
    fixed_point,
    maximise,
)
from doe_kc.surrogate_models.interface import Fitted, SurrogateModel
from doe_kc.surrogate_models.kernel import CovarianceKernel
from doe_kc.surrogate_models.learning import Sample
from doe_kc.surrogate_models.models._base import register
from doe_kc.surrogate_models.models.gp import RELEVANCE_ROWS, FittedGaussianProcess
from doe_kc.surrogate_models.training import Scaling

LEAST_CURVATURE = 1e-12
"""Added to the mean over the outputs before its logarithm is taken."""
NUGGET, NUGGET_ROWS = 1e-4, 100
"""Share of an output's variance that no length-scale of so few rows can tell; above that many rows it falls
with their square, as the error does (error at 400 designs 0.0120 instead of 0.0136)."""
FIRST_ROWS = 200
"""Rows that the first maximisation makes do with: at 400 a third of the time for 3 % of the error."""


@final
@register
@dataclass(frozen=True)
class RelevanceProcess(SurrogateModel):
    """Matérn kernel of each output, its scales by `ard_likelihood`.

    steps: of the fixed point that it starts with. evaluations: of the likelihood of each output by itself.
    shared: of the second maximisation, with a Gaussian prior of precision `belief` about the logarithm of the
    mean over the outputs, weighted by their correlation with it to the power `likeness`: what is relevant to
    one characteristic of an axle is likelier to be so to another that varies with it. Twice as many where
    the first had not all rows.
    """

    steps: int = 8
    evaluations: int = 16
    shared: int = 10
    belief: float = 0.3
    likeness: float = 4.0

    id: ClassVar[str] = "gp_ard"
    label: ClassVar[str] = "Gaussian process, full likelihood"
    complexity: ClassVar[int] = 6
    interpolates: ClassVar[bool] = False
    exact_folds: ClassVar[bool] = True
    optimistic_loo: ClassVar[bool] = True

    def worthwhile(self, rows: int, variables: int) -> bool:
        """Up to `RELEVANCE_ROWS`."""
        return self.fewest(variables) <= rows <= RELEVANCE_ROWS

    def _fit(self, x: FloatArray, y: FloatArray, seed: int) -> Fitted:
        del seed
        centre, scaling = x.mean(axis=0), Scaling.of(y)
        sample = Sample(x - centre, scaling.standardise(y))
        nugget = NUGGET * min(1.0, NUGGET_ROWS / len(x)) ** 2
        kernel = _kernel(self._scales(sample, nugget), nugget)
        return FittedGaussianProcess(centre, scaling, gp.condition(kernel, sample.z, sample.values), None)

    def _scales(self, sample: Sample, nugget: float) -> Scales:
        pairs = first_pairs = Pairs.of(sample.z)
        values = sample.values
        if len(sample.z) > FIRST_ROWS:
            first_pairs, values = Pairs.of(sample.z[:FIRST_ROWS]), values[:FIRST_ROWS]
        first = best_start(even_scales(sample.spread, values.shape[1]), first_pairs, values, nugget=nugget)
        first = fixed_point(first, first_pairs, values, nugget=nugget, steps=self.steps)
        alone = maximise(first, first_pairs, values, nugget=nugget, evaluations=self.evaluations)
        shared = self.shared if first_pairs is pairs else 2 * self.shared
        return maximise(
            alone, pairs, sample.values, nugget=nugget, evaluations=shared,
            belief=Belief(self._expected(alone, sample.values), self.belief),
        )  # fmt: skip

    def _expected(self, scales: Scales, values: FloatArray) -> FloatArray:
        """(m, d) logarithms of the weighted means; sums that the order of the outputs does not change."""
        likeness = np.abs(np.atleast_2d(np.corrcoef(values.T))) ** self.likeness
        parts = (likeness / likeness.sum(axis=1, keepdims=True))[:, :, None] * np.exp(scales.curvature)[None]
        return np.asarray(np.log(np.sort(parts, axis=1).sum(axis=1) + LEAST_CURVATURE))


def _kernel(scales: Scales, nugget: float) -> CovarianceKernel:
    curvature, bend, constant = (np.exp(s) for s in (scales.curvature, scales.bend, scales.constant))
    zero, nuggets = np.zeros_like(curvature), np.full(len(bend), nugget)
    return CovarianceKernel(zero, curvature, bend, constant, nuggets, matern=True)
