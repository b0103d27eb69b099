"""Yield displacements of elastic-slip elements."""

from __future__ import annotations

import numpy as np

from doe_kc.axle.sliders import iwan_yields


def test_yield_displacements_are_those_of_the_exponential_virgin_curve() -> None:
    """Equal-strength elements at mid-quantiles of the density y exp(-y)."""
    y = iwan_yields(4)
    np.testing.assert_allclose(1 - (1 + y) * np.exp(-y), (np.arange(4) + 0.5) / 4, rtol=1e-9)
