"""`kriging`: one rate a variable and output, found by SMT's KRG."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, final

import numpy as np

from doe_kc.ground.typing import FloatArray
from doe_kc.surrogate_models.interface import Fitted, SurrogateModel
from doe_kc.surrogate_models.models._base import register
from doe_kc.surrogate_models.ordinary_kriging import ordinary_kriging
from doe_kc.surrogate_models.smt_library import train_kriging


@final
@register
@dataclass(frozen=True)
class Kriging(SurrogateModel):
    """Ordinary kriging. starts: of the likelihood's maximisation, each taking seconds an output in 60-D."""

    starts: int = 1

    id: ClassVar[str] = "kriging"
    label: ClassVar[str] = "Kriging (SMT)"
    complexity: ClassVar[int] = 5
    costly: ClassVar[bool] = True
    interpolates: ClassVar[bool] = True
    exact_folds: ClassVar[bool] = True
    optimistic_loo: ClassVar[bool] = True

    def _fit(self, x: FloatArray, y: FloatArray, seed: int) -> Fitted:
        theta = [train_kriging(x, column, starts=self.starts, seed=seed) for column in y.T]
        return ordinary_kriging(x, y, np.array(theta))
