"""Bump and rebound stop along the strut."""

from __future__ import annotations

import casadi as ca
import numpy as np
import pytest
from scipy.interpolate import PchipInterpolator

from doe_kc.solver.elements.stops import stop_force
from tests.solver.elements.mini import builder, number

BUMP = np.array([[0, 0], [10, 300], [20, 800], [30, 1800], [40, 3800], [50, 7800], [60, 14000]])
REBOUND = np.array([[0, 0], [5, 1500], [10, 5000], [15, 11000], [20, 20000]])


def law(points: np.ndarray, travel: float) -> float:
    """PCHIP, linear beyond the last point, nothing before contact."""
    x = max(travel, 0.0)
    pchip = PchipInterpolator(points[:, 0], points[:, 1])
    last = points[-1, 0]
    inside = min(x, last)
    return float(pchip(inside) + pchip.derivative()(inside) * (x - inside))


def stops(slide: float, given: dict[str, float] | None = None, side: str = "L") -> float:
    """Bump less rebound stop, N."""
    b = builder()
    bump = stop_force(b, "bump_stop", 7, side, ca.SX(-slide))
    return float(number(b, bump - stop_force(b, "rebound_stop", 5, side, ca.SX(slide)), given))


@pytest.mark.parametrize("slide", [-95, -82, -70.3, -60, -33, -22.001, -22, -21, 0, 65, 65.5, 72, 84, 85, 92])
def test_the_force_is_the_curve_beyond_the_clearance(slide: float) -> None:
    bump, rebound = law(BUMP, -slide - 22.0), law(REBOUND, slide - 65.0)
    assert stops(slide) == pytest.approx(bump - rebound, abs=1e-9)


def test_bump_lengthens_and_rebound_shortens_the_strut() -> None:
    assert stops(-60.0) > 1000.0
    assert stops(80.0) < -1000.0


def test_clearance_and_factor_of_one_side() -> None:
    given = {"bump_stop.clearance@R": 30.0, "bump_stop.factor@R": 2.0}
    assert stops(-60.0, given, "R") == pytest.approx(2 * law(BUMP, 30.0))
    assert stops(-60.0, given, "L") == pytest.approx(law(BUMP, 38.0))


def test_a_negative_clearance_is_a_stop_in_contact_at_design() -> None:
    assert stops(0.0, {"bump_stop.clearance@L": -5.0}) == pytest.approx(law(BUMP, 5.0))
