"""Statistics of a sample of cars: moments, percentiles, and shares with their confidence interval."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from doe_kc.ground.typing import FloatArray

CONFIDENCE = 0.95
"""Of every interval."""
CONFIDENCE_WIDTH = 1.959963984540054
"""Standard deviations of a normal distribution to either side that hold it."""
PERCENTILES = (0.1, 1.0, 5.0, 25.0, 50.0, 75.0, 95.0, 99.0, 99.9)


@dataclass(frozen=True)
class Moments:
    """Of one characteristic over the cars, in its unit. sd_error: standard error of the sd. skewness: third
    standardized moment, 0 of a symmetric distribution. percentiles: of PERCENTILES."""

    mean: float
    sd: float
    sd_error: float
    skewness: float
    percentiles: tuple[float, ...]


def moments(values: FloatArray) -> Moments:
    """Of (n,) values. The standard error of the sd is sd sqrt((kurtosis - 1) / 4 n), for large n."""
    mean, sd = float(values.mean()), float(values.std(ddof=1))
    if sd == 0.0:
        return Moments(mean, 0.0, 0.0, 0.0, tuple(map(float, np.percentile(values, PERCENTILES))))
    standard = (values - mean) / values.std()
    kurtosis = float((standard**4).mean())
    return Moments(
        mean=mean,
        sd=sd,
        sd_error=sd * math.sqrt(max(kurtosis - 1.0, 0.0) / (4.0 * len(values))),
        skewness=float((standard**3).mean()),
        percentiles=tuple(map(float, np.percentile(values, PERCENTILES))),
    )


@dataclass(frozen=True)
class CarShare:
    """count of n cars, and the interval that holds the true share with 95 % confidence; all shares in [0,
    1]."""

    count: int
    n: int
    low: float
    high: float

    @property
    def share(self) -> float:
        """count / n."""
        return self.count / self.n if self.n else math.nan


def car_share(count: int, n: int) -> CarShare:
    """With E. B. Wilson's score interval (J. Am. Stat. Assoc. 22, 1927), which holds its confidence for rare
    events too (L. D. Brown, T. T. Cai, A. DasGupta, Stat. Sci. 16(2), 2001)."""
    if n == 0:
        return CarShare(0, 0, 0.0, 1.0)
    z2 = CONFIDENCE_WIDTH**2
    p = count / n
    centre = (p + z2 / (2.0 * n)) / (1.0 + z2 / n)
    half = CONFIDENCE_WIDTH / (1.0 + z2 / n) * math.sqrt(p * (1.0 - p) / n + z2 / (4.0 * n * n))
    low = 0.0 if count == 0 else centre - half
    return CarShare(count, n, low, 1.0 if count == n else centre + half)


def percentile_of(value: float, values: FloatArray) -> float:
    """Percent of (n,) values below one, half of those that equal it."""
    return 100.0 * float((values < value).mean() + 0.5 * (values == value).mean())
