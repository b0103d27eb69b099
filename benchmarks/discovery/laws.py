"""Bushing curves of another shape than a cubic: exponential, or a soft stop after free travel."""

from __future__ import annotations

from typing import Literal

import numpy as np

from doe_kc.ground.typing import FloatArray

Shape = Literal["exponential", "soft_stop"]
SHAPES: tuple[Shape, ...] = ("exponential", "soft_stop")
REFERENCE = 2.0
"""mm, deflection at which a shape holds the same force as the cubic it stands for."""
GROWTH = 2.0
"""mm over which the exponential grows by e."""
REACH, POINTS = 5.0, 21
"""mm either way, and number of points of a table; linear beyond."""


def table(stiffness: float, cubic: float, added: float, shape: Shape, free: float) -> list[list[float]]:
    """Points [d, F] in mm and N of k (d + b d^3) plus as much at REFERENCE as an added cubic would hold.

    stiffness: k in N/mm. cubic, added: b and what is added to it, 1/mm^2. free: mm before a stop touches.
    """
    d = np.linspace(-REACH, REACH, POINTS)
    force = stiffness * (d + cubic * d**3 + _excess(d, added * REFERENCE**3, shape, free))
    return [[float(x), round(float(f), 3)] for x, f in zip(d, force, strict=True)]


def _excess(d: FloatArray, at_reference: float, shape: Shape, free: float) -> FloatArray:
    if shape == "exponential":
        grown = np.expm1(np.abs(d) / GROWTH) - np.abs(d) / GROWTH
        full = np.expm1(REFERENCE / GROWTH) - REFERENCE / GROWTH
        return np.asarray(np.sign(d) * at_reference * grown / full)
    beyond = np.maximum(np.abs(d) - free, 0.0) / (REFERENCE - free)
    return np.asarray(np.sign(d) * at_reference * beyond**2)
