"""Lower arm: six freedoms, on two bushings whose axes ride on the sub-frame."""

from __future__ import annotations

import numpy as np

from doe_kc.solver.elements.lower_arm import LowerArm
from tests.solver.elements.mini import SIDES, about_origin, builder, hardpoint, stub, turned, wrench

FRAME = np.array([180.0, 0.0, 247.5])
LOCAL = {"llf": np.array([10000.0, 2000.0, 10000.0]), "llr": np.array([1500.0, 600.0, 1500.0])}
LINEAR = {f"llr.cubic.F{a}@{s}": 0.0 for a in "xyz" for s in SIDES}


def assembled(rotation: object = (0.0, 0.0, 0.0)):
    b = builder()
    frame = stub("frame", FRAME, rotation=rotation)
    for side in SIDES:
        b.bodies[f"subframe.{side}"] = frame
    LowerArm().assemble(b)
    return b


def test_six_freedoms_about_the_ball_joint() -> None:
    b = assembled()
    joint = b.joints[0]
    assert len(joint.freedoms) == 6
    assert joint.parent is None
    np.testing.assert_allclose(np.array(hardpoint("LWB")), np.array([-8.0, -748.0, 205.0]))


def test_a_shift_meets_local_x_as_minus_y_and_local_y_as_x() -> None:
    shift = {"lower arm L.x": 0.1, "lower arm L.y": 0.2, "lower arm L.z": -0.05}
    force, moment = wrench(assembled(), "lower arm L", LINEAR | shift)
    expected, turning = np.zeros(3), np.zeros(3)
    for name, k in LOCAL.items():
        f = -k[[1, 0, 2]] * [0.1, 0.2, -0.05]
        expected += f
        point = hardpoint(name.upper()) + np.array([0.1, 0.2, -0.05])
        turning += np.cross(point - (hardpoint("LWB") + np.array([0.1, 0.2, -0.05])), f)
    np.testing.assert_allclose(force, expected)
    np.testing.assert_allclose(moment, turning)


def test_axes_ride_on_the_sub_frame_and_the_pair_balances() -> None:
    phi = [0.05, -0.1, 0.2]
    b = assembled(phi)
    r = turned(phi)
    given = LINEAR | {"lower arm L.x": 0.3}
    on_arm, on_frame = wrench(b, "lower arm L", given), np.zeros((2, 3))
    expected = np.zeros(3)
    for name, k in LOCAL.items():
        point = hardpoint(name.upper())
        apart = point + np.array([0.3, 0, 0]) - (FRAME + r @ (point - FRAME))
        expected += -r @ (k[[1, 0, 2]] * (r.T @ apart))
    np.testing.assert_allclose(on_arm[0], expected)
    # the right arm is at its design place: sum over the three bodies
    force, moment = on_frame
    for name, origin in (
        ("frame", FRAME),
        ("lower arm L", hardpoint("LWB") + np.array([0.3, 0, 0])),
        ("lower arm R", hardpoint("LWB", "R")),
    ):
        f, m = wrench(b, name, given)
        force, moment = force + f, moment + about_origin(origin, f, m)
    np.testing.assert_allclose(force, 0, atol=1e-7)
    np.testing.assert_allclose(moment, 0, atol=1e-4)


def test_a_preload_pushes_along_the_local_axes() -> None:
    """Local x = -Y, local y = +X; f0 loads the inner part, the arm feels the opposite."""
    given = {"llr.preload.Fx@L": 100.0, "llr.preload.Fy@L": 600.0}
    force, _ = wrench(assembled(), "lower arm L", given)
    np.testing.assert_allclose(force, [-600.0, 100.0, 0.0], atol=1e-9)
