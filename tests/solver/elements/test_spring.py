"""Coil spring between tube and body."""

from __future__ import annotations

import numpy as np
import pytest

from doe_kc.solver.elements.spring import CoilSpring
from tests.solver.elements.mini import MIRROR, SIDES, builder, hardpoint, number, stub, wrench


def assembled(shift: object, **bodies: object):
    b = builder()
    for side in SIDES:
        s = np.asarray(shift, dtype=float)
        b.bodies[f"tube.{side}"] = stub(f"tube {side}", shift=s if side == "L" else MIRROR @ s)
    CoilSpring().assemble(b)
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
