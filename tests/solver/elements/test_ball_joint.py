"""Lower ball joint: part of the rigid arm, or a ball on a spring equal in all directions."""

from __future__ import annotations

import numpy as np
import pytest

from doe_kc.solver.elements.ball_joint import BallJoint
from tests.solver.elements.mini import SIDES, builder, hardpoint, number, stub, turned

PHI = [0.1, -0.2, 0.3]


def assembled(**topology: object):
    b = builder(**topology)
    for side in SIDES:
        b.bodies[f"arm.{side}"] = stub(f"arm {side}", hardpoint("LWB", side), [0.0, 1.0, 20.0], PHI)
    BallJoint().assemble(b)
    return b


def test_a_rigid_ball_joint_is_the_arm() -> None:
    b = assembled()
    assert b.bodies["ball joint.L"] is b.bodies["arm.L"]
    assert b.joints == []


@pytest.mark.parametrize("side", SIDES)
def test_the_ball_yields_in_the_arm_s_axes(side: str) -> None:
    b = assembled(ball_joint=True)
    d = np.array([0.1, -0.3, 0.2])
    given = {f"ball joint {side}.{a}": v for a, v in zip("xyz", d, strict=True)}
    given |= {"ball_joint.rate@L": 12000.0, "ball_joint.rate@R": 12000.0}
    found = [number(b, b.resistances[f"ball joint {side}.{a}"], given) for a in "xyz"]
    np.testing.assert_allclose(found, 12000.0 * d)
    expected = hardpoint("LWB", side) + [0.0, 1.0, 20.0] + turned(PHI) @ d
    np.testing.assert_allclose(number(b, b.bodies[f"ball joint.{side}"].origin, given), expected)
    np.testing.assert_allclose(number(b, b.bodies[f"ball joint.{side}"].axes, given), turned(PHI), atol=1e-12)
