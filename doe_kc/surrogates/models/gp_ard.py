"""`gp_ard`: per-output length-scales of every variable by maximum likelihood (scikit-learn), a linear kernel
beside: the reference that `gp` is measured against where designs abound.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, final

import numpy as np

from doe_kc.ground.typing import FloatArray
from doe_kc.surrogates import posterior as gp
from doe_kc.surrogates.interface import Fitted, SurrogateModel
from doe_kc.surrogates.kernel import CovarianceKernel
from doe_kc.surrogates.models._base import register
from doe_kc.surrogates.models.gp import FittedGaussianProcess
from doe_kc.surrogates.scikit_library import ArdParameters, train_ard
from doe_kc.surrogates.training import Scaling


@final
@register
@dataclass(frozen=True)
class RelevanceProcess(SurrogateModel):
    """Seconds to minutes an output in 60-D; needs two designs a variable. iterations: of the maximisation."""

    nugget: float = 1e-6
    iterations: int = 100

    id: ClassVar[str] = "gp_ard"
    label: ClassVar[str] = "GP, ARD (scikit-learn)"
    complexity: ClassVar[int] = 6
    costly: ClassVar[bool] = True
    interpolates: ClassVar[bool] = True
    exact_folds: ClassVar[bool] = True
    optimistic_loo: ClassVar[bool] = True

    def fewest(self, variables: int) -> int:
        """Two rows a variable."""
        return max(5, 2 * variables)

    def _fit(self, x: FloatArray, y: FloatArray, seed: int) -> Fitted:
        del seed
        centre, scaling = x.mean(axis=0), Scaling.of(y)
        z, values = x - centre, scaling.standardise(y)
        parameters = [train_ard(z, c, nugget=self.nugget, iterations=self.iterations) for c in values.T]
        kernel = _kernel(parameters, x.shape[1], self.nugget)
        return FittedGaussianProcess(centre, scaling, gp.condition(kernel, z, values), None)


def _kernel(parameters: list[ArdParameters], variables: int, nugget: float) -> CovarianceKernel:
    return CovarianceKernel(
        relevance=np.array([np.full(variables, f.slope) for f in parameters]),
        curvature=np.array([f.lengths**-2 for f in parameters]),
        bend=np.array([f.bend for f in parameters]),
        constant=np.array([f.offset for f in parameters]),
        nugget=np.full(len(parameters), nugget),
    )
