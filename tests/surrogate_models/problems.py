"""Small problems with known answers."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.stats import qmc

from doe_kc.ground.typing import FloatArray

VARIABLES = 5


@dataclass(frozen=True)
class Problem:
    """x: (n, d) designs, y: (n, m) outputs, test: (p, d) points between them."""

    x: FloatArray
    y: FloatArray
    test: FloatArray


def outputs(x: FloatArray) -> FloatArray:
    """(n, 3): a wave and an interaction, a bent plane, a plane of another size."""
    wave = np.sin(4.0 * x[:, 0]) + 2.0 * x[:, 1] * x[:, 2]
    bent = 3.0 * x[:, 0] - x[:, 3] + 0.6 * (x[:, 1] - 0.4) ** 2
    plane = 1e3 * (5.0 + x @ np.arange(1.0, VARIABLES + 1.0) + 0.02 * np.cos(5.0 * x[:, 4]))
    return np.column_stack([wave, bent, plane])


def points(n: int, seed: int, variables: int = VARIABLES) -> FloatArray:
    return np.asarray(qmc.LatinHypercube(variables, rng=np.random.default_rng(seed)).random(n))


def problem(n: int = 40, seed: int = 1) -> Problem:
    x = points(n, seed)
    return Problem(x, outputs(x), 0.05 + 0.9 * points(6, seed + 100))


def differences(function, x: FloatArray, step: float) -> FloatArray:  # type: ignore[no-untyped-def]
    """(p, m, d) differences of fourth order of a function (p, d) -> (p, m)."""

    def slope(e: FloatArray) -> FloatArray:
        near, far = function(x + e) - function(x - e), function(x + 2.0 * e) - function(x - 2.0 * e)
        return np.asarray((8.0 * near - far) / (12.0 * step))

    return np.stack([slope(e) for e in step * np.eye(x.shape[1])], axis=-1)
