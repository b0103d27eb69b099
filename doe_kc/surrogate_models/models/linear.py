"""`linear`: ridge regression, its penalty chosen per output by leave-one-out."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, final

import numpy as np

from doe_kc.ground.typing import FloatArray
from doe_kc.surrogate_models.interface import Fitted, SurrogateModel
from doe_kc.surrogate_models.models._base import register
from doe_kc.surrogate_models.ridge import RIDGE_PENALTIES, fit_ridge


@final
@register
@dataclass(frozen=True)
class Linear(SurrogateModel):
    """y = a + b x with |b|² penalised. penalty: in place of the choice."""

    penalty: float | None = None

    id: ClassVar[str] = "linear"
    label: ClassVar[str] = "Linear (ridge)"
    complexity: ClassVar[int] = 0
    interpolates: ClassVar[bool] = False
    exact_folds: ClassVar[bool] = True

    def _fit(self, x: FloatArray, y: FloatArray, seed: int) -> Fitted:
        del seed
        return fit_ridge(x, y, RIDGE_PENALTIES if self.penalty is None else np.array([self.penalty]))
