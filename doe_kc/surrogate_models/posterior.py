"""Gaussian process regression of many outputs with given kernels: mean, variance, gradients, left-out rows.

Reference: C. E. Rasmussen, C. K. I. Williams, Gaussian Processes for Machine Learning, 2006, eq. 2.25, 2.26,
2.30 and 5.10-5.12 (leave-one-out).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from doe_kc.ground.typing import FloatArray
from doe_kc.surrogate_models.cholesky import inverse_roots
from doe_kc.surrogate_models.kernel import (
    COVARIANCE_BLOCK,
    Bend,
    CovarianceKernel,
    bend,
    bend_at_itself,
    bend_value,
    covariance,
    training_covariance,
)


@dataclass(frozen=True)
class ProcessPosterior:
    """m kernels conditioned on n rows of standardised outputs; points z are measured from the centre.

    z: (n, d). root: (m, n, n) inverse of the covariance's lower Cholesky factor. alpha: (m, n) inverse
    covariance times the values. slope: (m, d) of the linear part. evidence: (m,) log marginal likelihood.
    """

    kernel: CovarianceKernel
    z: FloatArray
    root: FloatArray
    alpha: FloatArray
    slope: FloatArray
    evidence: FloatArray

    def of(self, outputs: np.ndarray) -> ProcessPosterior:
        """Those of some outputs: places (k,)."""
        own = (a[outputs] for a in (self.root, self.alpha, self.slope, self.evidence))
        return ProcessPosterior(self.kernel.of(outputs), self.z, *own)


@dataclass(frozen=True)
class Cross:
    """Covariances of p points z (p, d) with the training rows, what all predictions are made of.

    total: (m, p, n). curved: the bend alone, of variance 1.
    """

    z: FloatArray
    total: FloatArray
    curved: Bend

    def white(self, p: ProcessPosterior) -> FloatArray:
        """(m, p, n) root times the covariances: their squares are the variance that the rows explain."""
        return np.asarray(self.total @ p.root.transpose(0, 2, 1))


def condition(kernel: CovarianceKernel, z: FloatArray, values: FloatArray) -> ProcessPosterior:
    """Posterior of z (n, d), values (n, m); RunError when a covariance cannot be factorised."""
    total, _ = training_covariance(kernel, z)
    root = inverse_roots(total)
    white = (root @ values.T[:, :, None])[:, :, 0]
    alpha = (root.transpose(0, 2, 1) @ white[:, :, None])[:, :, 0]
    half_log = -np.log(np.einsum("jii->ji", root)).sum(axis=1)
    evidence = -0.5 * (white**2).sum(axis=1) - half_log - 0.5 * len(z) * np.log(2.0 * np.pi)
    slope = np.zeros_like(kernel.relevance) if kernel.pinned else kernel.relevance * (alpha @ z)
    return ProcessPosterior(kernel, z, root, alpha, slope, evidence)


def cross(p: ProcessPosterior, z: FloatArray) -> Cross:
    """Covariances of points z (p, d)."""
    curved = bend(p.kernel, z, p.z)
    return Cross(z, covariance(p.kernel, z, p.z, curved), curved)


def mean(p: ProcessPosterior, c: Cross) -> FloatArray:
    """(p, m), eq. 2.25."""
    return np.asarray((c.total @ p.alpha[:, :, None])[:, :, 0].T)


def mean_alone(p: ProcessPosterior, z: FloatArray) -> FloatArray:
    """`mean` of points z (p, d) without their `Cross`, in blocks that stay in a core's own memory: a fifth of
    its time."""
    k = p.kernel
    level = k.constant * p.alpha.sum(axis=1)
    out = np.asarray(z @ p.slope.T + level)
    several = max(1, COVARIANCE_BLOCK // len(p.z))
    for j, (curvature, variance, alpha) in enumerate(zip(k.curvature, k.bend, p.alpha, strict=True)):
        weighted = (p.z * curvature).T
        itself, other = (z * z) @ curvature, (p.z * p.z) @ curvature
        for first in range(0, len(z), several):
            rows = slice(first, first + several)
            shape = bend_value(k, z[rows] @ weighted, itself[rows, None], other)
            out[rows, j] += variance * (shape @ alpha)
    return out


def mean_gradient(p: ProcessPosterior, c: Cross) -> FloatArray:
    """(p, m, d)."""
    return np.asarray((p.slope[:, None] + _bent(p, c, p.alpha[:, None])).transpose(1, 0, 2))


def variance(p: ProcessPosterior, c: Cross, white: FloatArray) -> FloatArray:
    """(p, m), eq. 2.26, of the function, that is without the nugget; white: of `c`."""
    k = p.kernel
    itself, _ = bend_at_itself(k, c.z)
    prior = k.bend[:, None] * itself + k.constant[:, None]
    if not k.pinned:
        prior = prior + k.relevance @ (c.z * c.z).T
    return np.asarray(np.maximum(prior - (white**2).sum(axis=2), 0.0).T)


def variance_gradient(p: ProcessPosterior, c: Cross, white: FloatArray) -> FloatArray:
    """(p, m, d); white: of `c`."""
    k, solved = p.kernel, white @ p.root
    _, factor = bend_at_itself(k, c.z)
    prior = (k.bend[:, None] * factor)[:, :, None] * k.curvature[:, None] * c.z[None]
    known = _bent(p, c, solved)
    if not k.pinned:
        prior = prior + 2.0 * k.relevance[:, None] * c.z[None]
        known = known + k.relevance[:, None] * (solved @ p.z)
    return np.asarray((prior - 2.0 * known).transpose(1, 0, 2))


def _bent(p: ProcessPosterior, c: Cross, by: FloatArray) -> FloatArray:
    """(m, p, d) sum over the training rows of `by` (m, p or 1, n) times the bend's derivative."""
    own = (c.curved.own * by).sum(axis=2)[:, :, None] * c.z[None]
    scale = p.kernel.bend[:, None] * p.kernel.curvature
    return np.asarray((own + (c.curved.other * by) @ p.z) * scale[:, None])


def left_out(p: ProcessPosterior) -> tuple[FloatArray, FloatArray]:
    """Residuals (n, m) and variances (n, m) of rows left out with the kernels held, eq. 5.10-5.12."""
    diagonal = (p.root**2).sum(axis=1)
    return (p.alpha / diagonal).T, (1.0 / diagonal).T
