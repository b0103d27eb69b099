"""`gp`: Gaussian processes of all outputs at once, made for few designs and many variables."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, final

import numpy as np

from doe_kc.ground.errors import InputError
from doe_kc.ground.typing import FloatArray
from doe_kc.surrogate_models import posterior as gp
from doe_kc.surrogate_models.interface import Fitted, LeftOut, Prediction, SurrogateModel
from doe_kc.surrogate_models.kernel import CovarianceKernel
from doe_kc.surrogate_models.learning import Learning, Sample, even_kernel, learn, pinned_kernel
from doe_kc.surrogate_models.models._base import register
from doe_kc.surrogate_models.training import Scaling

DEFAULT = Learning()
ROWS_A_VARIABLE = 3
"""Rows from which it may be better than `gp_ard`: 6 variables, error 0.005 instead of 0.007 at 60 designs; of
72 to 116 variables, 50 and 100 designs, it was chosen for one characteristic of twenty, without gain."""
RELEVANCE_ROWS = 400
"""Rows up to which `gp_ard` is tried by default: ten seconds of a processor a fit there."""
MANY_POINTS = 50
"""Points from which outputs one by one are faster than all abreast, which overflow a core's own memory."""
ROUND_OFF_SHARE = 1e-6
"""Share of an output's spread below which what an expansion leaves is round-off."""


@dataclass(frozen=True)
class FirstOrderTrend:
    """Known first-order expansion: value (m,) and slope (m, d) at point (d,), slope per unit of x."""

    point: FloatArray
    value: FloatArray
    slope: FloatArray

    def at(self, x: FloatArray) -> FloatArray:
        """(p, m) of the expansion."""
        return np.asarray(self.value + (x - self.point) @ self.slope.T)

    def of(self, outputs: np.ndarray) -> FirstOrderTrend:
        """The same of some outputs: places or marks (k,)."""
        return FirstOrderTrend(self.point, self.value[outputs], self.slope[outputs])


@final
@register
@dataclass(frozen=True)
class GaussianProcess(SurrogateModel):
    """Linear trend and bend with relevances learnt per output (`kernel.py`, `learning.py`).

    trend: the model then describes what the expansion leaves, which vanishes with its slope at the point.
    start: an earlier fit of the same outputs, with or without a trend as this one, whose kernels the
    learning continues from; with `learning.steps` = 0 they are kept.
    """

    trend: FirstOrderTrend | None = None
    start: FittedGaussianProcess | None = None
    learning: Learning = DEFAULT

    id: ClassVar[str] = "gp"
    label: ClassVar[str] = "Gaussian process"
    complexity: ClassVar[int] = 3
    exact_folds: ClassVar[bool] = True
    optimistic_loo: ClassVar[bool] = True
    interpolates: ClassVar[bool] = True

    def fewest(self, variables: int) -> int:
        """Three rows, whatever the number of variables."""
        del variables
        return 3

    def worthwhile(self, rows: int, variables: int) -> bool:
        """From `ROWS_A_VARIABLE` on, and above what `gp_ard` is tried for."""
        return rows >= ROWS_A_VARIABLE * variables or rows > RELEVANCE_ROWS

    def _fit(self, x: FloatArray, y: FloatArray, seed: int) -> FittedGaussianProcess:
        del seed
        if self.trend is not None:
            return self._fit_remainder(x, y, self.trend)
        centre, scaling = x.mean(axis=0), Scaling.of(y)
        sample = Sample(x - centre, scaling.standardise(y))
        return self._learn(even_kernel(sample, self.learning), sample, centre, scaling)

    def _fit_remainder(self, x: FloatArray, y: FloatArray, trend: FirstOrderTrend) -> FittedGaussianProcess:
        rest, spread = y - trend.at(x), y.std(axis=0)
        size = np.maximum(np.sqrt((rest**2).mean(axis=0)), ROUND_OFF_SHARE * spread)
        scaling = Scaling(np.zeros(y.shape[1]), size)
        sample = Sample(x - trend.point, scaling.standardise(rest))
        first = pinned_kernel(trend.slope / spread[:, None], sample, self.learning)
        return self._learn(first, sample, trend.point, scaling)

    def _learn(
        self, first: CovarianceKernel, sample: Sample, centre: FloatArray, scaling: Scaling
    ) -> FittedGaussianProcess:
        if self.start is not None:
            _check_start(self.start, first)
            first = self.start.kernel.scaled((self.start.scaling.scale / scaling.scale) ** 2)
        kernel = learn(first, sample, self.learning)
        return FittedGaussianProcess(
            centre, scaling, gp.condition(kernel, sample.z, sample.values), self.trend
        )


