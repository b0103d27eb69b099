"""What scikit-learn lends: the lasso's path and the likelihood of a Gaussian process; typed and silent."""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from importlib import import_module
from typing import Any

import numpy as np
from scipy.optimize import minimize

from doe_kc.ground.typing import FloatArray

LENGTHS = (0.05, 1e3)
VARIANCES = (1e-6, 1e4)


def _library(part: str) -> Any:
    """Imported when needed: it takes a second, and ships no types."""
    return import_module(f"sklearn.{part}")


@dataclass(frozen=True)
class PenaltyPath:
    """penalties: (k,) decreasing. coefficients: (p, k) at them; between two they are straight lines."""

    penalties: FloatArray
    coefficients: FloatArray

    def at(self, penalty: float) -> FloatArray:
        """(p,) coefficients at a penalty; the path's end below its last."""
        k = int(np.searchsorted(-self.penalties, -penalty))
        if k == 0 or k >= len(self.penalties):
            return self.coefficients[:, min(k, len(self.penalties) - 1)]
        high, low = self.penalties[k - 1], self.penalties[k]
        share = (high - penalty) / (high - low)
        return np.asarray((1.0 - share) * self.coefficients[:, k - 1] + share * self.coefficients[:, k])


def lasso_path(features: FloatArray, y: FloatArray, *, least: float, steps: int) -> PenaltyPath:
    """Lasso path by least-angle regression of y (n,) on features (n, p), both centred here.

    least: penalty to stop at. Reference: B. Efron et al., Annals of Statistics 32(2), 2004.
    """
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # early stops of a degenerate path: what it has is used
        penalties, _, coefficients = _library("linear_model").lars_path(
            features - features.mean(axis=0), y - y.mean(), method="lasso", alpha_min=least, max_iter=steps,
            copy_X=False,
        )  # fmt: skip
    return PenaltyPath(np.asarray(penalties), np.asarray(coefficients))


@dataclass(frozen=True)
class ArdParameters:
    """Variances of bend exp(-½ sum (dx / length)²) + slope x'x' + offset; lengths (d,)."""

    bend: float
    lengths: FloatArray
    slope: float
    offset: float


def train_ard(z: FloatArray, y: FloatArray, *, nugget: float, iterations: int) -> ArdParameters:
    """Maximum likelihood of centred points z (n, d) and standardised values y (n,)."""
    process, kernels = _library("gaussian_process"), _library("gaussian_process.kernels")
    d = z.shape[1]
    bend = kernels.ConstantKernel(1.0, VARIANCES) * kernels.RBF(np.full(d, np.sqrt(d)), LENGTHS)
    slope = kernels.ConstantKernel(1.0, VARIANCES) * kernels.DotProduct(1.0, (1e-3, 1e3))
    model = process.GaussianProcessRegressor(bend + slope, alpha=nugget, optimizer=None).fit(z, y)

    def objective(theta: FloatArray) -> tuple[float, FloatArray]:
        value, gradient = model.log_marginal_likelihood(theta, eval_gradient=True, clone_kernel=False)
        return -float(value), -np.asarray(gradient)

    kernel = model.kernel_
    optimum = minimize(
        objective, kernel.theta, jac=True, bounds=kernel.bounds, method="L-BFGS-B",
        options={"maxiter": iterations},
    )  # fmt: skip
    best = kernel.clone_with_theta(optimum.x)
    straight = best.k2.k1.constant_value
    return ArdParameters(
        float(best.k1.k1.constant_value),
        np.array(best.k1.k2.length_scale, dtype=float).reshape(d),
        float(straight),
        float(straight * best.k2.k2.sigma_0**2),
    )
