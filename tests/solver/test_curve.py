"""Slopes of force curves: those of SciPy's monotone cubic, which is not imported for them."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.interpolate import PchipInterpolator

from doe_kc.axle.force_curve import pchip_slopes

RNG = np.random.default_rng(11)
DRAWN = [
    (np.cumsum(RNG.uniform(0.05, 4.0, n)) - 5.0, RNG.normal(size=n) * 10.0 ** RNG.integers(-2, 5))
    for n in (2, 3, 3, 4, 5, 8, 21)
    for _ in range(20)
]
"""Tables of forces at random, most of them with extrema."""
SHAPED = {
    "two points": ([-1.0, 3.0], [2.0, -7.0]),
    "straight": ([-2.0, 0.0, 1.0, 4.0], [-6.0, 0.0, 3.0, 12.0]),
    "flat part": ([-5.0, -2.0, 0.0, 2.0, 5.0], [-900.0, 0.0, 0.0, 0.0, 1200.0]),
    "constant": ([-1.0, 0.0, 2.0], [4.0, 4.0, 4.0]),
    "end against its neighbour": ([0.0, 1.0, 1.1, 3.0], [0.0, 0.1, 5.0, 4.0]),
    "end three times too steep": ([0.0, 1.0, 2.0, 3.0], [0.0, 1.0, -9.0, -9.5]),
    "bump stop": ([0.0, 20.0, 25.0, 28.0, 30.0], [0.0, 0.0, 150.0, 1400.0, 9000.0]),
}


def assert_scipys(x: np.ndarray, y: np.ndarray) -> None:
    np.testing.assert_array_equal(pchip_slopes(x, y), PchipInterpolator(x, y).derivative()(x))


@pytest.mark.parametrize("name", SHAPED)
def test_slopes_of_shaped_tables_are_those_of_scipy(name: str) -> None:
    x, y = (np.array(v) for v in SHAPED[name])
    assert_scipys(x, y)


def test_slopes_of_tables_at_random_are_those_of_scipy() -> None:
    for x, y in DRAWN:
        assert_scipys(x, y)
