"""How far the parameters of several measured cars scatter, and what their mean may be off before a fit.

A fit of several cars is one of their mean car: its hardpoints are the means of theirs, to first order. What
the single cars have apart from each other says how far such a mean is off. With the prior P of one car's
parameters, of which the cars' own variance kappa P^2 is estimated by restricted maximum likelihood (Patterson
& Thompson, Biometrika 58, 1971), the mean of n cars has the variance kappa P^2 / n + (1 - kappa) P^2: what is
not the cars' own they have in common, and no mean takes it away.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from doe_kc.correlation.likelihood import Likelihood
from doe_kc.curves import CurveSet
from doe_kc.discovery.derivatives import own_columns
from doe_kc.discovery.model import EffectModel
from doe_kc.discovery.nuisances import side_differences
from doe_kc.discovery.thresholds import COMMON_SHARE
from doe_kc.ground.typing import FloatArray
from doe_kc.measurement import Measurement

RATIO_RANGE = (1e-6, 1e3)
"""Of a variance to the assumed one, between which it is looked for."""
SEEN = 1e-9
"""Share of the largest variance below which a direction of the parameters is not seen in the records."""


@dataclass(frozen=True)
class SeriesScatter:
    """Scatter of the parameters of `cars` cars about their mean.

    ratio: variance over the assumed one of a single car, >= 0; ratio_sd: its standard error.
    """

    cars: int
    ratio: float
    ratio_sd: float

    @property
    def sd(self) -> float:
        """Standard deviation over the assumed one."""
        return float(np.sqrt(self.ratio))

    @property
    def sd_error(self) -> float:
        """Standard error of `sd`."""
        return self.ratio_sd / (2.0 * self.sd) if self.sd > 0.0 else float("nan")

    @property
    def mean_sd(self) -> float:
        """Standard deviation of the mean car's parameters over that assumed of a single car's; at least
        COMMON_SHARE of the variance is taken for common to all cars."""
        return float(np.sqrt(max(1.0 - self.ratio, COMMON_SHARE) + self.ratio / self.cars))

    @property
    def sentence(self) -> str:
        """What was found, for a reader."""
        return (
            f"The records are the mean of {self.cars} cars, whose parameters scatter about each other by "
            f"{self.sd:.2f} ± {self.sd_error:.2f} of what the bounds leave to one car (standard deviations); "
            f"those of their mean are taken to be off by {self.mean_sd:.2f} of it."
        )


def series_scatter(model: EffectModel, measurement: Measurement) -> SeriesScatter:
    """Scatter of the cars of a measurement. model: without effects, against the records of their mean.

    Differences of the cars from their mean, whitened by the noise of one car, have the covariance
    s^2 I + kappa G G' of n - 1 degrees of freedom, G the exact sensitivities at the nominal axle to the
    parameters and the differences between the sides, per standard deviation of their priors. Scales of the
    rig's inputs are taken off before. NotConverged when the nominal axle has no equilibrium.
    """
    cars, z = measurement.cars, model.centre
    own = own_columns(model, z, model.residual(z))
    sides = side_differences(model.axle_at(z), model.space, model.likelihood)
    scales = np.linalg.qr(own[:, model.calibrations])[0]

    def rest(rows: FloatArray) -> FloatArray:
        return np.asarray((rows - scales @ (scales.T @ rows)) / np.sqrt(len(cars)))

    columns = rest(np.hstack([own[:, : model.parameters] * model.space.prior_sd, sides]))
    apart = rest(np.array([deviation(model.likelihood, car) for car in cars]).T)
    apart -= apart.mean(axis=1, keepdims=True)
    return most_likely_scatter(columns, apart)


def deviation(likelihood: Likelihood, car: Measurement) -> FloatArray:
    """(M,) data of one car less those of a likelihood, in standard deviations of the latter."""
    parts = [
        c.whitened(_values(car.curves, c.load_case, c.response, c.side, c.branches, c.input) - c.value)
        for c in likelihood.curves
    ]
    statics = [
        (float((car.curves.static or {})[f.response][f.side]) - f.value) / f.sd for f in likelihood.figures
    ]
    return np.concatenate([*parts, np.array(statics)])


def _values(
    curves: CurveSet, load_case: str, response: str, side: int, branches: str, at: FloatArray
) -> FloatArray:
    case = curves.cases[load_case]
    rows = case.mean if branches == "mean" else case.half_width
    return np.asarray(np.interp(at, case.input, rows[response][side]))


def most_likely_scatter(columns: FloatArray, apart: FloatArray) -> SeriesScatter:
    """By restricted maximum likelihood.

    columns: G (M, l), l < M. apart: (M, n) differences of n cars from their mean, whitened.
    """
    from scipy.optimize import minimize_scalar

    cars = apart.shape[1]
    variances, directions = np.linalg.eigh(columns.T @ columns)
    kept = variances > SEEN * variances.max()
    variances = variances[kept]
    seen = (columns @ (directions[:, kept] / np.sqrt(variances))).T @ apart
    squares = np.sum(seen**2, axis=1)
    unseen = float(np.sum(apart**2) - np.sum(squares))
    noise = unseen / ((cars - 1) * (apart.shape[0] - variances.size))

    def deviance(log_ratio: float) -> float:
        total = noise + np.exp(log_ratio) * variances
        return float(np.sum((cars - 1) * np.log(total) + squares / total))

    best = minimize_scalar(deviance, bounds=tuple(np.log(RATIO_RANGE)), method="bounded")
    ratio = float(np.exp(best.x))
    information = (cars - 1) / 2.0 * np.sum((variances / (noise + ratio * variances)) ** 2)
    return SeriesScatter(cars, ratio, float(information**-0.5))
