"""Learns the kernels of the `gp` surrogate by empirical Bayes, from fewer rows than variables.

Linear coefficients are Gaussian with a variance of their own, their relevance: expectation maximisation in
closed form, shrunk towards the variable's mean over all outputs. The bend follows: its curvatures depart from
the relevances as far as the marginal likelihood asks (its exact gradient, Adam steps on their logarithms
under a Gaussian prior); its variance by the likelihood's fixed point.
References: D. J. C. MacKay, Neural Computation 4(3), 1992; M. E. Tipping, J. Mach. Learn. Res. 1, 2001;
C. E. Rasmussen, C. K. I. Williams, 2006, eq. 5.9.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from doe_kc.ground.typing import FloatArray
from doe_kc.surrogate_models.cholesky import inverses
from doe_kc.surrogate_models.kernel import Bend, CovarianceKernel, training_covariance

LEAST_RELEVANCE = 1e-6
"""Smallest relevance, share of what it is when all variables are equally relevant."""
BEND_RANGE = (1e-6, 1e4)


@dataclass(frozen=True)
class Learning:
    """How kernels are learnt; the defaults are measured on the example axle (benchmarks/surrogates.py).

    steps: of the iteration, those from `wait` on move the curvatures too. shrink: belief in the mean over
    all outputs, in outputs. reach: length-scale of the bend in standard deviations of the linear part, where
    the curvatures start. floor: curvature of an irrelevant variable, share of the mean. loose: standard
    deviation of the logarithm of a curvature. rate: largest step of it. nugget: share of the variance.
    """

    steps: int = 12
    wait: int = 4
    shrink: float = 0.2
    reach: float = 2.0
    floor: float = 0.1
    loose: float = 1.5
    rate: float = 0.6
    nugget: float = 1e-6


@dataclass(frozen=True)
class Sample:
    """Training data: z (n, d) from the centre, values (n, m) standardised."""

    z: FloatArray
    values: FloatArray

    @property
    def spread(self) -> FloatArray:
        """(d,) mean squares of z; the mean over all for a variable that never moves."""
        square = (self.z**2).mean(axis=0)
        return np.asarray(np.where(square > 0.0, square, square.mean()))


def even_kernel(sample: Sample, learning: Learning) -> CovarianceKernel:
    """Every variable equally relevant, the linear part of variance 1, a small bend."""
    outputs = sample.values.shape[1]
    relevance = np.full((outputs, sample.spread.size), 1.0 / sample.spread.sum())
    one = np.ones(outputs)
    curvature = along(relevance, sample, learning)
    return CovarianceKernel(relevance, curvature, 0.1 * one, one, learning.nugget * one)


def pinned_kernel(slope: FloatArray, sample: Sample, learning: Learning) -> CovarianceKernel:
    """Bend alone, along the known slopes (m, d) of standardised outputs."""
    relevance = _shrunk(slope**2, sample, learning)
    one, zero = np.ones(len(slope)), np.zeros(len(slope))
    curvature = along(relevance, sample, learning)
    return CovarianceKernel(relevance, curvature, one, zero, learning.nugget * one, pinned=True)


def along(relevance: FloatArray, sample: Sample, learning: Learning) -> FloatArray:
    """(m, d) curvatures that follow the relevances: where the learning of curvatures starts from."""
    variance = (relevance * sample.spread).sum(axis=1, keepdims=True)
    curvature = relevance / (variance * learning.reach**2)
    return np.asarray(curvature + learning.floor * curvature.mean(axis=1, keepdims=True))


def learn(kernel: CovarianceKernel, sample: Sample, learning: Learning) -> CovarianceKernel:
    """Kernels learnt from the sample, starting from `kernel`."""
    departure = np.log(kernel.curvature / along(kernel.relevance, sample, learning))
    adam = _Adam(departure.shape)
    for step in range(learning.steps):
        total, curved = training_covariance(kernel, sample.z)
        inverse = inverses(total)
        alpha = (inverse @ sample.values.T[:, :, None])[:, :, 0]
        if step >= learning.wait:
            slope = _curvature_slope(kernel, sample.z, inverse, alpha, curved)
            departure = departure + adam.step(slope - departure / learning.loose**2, learning.rate)
        bend = _bend_variance(kernel.bend, inverse, alpha, curved)
        relevance = kernel.relevance
        if not kernel.pinned:
            relevance = _shrunk(_expected(kernel, sample.z, inverse, alpha), sample, learning)
        curvature = along(relevance, sample, learning) * np.exp(departure)
        kernel = replace(kernel, relevance=relevance, curvature=curvature, bend=bend)
    return kernel


class _Adam:
    """Step sizes from running means of the gradient and its square (Kingma & Ba, 2015), decay 0.7 and 0.9."""

    def __init__(self, shape: tuple[int, ...]) -> None:
        self.first, self.second, self.count = np.zeros(shape), np.zeros(shape), 0

    def step(self, slope: FloatArray, rate: float) -> FloatArray:
        self.count += 1
        self.first = 0.7 * self.first + 0.3 * slope
        self.second = 0.9 * self.second + 0.1 * slope**2
        first = self.first / (1.0 - 0.7**self.count)
        second = self.second / (1.0 - 0.9**self.count)
        return np.asarray(rate * first / (np.sqrt(second) + 0.1))


def _shrunk(squares: FloatArray, sample: Sample, learning: Learning) -> FloatArray:
    """(m, d) relevances between an output's own squared coefficients and their mean over all outputs."""
    shrunk = (squares + learning.shrink * squares.mean(axis=0)) / (1.0 + learning.shrink)
    return np.asarray(np.maximum(shrunk, LEAST_RELEVANCE / sample.spread.sum()))


def _expected(kernel: CovarianceKernel, z: FloatArray, inverse: FloatArray, alpha: FloatArray) -> FloatArray:
    """(m, d) expected squares of the linear coefficients."""
    w = kernel.relevance
    coefficient = w * (alpha @ z)
    return np.asarray(coefficient**2 + w - w**2 * ((inverse @ z) * z).sum(axis=1))


def _bend_variance(bend: FloatArray, inverse: FloatArray, alpha: FloatArray, curved: Bend) -> FloatArray:
    """(m,) fixed point of the likelihood's derivative by b, damped by the square root."""
    explained = np.maximum(((curved.value @ alpha[:, :, None])[:, :, 0] * alpha).sum(axis=1), 0.0)
    expected = (inverse * curved.value).sum(axis=(1, 2))
    return np.asarray(np.clip(bend * np.sqrt(explained / expected), *BEND_RANGE))


def _curvature_slope(
    kernel: CovarianceKernel, z: FloatArray, inverse: FloatArray, alpha: FloatArray, curved: Bend
) -> FloatArray:
    """(m, d) derivative of the log marginal likelihood by the logarithms of the curvatures, eq. 5.9."""
    push = 0.5 * kernel.bend[:, None, None] * (alpha[:, :, None] * alpha[:, None, :] - inverse)
    own = (push * curved.own).sum(axis=2) @ (z * z)
    other = (((push * curved.other) @ z) * z).sum(axis=1)
    return np.asarray((own + other) * kernel.curvature)
