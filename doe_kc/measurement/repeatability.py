"""Offset, gain and smooth error from repeat runs, by restricted maximum likelihood."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from doe_kc.ground.typing import FloatArray
from doe_kc.measurement.noise import ErrorComponents

LIKELIHOOD_POINTS = 21
"""Inputs per curve in the likelihood: enough for the shortest correlation length, cheap to factor."""
_BOUNDS = ((-7.0, 4.0), (-12.0, -2.0), (-7.0, 4.0), (np.log(0.1), np.log(1.0)))
_START = np.log([1.0, 2e-3, 0.5, 0.3])

TYPICAL_GAIN = 2e-3
"""Run-to-run gain error assumed of a rig whose repeats are not at hand, -."""
TYPICAL_LENGTH = 0.3


@dataclass(frozen=True)
class Repeats:
    """One curve of one side, R runs on n inputs; n is the same for all curves that are pooled.

    relative: (n,) input / amplitude. white: (n, n) known white-noise covariance of a run.
    signal: (n,) change from static. runs: (R, n) values as recorded, R >= 2.
    """

    relative: FloatArray
    white: FloatArray
    signal: FloatArray
    runs: FloatArray


def thinned(relative: FloatArray, white: FloatArray, signal: FloatArray, runs: FloatArray) -> Repeats:
    """`Repeats` on POINTS of the grid's inputs."""
    at = np.linspace(0, relative.size - 1, LIKELIHOOD_POINTS).round().astype(int)
    return Repeats(relative[at], white[np.ix_(at, at)], signal[at], runs[:, at])


def error_components(curves: Sequence[Repeats], resolution: float) -> ErrorComponents:
    """Most likely offset, gain, smooth sd and correlation length behind the runs' differences.

    Each run of curve c is y_c + e with one unknown y_c and e ~ N(0, W_c + o² 11' + g² s s' + a² K_l);
    the runs' deviations from their mean carry R - 1 degrees of freedom each (REML). Curves of one
    sensor kind are pooled, since three runs of one curve determine a standard deviation to ±50 % only.
    resolution: of the sensor, sets the scale of the search (components from 1e-3 of it).
    """
    scatter = [_scatter(c) for c in curves]
    stack = _Stack(
        white=np.stack([c.white for c in curves]),
        ones=np.ones((LIKELIHOOD_POINTS, LIKELIHOOD_POINTS)),
        signal=np.stack([np.outer(c.signal, c.signal) for c in curves]),
        relative=np.stack([c.relative for c in curves]),
        scatter=np.stack(scatter),
        weight=np.array([c.runs.shape[0] - 1.0 for c in curves]),
        resolution=resolution,
    )
    from scipy.optimize import minimize

    best = minimize(stack.deviance, _START, method="L-BFGS-B", bounds=_BOUNDS)
    offset, gain, smooth, length = np.exp(best.x)
    return ErrorComponents(
        offset=float(offset * resolution),
        gain=float(gain),
        smooth=float(smooth * resolution),
        length=float(length),
        dof=int(stack.weight.sum()),
        source="repeats",
    )


def components_from_resolution(resolution: float) -> ErrorComponents:
    """Stand-in when there is one run only: offset = smooth = resolution, gain 0.2 %, dof 0."""
    return ErrorComponents(resolution, TYPICAL_GAIN, resolution, TYPICAL_LENGTH, 0, "resolution")


def _scatter(curve: Repeats) -> FloatArray:
    deviations = curve.runs - curve.runs.mean(axis=0)
    out: FloatArray = deviations.T @ deviations
    return out


@dataclass(frozen=True)
class _Stack:
    """The curves as arrays over the leading axis, for one batched factorisation."""

    white: FloatArray
    ones: FloatArray
    signal: FloatArray
    relative: FloatArray
    scatter: FloatArray
    weight: FloatArray
    resolution: float

    def covariance(self, log_parameters: FloatArray) -> FloatArray:
        offset, gain, smooth, length = np.exp(log_parameters)
        distance = (self.relative[:, :, None] - self.relative[:, None, :]) / length
        total: FloatArray = (
            self.white
            + (offset * self.resolution) ** 2 * self.ones
            + gain**2 * self.signal
            + (smooth * self.resolution) ** 2 * np.exp(-0.5 * distance**2)
        )
        # Noise-free records leave nothing to factor; a thousandth of the resolution is no noise.
        jitter = (1e-3 * self.resolution) ** 2 * np.eye(LIKELIHOOD_POINTS)
        out: FloatArray = total + jitter
        return out

    def deviance(self, log_parameters: FloatArray) -> float:
        """-2 log restricted likelihood + constant: sum (R-1) ln|C| + tr(C^-1 D'D), per curve."""
        covariance = self.covariance(log_parameters)
        _, log_det = np.linalg.slogdet(covariance)
        quadratic = np.trace(np.linalg.solve(covariance, self.scatter), axis1=1, axis2=2)
        return float(np.sum(self.weight * log_det + quadratic)) / float(self.weight.sum())
