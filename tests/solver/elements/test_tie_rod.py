"""Tie rod: ideal length, or free play in its ball joint."""

from __future__ import annotations

import casadi as ca
import numpy as np
import pytest
from scipy.optimize import brentq

from doe_kc.solver.elements.tie_rod import add_rod, free_play_force
from tests.solver.elements.mini import MIRROR, SIDES, builder, hardpoint, number, stub, wrench


def assembled(shift: object, **topology: object):
    b = builder(**topology)
    rack, plays = (stub("rack"), "RIB"), {"L": b.topology.free_play_left, "R": b.topology.free_play_right}
    for side in SIDES:
        s = np.asarray(shift, dtype=float)
        arm = stub(f"arm {side}", shift=s if side == "L" else MIRROR @ s)
        add_rod(b, "tie_rod", side, rack, (arm, "ROB"), plays=plays[side])
    return b


def force(dl: float, gap: float, contact: float = 20000.0, compliance: float = 0.0) -> float:
    law = free_play_force(*(ca.SX(v) for v in (dl, gap, contact, compliance)))
    return float(ca.DM(ca.Function("f", [], [law])()["o0"]))


@pytest.mark.parametrize(
    ("dl", "gap"), [(0.0, 0.2), (0.05, 0.2), (-0.08, 0.2), (0.3, 0.2), (-0.5, 0.1), (0.1, 0.2)]
)
def test_free_play_law(dl: float, gap: float) -> None:
    def ramp(x: float) -> float:
        return (x + np.hypot(x, 2e-3)) / 2

    expected = 20.0 * dl + 20000.0 * (ramp(dl - gap / 2) - ramp(-dl - gap / 2))
    assert force(dl, gap) == pytest.approx(expected, abs=1e-9)


def test_free_play_is_odd_soft_inside_and_stiff_outside() -> None:
    assert force(0.0, 0.2) == pytest.approx(0.0, abs=1e-12)
    assert force(-0.3, 0.2) == pytest.approx(-force(0.3, 0.2))
    assert abs(force(0.05, 0.2)) < 2.0
    assert (force(0.41, 0.2) - force(0.4, 0.2)) / 0.01 == pytest.approx(20020.0, rel=1e-3)


def test_a_rigid_rod_is_a_constraint_on_its_length() -> None:
    shift = np.array([4.0, -3.0, 20.0])
    b = assembled(shift)
    (unknown, _, violation) = b.multipliers[0]
    design = hardpoint("ROB") - hardpoint("RIB")
    expected = np.linalg.norm(design + shift) - np.linalg.norm(design)
    assert unknown.name == "tie rod L"
    assert number(b, violation) == pytest.approx(expected)


def test_tension_pulls_both_ends_together() -> None:
    shift = np.array([4.0, -3.0, 20.0])
    b = assembled(shift)
    given = {"tie rod L": 700.0}
    along = hardpoint("ROB") + shift - hardpoint("RIB")
    along /= np.linalg.norm(along)
    on_arm, moment = wrench(b, "arm L", given)
    on_rack, _ = wrench(b, "rack", given)
    np.testing.assert_allclose(on_rack, 700.0 * along)
    np.testing.assert_allclose(on_arm, -on_rack)
    np.testing.assert_allclose(moment, np.cross(hardpoint("ROB"), on_arm))


def test_free_play_of_one_side_leaves_the_other_rigid() -> None:
    b = assembled([0.0, -0.3, 0.0], free_play_left=True)
    assert [u.name for u, _, _ in b.multipliers] == ["tie rod R"]
    design = hardpoint("ROB") - hardpoint("RIB")
    dl = np.linalg.norm(design + np.array([0, -0.3, 0])) - np.linalg.norm(design)
    tension = number(b, b.points["tie rod.L"], {"tie_rod.gap@L": 0.2, "tie_rod.contact@L": 20000.0})
    assert tension == pytest.approx(force(dl, 0.2))


def test_a_compliant_rod_lengthens_by_its_tension() -> None:
    b = assembled([4.0, -3.0, 20.0])
    (_, _, violation) = b.multipliers[0]
    given = {"tie rod L": 3000.0}
    rigid = number(b, violation, given)
    compliant = number(b, violation, given | {"tie_rod.flexibility@L": 1 / 15000.0})
    assert rigid - compliant == pytest.approx(0.2)


@pytest.mark.parametrize("tension", [-3000.0, -700.0, 400.0, 5000.0])
def test_free_play_in_series_with_a_compliant_rod(tension: float) -> None:
    """Lengthenings add up; the rounded corners alone, 40 N of force, are not exactly in series."""
    gap, contact, compliance = 0.2, 20000.0, 1 / 15000.0
    joint = brentq(lambda d: force(d, gap) - tension, -2.0, 2.0, xtol=1e-14)
    whole = brentq(lambda d: force(d, gap, contact, compliance) - tension, -2.0, 2.0, xtol=1e-14)
    assert whole == pytest.approx(joint + compliance * tension, abs=1e-4)


def test_a_tight_stiff_ball_is_rigid() -> None:
    assert force(1e-4, 2e-5, contact=2e8) == pytest.approx(1e-4 * 2e8, rel=0.11)
