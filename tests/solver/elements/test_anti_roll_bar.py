"""Anti-roll bar: a vertical couple by the relative drop-link travel, fourth power of the radius."""

from __future__ import annotations

import numpy as np
import pytest

from doe_kc.solver.elements.anti_roll_bar import add_anti_roll_bar
from tests.solver.elements.mini import builder, hardpoint, stub, wrench


def forces(left: float, right: float, given: dict[str, float] | None = None):
    b = builder()
    tubes = stub("tube L", shift=[1.0, 0.0, left]), stub("tube R", shift=[0.0, 2.0, right])
    add_anti_roll_bar(b, tubes, "ARB")
    return wrench(b, "tube L", given), wrench(b, "tube R", given)


def test_the_pair_of_forces() -> None:
    (left, moment), (right, _) = forces(12.0, -8.0)
    np.testing.assert_allclose(left, [0, 0, -22.0 * 20.0])
    np.testing.assert_allclose(right, [0, 0, 22.0 * 20.0])
    at = hardpoint("ARB") + np.array([1.0, 0.0, 12.0])
    np.testing.assert_allclose(moment, np.cross(at - [1.0, 0.0, 12.0], left))


def test_parallel_travel_is_free() -> None:
    (left, _), (right, _) = forces(30.0, 30.0)
    np.testing.assert_allclose([left, right], 0, atol=1e-12)


@pytest.mark.parametrize("radius", [8.0, 10.0, 13.5])
def test_the_rate_is_g_pi_r4_over_2_l_a2(radius: float) -> None:
    modulus, length = 79300.0, 900.0
    lever2 = modulus * np.pi * 11.5**4 / (2 * length * 22.0)
    assert np.sqrt(lever2) == pytest.approx(331.7, abs=0.1)
    rate = modulus * np.pi * radius**4 / (2 * length * lever2)
    (left, _), _ = forces(1.0, 0.0, {"arb.radius": radius})
    assert -left[2] == pytest.approx(rate)


def test_the_drop_links_are_in_series_with_the_bar() -> None:
    (left, _), _ = forces(1.0, 0.0, {"arb.link_flexibility": 1 / 300.0})
    assert -left[2] == pytest.approx(1 / (1 / 22.0 + 2 / 300.0))


def test_different_design_heights_give_no_preload() -> None:
    """Links are assembled to length: 4 mm between the sides were 88 N of preload."""
    higher = {"ARB.z@R": hardpoint("ARB")[2] + 4.0}
    (left, _), (right, _) = forces(0.0, 0.0, higher)
    np.testing.assert_allclose([left, right], 0, atol=1e-9)
    (left, _), _ = forces(12.0, -8.0, higher)
    np.testing.assert_allclose(left, [0, 0, -22.0 * 20.0])
