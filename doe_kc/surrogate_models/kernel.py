"""Covariance of the `gp` surrogate, one kernel an output: a linear trend and a smooth bend of it.

k(x, x') = c + z'Wz + b E(x, x') + nugget [x = x'],  z = x - centre,  W, V diagonal
E = exp(r - (q + q') / 2) with r = z'Vz', q = z'Vz: the squared exponential of length-scales 1 / sqrt(V).
Where value and slope at the centre are known ("pinned"), E is that kernel conditioned on both being zero
there: exp(-(q + q') / 2) (exp(r) - 1 - r), and W = c = 0.
Where it is "matern", E = (1 + s + s² / 3) exp(-s) with s = sqrt(5 (q + q' - 2 r)): Matérn's, 5/2.
Reference: C. E. Rasmussen, C. K. I. Williams, Gaussian Processes for Machine Learning, 2006, eq. 4.17, 9.4.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from doe_kc.ground.typing import FloatArray

COVARIANCE_BLOCK = 40_000
"""Covariances that are worked on at once: what stays in a core's own memory."""


@dataclass(frozen=True)
class CovarianceKernel:
    """m kernels over d variables of standardised outputs.

    relevance: (m, d) diagonal of W, the variance of each linear coefficient. curvature: (m, d) diagonal of V,
    inverse squared length-scales. bend, constant, nugget: (m,) variances b, c and of the training rows.
    pinned, matern: which E it is; not both.
    """

    relevance: FloatArray
    curvature: FloatArray
    bend: FloatArray
    constant: FloatArray
    nugget: FloatArray
    pinned: bool = False
    matern: bool = False

    def of(self, outputs: np.ndarray) -> CovarianceKernel:
        """Those of some outputs: places (k,)."""
        return replace(
            self,
            relevance=self.relevance[outputs],
            curvature=self.curvature[outputs],
            bend=self.bend[outputs],
            constant=self.constant[outputs],
            nugget=self.nugget[outputs],
        )

    def scaled(self, factor: FloatArray) -> CovarianceKernel:
        """The same functions, of outputs with variances times `factor` (m,); the nugget stays."""
        return replace(
            self,
            relevance=self.relevance * factor[:, None],
            bend=self.bend * factor,
            constant=self.constant * factor,
        )


@dataclass(frozen=True)
class Bend:
    """E (m, p, n) and what its derivatives are made of.

    dE/dz = own V z + other V z' and dE/dV = own (z² + z'²) / 2 + other z z', per variable.
    """

    value: FloatArray
    own: FloatArray
    other: FloatArray


def weighted_inner(weights: FloatArray, z: FloatArray, other: FloatArray) -> FloatArray:
    """(m, p, n) inner products of points (p, d) and (n, d) under each row of weights (m, d)."""
    return np.asarray((z[None] * weights[:, None]) @ other.T)


def bend(kernel: CovarianceKernel, z: FloatArray, other: FloatArray) -> Bend:
    """E of points (p, d) and (n, d)."""
    square = kernel.curvature @ (z * z).T
    other_square = kernel.curvature @ (other * other).T
    inner = weighted_inner(kernel.curvature, z, other)
    half = -0.5 * (square[:, :, None] + other_square[:, None, :])
    if kernel.matern:
        value, slope = matern(np.maximum(-2.0 * (half + inner), 0.0))
        return Bend(value, 2.0 * slope, -2.0 * slope)
    full = np.exp(np.minimum(half + inner, 0.0))
    if not kernel.pinned:
        return Bend(full, -full, full)
    damping = np.exp(half)
    value = full - damping * (1.0 + inner)
    return Bend(value, -value, full - damping)


def bend_value(
    kernel: CovarianceKernel, inner: FloatArray, square: FloatArray, other_square: FloatArray
) -> FloatArray:
    """E (p, n) of one output from the inner products under V: of points with rows (p, n), of points with
    themselves (p, 1), of rows with themselves (n,)."""
    both = square + other_square
    if kernel.matern:
        return matern(np.maximum(both - 2.0 * inner, 0.0))[0]
    full = np.exp(np.minimum(inner - 0.5 * both, 0.0))
    return full - np.exp(-0.5 * both) * (1.0 + inner) if kernel.pinned else full


def matern(square: FloatArray) -> tuple[FloatArray, FloatArray]:
    """E of squared distances q in length-scales, and dE/dq = -5/6 (1 + s) exp(-s)."""
    distance = np.sqrt(5.0 * square)
    decay = np.exp(-distance)
    slope = (-5.0 / 6.0) * (1.0 + distance) * decay
    return decay * (1.0 + distance + distance * distance / 3.0), slope


def bend_at_itself(kernel: CovarianceKernel, z: FloatArray) -> tuple[FloatArray, FloatArray]:
    """E(x, x) (m, p) of points (p, d), and f (m, p) with dE(x, x)/dz = f V z."""
    square = kernel.curvature @ (z * z).T
    if not kernel.pinned:
        return np.ones_like(square), np.zeros_like(square)
    damping = np.exp(-square)
    return 1.0 - (1.0 + square) * damping, 2.0 * square * damping


def covariance(kernel: CovarianceKernel, z: FloatArray, other: FloatArray, curved: Bend) -> FloatArray:
    """(m, p, n) of points (p, d) and (n, d) without the nugget; curved: their `bend`."""
    linear = 0.0 if kernel.pinned else weighted_inner(kernel.relevance, z, other)
    return np.asarray(linear + kernel.bend[:, None, None] * curved.value + kernel.constant[:, None, None])


def training_covariance(kernel: CovarianceKernel, z: FloatArray) -> tuple[FloatArray, Bend]:
    """(m, n, n) of the training rows (n, d) with the nugget, and their bend."""
    curved = bend(kernel, z, z)
    total = covariance(kernel, z, z, curved)
    total[:, np.arange(len(z)), np.arange(len(z))] += kernel.nugget[:, None]
    return total, curved
