"""`gp_ard`: a length-scale of every variable and output by maximum likelihood, for fewer designs than `gp`
needs to tell the variables apart by their linear parts.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, final

import numpy as np

from doe_kc.ground.typing import FloatArray
from doe_kc.surrogate_models import posterior as gp
from doe_kc.surrogate_models.ard_likelihood import Belief, Scales, best_start, even_scales, maximise
from doe_kc.surrogate_models.interface import Fitted, SurrogateModel
from doe_kc.surrogate_models.kernel import CovarianceKernel
from doe_kc.surrogate_models.learning import Sample
from doe_kc.surrogate_models.models._base import register
from doe_kc.surrogate_models.models.gp import FittedGaussianProcess
from doe_kc.surrogate_models.training import Scaling

LEAST_CURVATURE = 1e-12
"""Added to the mean over all outputs before its logarithm is taken."""


@final
@register
@dataclass(frozen=True)
class RelevanceProcess(SurrogateModel):
    """Squared-exponential kernel of each output, its scales by `ard_likelihood`.

    iterations: of each output by itself. shared: of the second maximisation, with a Gaussian prior about the
    logarithm of the mean over all outputs, of precision `belief`: what is relevant to one characteristic of
    an axle is likelier to be so to another. nugget: share of the output's variance.
    """

    nugget: float = 1e-6
    iterations: int = 30
    shared: int = 10
    belief: float = 0.1

    id: ClassVar[str] = "gp_ard"
    label: ClassVar[str] = "Gaussian process, full likelihood"
    complexity: ClassVar[int] = 6
    interpolates: ClassVar[bool] = True
    exact_folds: ClassVar[bool] = True
    optimistic_loo: ClassVar[bool] = True
    most: ClassVar[int | None] = 143

    def _fit(self, x: FloatArray, y: FloatArray, seed: int) -> Fitted:
        del seed
        centre, scaling = x.mean(axis=0), Scaling.of(y)
        sample = Sample(x - centre, scaling.standardise(y))
        scales = self._scales(sample)
        kernel = _kernel(scales, self.nugget)
        return FittedGaussianProcess(centre, scaling, gp.condition(kernel, sample.z, sample.values), None)

    def _scales(self, sample: Sample) -> Scales:
        even = even_scales(sample.spread, sample.values.shape[1])
        first = best_start(even, sample.z, sample.values, nugget=self.nugget)
        alone = maximise(first, sample.z, sample.values, nugget=self.nugget, iterations=self.iterations)
        ordered = np.sort(np.exp(alone.curvature), axis=0)  # a sum that the outputs' order does not change
        mean = np.log(ordered.mean(axis=0) + LEAST_CURVATURE)
        return maximise(
            alone, sample.z, sample.values, nugget=self.nugget, iterations=self.shared,
            belief=Belief(mean, self.belief),
        )  # fmt: skip


def _kernel(scales: Scales, nugget: float) -> CovarianceKernel:
    curvature, bend, constant = (np.exp(s) for s in (scales.curvature, scales.bend, scales.constant))
    return CovarianceKernel(np.zeros_like(curvature), curvature, bend, constant, np.full(len(bend), nugget))
