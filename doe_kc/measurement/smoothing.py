"""Local quadratic regression: a noisy branch read at given inputs, linear in its samples."""

from __future__ import annotations

import numpy as np

from doe_kc.ground.typing import FloatArray

DEGREE = 2
MIN_NEIGHBOURS = 7


def local_weights(samples: FloatArray, grid: FloatArray, half_width: float) -> FloatArray:
    """(n, m) matrix S with S y = local quadratic fit to the samples (x, y), read at the n grid inputs.

    samples: (m,) inputs x in any order; grid: (n,); half_width: support of the tricube kernel, input
    unit, widened where it holds fewer than 7 samples. Exact on quadratics, for interior points on cubics
    too: no bias up to third order, and kinks are rounded over one half-width only.
    A rank-deficient neighbourhood takes the pseudo-inverse.
    Source: Cleveland, JASA 74 (1979) 829; Fan & Gijbels, Local Polynomial Modelling (1996).
    """
    distance = samples[None, :] - grid[:, None]
    nearest = np.sort(np.abs(distance), axis=1)[:, min(MIN_NEIGHBOURS, samples.size) - 1]
    width = np.maximum(half_width, 1.05 * nearest)[:, None]
    scaled = distance / width
    size = np.minimum(np.abs(scaled), 1.0)
    inside = 1.0 - size * size * size
    weighted = [inside * inside * inside]
    while len(weighted) <= 2 * DEGREE:
        weighted.append(weighted[-1] * scaled)
    sums = np.array([w.sum(axis=1) for w in weighted])
    order = np.arange(DEGREE + 1)
    moments = sums[order[:, None] + order].transpose(2, 0, 1)
    first = np.linalg.pinv(moments, hermitian=True)[:, 0, :]
    return np.asarray(sum(first[:, i, None] * weighted[i] for i in order))
