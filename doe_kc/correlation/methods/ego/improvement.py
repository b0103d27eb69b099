"""Expected improvement of the rating over the best design, by Monte Carlo with common random numbers.

log EI = log mean_s softplus((R(h_s) - best) / t) with h_s = mean + sd z_s; the samples z are the same at
every point, so it is smooth and its gradient exact.
References: R. Astudillo, P. Frazier, Bayesian optimization of composite functions, ICML 2019; S. Ament et
al., Unexpected improvements to expected improvement, NeurIPS 2023.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.optimize import minimize
from scipy.special import expit, logsumexp, ndtri

from doe_kc.correlation.modelled.composite import Composite
from doe_kc.correlation.modelled.trust_region import TrustBox
from doe_kc.correlation.modelled.unit_samples import scrambled_sobol
from doe_kc.ground.typing import FloatArray
from doe_kc.surrogates.interface import Fitted

IMPROVEMENT_LEVELS = 6
"""Binary logarithm of the samples of the predicted errors."""
SHARPNESS = 1e-2
"""Temperature t as a share of the best rating's size: below it an improvement is rounded."""
ACQUISITION_ITERATIONS = 25


class ExpectedImprovement:
    """log EI at a point and its gradient."""

    def __init__(
        self,
        model: Fitted,
        composite: Composite,
        best: float,
        failed: FloatArray,
        *,
        seed: int,
        doubt: float = 1.0,
    ) -> None:
        """failed: (f, d) points without an answer, whose surroundings count for less.

        doubt: factor of the predicted variances.
        """
        self._doubt = doubt
        self._model, self._composite, self._best = model, composite, best
        self._failed = failed
        samples = scrambled_sobol(IMPROVEMENT_LEVELS, model.outputs, seed)
        self._z = ndtri(np.clip(samples, 1e-6, 1.0 - 1e-6))
        self._temperature = SHARPNESS * max(abs(best), 1e-3)

    def log(self, point: FloatArray) -> tuple[float, FloatArray]:
        """log EI and its gradient (d,)."""
        known = self._model.predict_all(point[None])
        sd = np.sqrt(np.maximum(self._doubt * known.variance[0], 1e-24))
        h = known.mean[0] + self._z * sd
        rating, push = self._composite.rating_and_gradient(h)
        gain = (rating - self._best) / self._temperature
        log_soft = _log_softplus(gain)
        value = float(logsumexp(log_soft) - np.log(len(self._z)))
        share = np.exp(log_soft - logsumexp(log_soft)) * _log_softplus_slope(gain) / self._temperature
        slope = push * share[:, None]
        sd_gradient = self._doubt * known.variance_gradient[0] / (2.0 * sd[:, None])
        gradient = slope.sum(axis=0) @ known.gradient[0] + (slope * self._z).sum(axis=0) @ sd_gradient
        penalty, pull = _nearness(point, self._failed)
        return value + penalty, gradient + pull

    def maximum(self, box: TrustBox, starts: Sequence[FloatArray]) -> FloatArray:
        """(d,) best point found from the starts, by L-BFGS-B inside the box."""
        bounds = list(zip(box.lower, box.upper, strict=True))
        optima = [
            minimize(
                self._negative,
                box.clip(start),
                jac=True,
                method="L-BFGS-B",
                bounds=bounds,
                options={"maxiter": ACQUISITION_ITERATIONS},
            )
            for start in starts
        ]
        best = min(optima, key=lambda r: float(r.fun))
        return np.asarray(box.clip(best.x))

    def _negative(self, point: FloatArray) -> tuple[float, FloatArray]:
        value, gradient = self.log(point)
        return -value, -gradient


def _log_softplus(x: FloatArray) -> FloatArray:
    """log(log(1 + e^x)), exact for very negative x."""
    return np.asarray(np.where(x < -30.0, x, np.log(np.logaddexp(0.0, np.maximum(x, -30.0)))))


def _log_softplus_slope(x: FloatArray) -> FloatArray:
    """Its derivative, 1 for very negative x."""
    kept = np.maximum(x, -30.0)
    return np.asarray(np.where(x < -30.0, 1.0, expit(kept) / np.logaddexp(0.0, kept)))


def _nearness(point: FloatArray, failed: FloatArray) -> tuple[float, FloatArray]:
    """log(1 - exp(-r^2 / 2 l^2)) summed over failures: -inf on one, 0 far away; its gradient."""
    if not len(failed):
        return 0.0, np.zeros_like(point)
    length = 0.02 * np.sqrt(point.size)
    apart = point - failed
    x = np.maximum((apart**2).sum(axis=1) / (2.0 * length**2), 1e-9)
    weight = 1.0 / np.expm1(x)
    return float(np.log(-np.expm1(-x)).sum()), (weight[:, None] * apart / length**2).sum(axis=0)
