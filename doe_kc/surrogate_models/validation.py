"""How good a surrogate is, from values that it was not fitted to."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.special import ndtri

from doe_kc.ground.typing import FloatArray
from doe_kc.surrogate_models.interface import Fitted, LeftOut

NOMINAL = 0.95
"""Coverage that an interval promises."""
NOMINAL_WIDTH = float(ndtri(0.5 + NOMINAL / 2.0))
"""Standard deviations to either side of it."""


@dataclass(frozen=True)
class Quality:
    """All (m,).

    q2: 1 - sum of squared residuals / sum of squares about the mean; 1 = perfect, 0 = no better than the
    mean, nan for an output that does not vary. rmse: unit of the output. coverage: share of true values
    inside the 95 % interval. sharpness: half width of that interval, root mean square, over the output's
    standard deviation.
    """

    q2: FloatArray
    rmse: FloatArray
    coverage: FloatArray
    sharpness: FloatArray


def quality(values: FloatArray, left_out: LeftOut) -> Quality:
    """Of true values (n, m), their residuals and predicted variances."""
    total = np.square(values - values.mean(axis=0)).sum(axis=0)
    square = np.square(left_out.residual)
    with np.errstate(invalid="ignore", divide="ignore"):
        q2 = np.where(total > 0.0, 1.0 - square.sum(axis=0) / total, np.nan)
        half = NOMINAL_WIDTH * np.sqrt(left_out.variance.mean(axis=0) / (total / len(values)))
    inside = np.sqrt(square) <= NOMINAL_WIDTH * np.sqrt(left_out.variance)
    return Quality(q2, np.sqrt(square.mean(axis=0)), inside.mean(axis=0), half)


def quality_on(model: Fitted, x: FloatArray, y: FloatArray) -> Quality:
    """On an independent set of points x (n, d) with true values y (n, m)."""
    return quality(y, LeftOut(y - model.predict(x), model.variance(x)))
