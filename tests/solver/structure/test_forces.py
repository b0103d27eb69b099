"""Spring and damper of a structure: the coil spring between tube and body, stops along the strut's slide."""

from __future__ import annotations

import casadi as ca
import numpy as np
import pytest

from doe_kc.axle.structure import CHASSIS
from doe_kc.solver.builder import Builder
from doe_kc.solver.structure.forces import add_damper, add_springs
from tests.solver.elements.mini import MIRROR, SIDES, builder, hardpoint, number, stub, wrench


def assembled(shift: object, **bodies: object):
    b = builder()
    for side in SIDES:
        s = np.asarray(shift, dtype=float)
        b.bodies[f"tube.{side}"] = stub(f"tube {side}", shift=s if side == "L" else MIRROR @ s)
    b.bodies[CHASSIS] = stub(CHASSIS)
    add_springs(b, b.topology.structure)
    return b


@pytest.mark.parametrize("shift", [[0, 0, 0], [3.0, -5.0, 40.0], [0, 10.0, -60.0]])
def test_force_is_preload_less_rate_times_lengthening_along_the_axis(shift: list[float]) -> None:
    b = assembled(shift)
    upper, lower = hardpoint("UPS"), hardpoint("LWS")
    seat = lower + shift
    length, design = np.linalg.norm(upper - seat), np.linalg.norm(upper - lower)
    expected = 4000.0 - 28.0 * (length - design)
    given = {"preload": 4000.0}
    assert number(b, b.points["spring.L"], given) == pytest.approx(expected)
    force, moment = wrench(b, "tube L", given)
    # compression pushes the seat away from the body
    np.testing.assert_allclose(force, expected * (seat - upper) / length)
    np.testing.assert_allclose(moment, np.cross(seat - shift, force))


def test_the_right_side_is_the_mirror_image() -> None:
    b = assembled([3.0, -5.0, 40.0])
    left, right = (wrench(b, f"tube {s}", {"preload": 4000.0})[0] for s in SIDES)
    np.testing.assert_allclose(right, MIRROR @ left)


def test_each_side_has_its_own_rate() -> None:
    b = assembled([0, 0, 10.0])
    left, right = (number(b, b.points[f"spring.{s}"], {"spring.rate@R": 56.0}) for s in SIDES)
    assert right == pytest.approx(2 * left)


def damped(slide: float) -> Builder:
    b = builder()
    for side in SIDES:
        b.points[f"slide strut.{side}"] = ca.SX(slide)
    add_damper(b, b.topology.structure)
    return b


@pytest.mark.parametrize(("slide", "stop"), [(-52.0, 1800.0), (75.0, -5000.0), (0.0, 0.0)])
def test_bump_lengthens_and_rebound_shortens_the_strut(slide: float, stop: float) -> None:
    b = damped(slide)
    assert number(b, b.points["stop.L"]) == pytest.approx(stop)
    assert number(b, b.resistances["strut slide L"]) == pytest.approx(-stop)
    assert number(b, b.points["shortening.L"]) == -slide


def test_gas_force_extends() -> None:
    b = damped(0.0)
    assert number(b, b.points["stop.L"]) == 0.0
    given = {"damper.gas_force@L": 150.0}
    assert number(b, b.resistances["strut slide L"], given) == pytest.approx(-150.0)
