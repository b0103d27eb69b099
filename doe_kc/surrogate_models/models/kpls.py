"""`kpls`: kriging whose rates follow a few partial-least-squares directions, found by SMT's KPLS."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, final

import numpy as np

from doe_kc.ground.typing import FloatArray
from doe_kc.surrogate_models.interface import Fitted, SurrogateModel
from doe_kc.surrogate_models.models._base import register
from doe_kc.surrogate_models.ordinary_kriging import ordinary_kriging
from doe_kc.surrogate_models.smt_library import train_kpls


@final
@register
@dataclass(frozen=True)
class PartialLeastSquaresKriging(SurrogateModel):
    """Ordinary kriging. components: directions, at most the number of variables; starts: as of `kriging`.

    Reference: M. A. Bouhlel et al., Structural and Multidisciplinary Optimization 53(5), 2016.
    """

    components: int = 3
    starts: int = 2

    id: ClassVar[str] = "kpls"
    label: ClassVar[str] = "KPLS (SMT)"
    complexity: ClassVar[int] = 4
    costly: ClassVar[bool] = True
    interpolates: ClassVar[bool] = True
    exact_folds: ClassVar[bool] = True
    optimistic_loo: ClassVar[bool] = True

    def _fit(self, x: FloatArray, y: FloatArray, seed: int) -> Fitted:
        count = min(self.components, x.shape[1])
        theta = [train_kpls(x, c, components=count, starts=self.starts, seed=seed) for c in y.T]
        return ordinary_kriging(x, y, np.array(theta))
