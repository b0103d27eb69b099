"""Numbers of elastic-slip elements in parallel: how their yield distances are spread."""

from __future__ import annotations

from statistics import NormalDist

import numpy as np

from doe_kc.ground.typing import FloatArray

RUBBER_SLIDERS = 4
"""Elements along each axis of a bushing. Beside the best odd polynomial, with two free numbers, they differ
by 47 to 55 N rms from two published fits of a measured loop of 10 kN; three by 51 to 55, eight with a third
number by 10 to 39. Those fits differ by 77 N from each other and by 71 and 115 N from the record."""
BACKBONE_YIELDS = (0.2, 0.45, 0.7, 1.0, 1.4, 2.2, 5.0)
"""Yield displacements of the sliders of a free backbone, over the presliding distance: closest about it. The
best shares meet exponential, log-normal, Berg's, tanh, arctan and Duhem's backbones over five distances
within 0.3 % rms of the limit; five sliders, in ratios of 2.5, within 1.2 %."""


IWAN_ELEMENTS = 8
"""Elements of a dry friction whose strengths are alike."""


def iwan_yields(count: int = IWAN_ELEMENTS) -> FloatArray:
    """(count,) yield displacements over limit / initial stiffness of elements of equal strength whose virgin
    curve is nearly exponential: mid-quantiles of a gamma law of shape 2."""
    from scipy.special import gammaincinv

    return np.asarray(gammaincinv(2.0, (np.arange(count) + 0.5) / count))


def normal_quantiles(count: int) -> FloatArray:
    """(count,) mid-quantiles of the standard normal distribution."""
    return np.array([NormalDist().inv_cdf((i + 0.5) / count) for i in range(count)])


def yield_ratios(spread: float, count: int = RUBBER_SLIDERS) -> FloatArray:
    """(count,) log-normal yield displacements of elements of equal strength, over limit / initial stiffness.

    spread: standard deviation of their logarithm, >= 0; 0 is one elastic-perfectly plastic element.
    """
    quantiles = spread * normal_quantiles(count)
    return np.asarray(np.exp(quantiles) * np.exp(-quantiles).mean())
