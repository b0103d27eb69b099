"""How far measured cars of one design scatter, apart from the noise of their records."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from doe_kc.characteristics import CHARACTERISTICS, Characteristic
from doe_kc.ground.typing import FloatArray
from doe_kc.measurement.reduction import Measurement

SCATTER_LEVEL = 0.95
"""Of the interval of a scatter."""


def scatter_sd(values: FloatArray, noise_variance: FloatArray | float) -> FloatArray:
    """(...) standard deviation between cars beyond their noise, 0 where the noise explains all.

    values: (n, ...) of n cars, n >= 2. noise_variance: of one car. The variance between the cars less that of
    the noise (one-way analysis of variance, random effects).
    """
    return np.asarray(np.sqrt(np.maximum(np.var(values, axis=0, ddof=1) - noise_variance, 0.0)))


@dataclass(frozen=True)
class CarFigures:
    """One characteristic of n measured cars, in `entry.unit`.

    values: (n,) in the order of the cars. noise_sd: of one car, by its repeats; root mean square of the cars.
    scatter_sd: standard deviation between cars beyond the noise. scatter_low, scatter_high: its 95 %
    interval, by chi-square of the variance between the cars with n - 1 degrees of freedom.
    """

    entry: Characteristic
    values: FloatArray
    noise_sd: float
    scatter_sd: float
    scatter_low: float
    scatter_high: float

    @property
    def mean(self) -> float:
        """Mean of the cars: the target."""
        return float(self.values.mean())

    @property
    def noise_of_mean(self) -> float:
        """Standard error of the mean by noise alone: how well the mean of these cars is known."""
        return float(self.noise_sd / np.sqrt(self.values.size))

    @property
    def mean_sd(self) -> float:
        """Standard error of the mean by noise and scatter: how well it tells the mean of all cars."""
        return float(np.hypot(self.noise_sd, self.scatter_sd) / np.sqrt(self.values.size))

    def standard_errors(self, model: float) -> float:
        """Model less mean in standard errors of the mean; nan without any error."""
        return (model - self.mean) / self.mean_sd if self.mean_sd > 0.0 else float("nan")

    def chance(self, model: float) -> float:
        """Probability of a mean at least that far from the model if the cars were the model's: Student's t
        with n - 1 degrees of freedom, since few cars tell their scatter badly."""
        from scipy.stats import t

        return float(2.0 * t.sf(abs(self.standard_errors(model)), self.values.size - 1))


def car_figures(measurement: Measurement) -> tuple[CarFigures, ...]:
    """Every characteristic that all cars show; none of one car."""
    cars = measurement.cars
    out = []
    for ident, entry in CHARACTERISTICS.items() if cars else ():
        own = [car.characteristics[ident] for car in cars]
        values = np.array([e.value for e in own])
        if np.isfinite(values).all():
            out.append(figures_of(entry, values, float(np.sqrt(np.mean([e.sd**2 for e in own])))))
    return tuple(out)


def figures_of(entry: Characteristic, values: FloatArray, noise_sd: float) -> CarFigures:
    """Scatter of the values (n,) of n cars; noise_sd: of one car, in their unit."""
    from scipy.stats import chi2

    dof, tail = values.size - 1, (1.0 - SCATTER_LEVEL) / 2.0
    total = float(np.var(values, ddof=1)) * dof
    low, high = (float(np.sqrt(max(total / chi2.ppf(p, dof) - noise_sd**2, 0.0))) for p in (1.0 - tail, tail))
    return CarFigures(entry, values, noise_sd, float(scatter_sd(values, noise_sd**2)), low, high)