def _check_start(start: FittedGaussianProcess, first: CovarianceKernel) -> None:
    if start.kernel.relevance.shape != first.relevance.shape or start.kernel.pinned != first.pinned:
        raise InputError(
            "surrogate gp: the earlier fit has other variables or outputs, or a trend where this has none; "
            "learn without start."
        )


@final
@dataclass(frozen=True)
class FittedGaussianProcess(Fitted):
    """centre: (d,) that z is measured from. posterior: of the standardised outputs."""

    centre: FloatArray
    scaling: Scaling
    posterior: gp.ProcessPosterior
    trend: FirstOrderTrend | None

    @property
    def variables(self) -> int:
        """d."""
        return len(self.centre)

    @property
    def outputs(self) -> int:
        """m."""
        return len(self.scaling.scale)

    @property
    def chunk(self) -> int:
        """As many points as make arrays of some 30 MB."""
        return 4_000_000 // self.posterior.alpha.size

    @property
    def kernel(self) -> CovarianceKernel:
        """Hyper-parameters, for a later fit."""
        return self.posterior.kernel

    def of(self, outputs: np.ndarray) -> FittedGaussianProcess:
        """See `Fitted.of`."""
        trend = None if self.trend is None else self.trend.of(outputs)
        scaling = self.scaling.chosen(outputs)
        return FittedGaussianProcess(self.centre, scaling, self.posterior.of(outputs), trend)

    def cross_validate(self) -> LeftOut:
        """Leave-one-out with the hyper-parameters held, closed form."""
        residual, variance = gp.left_out(self.posterior)
        return LeftOut(residual * self.scaling.scale, variance * self.scaling.scale**2)

    def _everything(self, x: FloatArray) -> Prediction:
        """From one set of covariances."""
        p, c = self.posterior, self._cross(x)
        white = c.white(p)
        scale, square = self.scaling.scale, self.scaling.scale**2
        return Prediction(
            self._known(x) + scale * gp.mean(p, c),
            square * gp.variance(p, c, white),
            self._known_slope() + scale[:, None] * gp.mean_gradient(p, c),
            square[:, None] * gp.variance_gradient(p, c, white),
        )

    def _mean(self, x: FloatArray) -> FloatArray:
        p = self.posterior
        mean = gp.mean(p, self._cross(x)) if len(x) < MANY_POINTS else gp.mean_alone(p, x - self.centre)
        return self._known(x) + self.scaling.scale * mean

    def _variance(self, x: FloatArray) -> FloatArray:
        p, c = self.posterior, self._cross(x)
        return np.asarray(self.scaling.scale**2 * gp.variance(p, c, c.white(p)))

    def _gradient(self, x: FloatArray) -> FloatArray:
        slope = gp.mean_gradient(self.posterior, self._cross(x))
        return self._known_slope() + self.scaling.scale[:, None] * slope

    def _variance_gradient(self, x: FloatArray) -> FloatArray:
        p, c = self.posterior, self._cross(x)
        slope = gp.variance_gradient(p, c, c.white(p))
        return np.asarray((self.scaling.scale**2)[:, None] * slope)

    def _cross(self, x: FloatArray) -> gp.Cross:
        return gp.cross(self.posterior, x - self.centre)

    def _known(self, x: FloatArray) -> FloatArray:
        return self.scaling.shift if self.trend is None else self.trend.at(x)

    def _known_slope(self) -> FloatArray:
        return np.zeros_like(self.posterior.slope) if self.trend is None else self.trend.slope
