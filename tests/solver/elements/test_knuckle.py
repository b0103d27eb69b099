"""Knuckle, and the strut clamp between knuckle and tube."""

from __future__ import annotations

import numpy as np
import pytest

from doe_kc.solver.elements.knuckle import Knuckle, strut_axis
from tests.solver.elements.mini import SIDES, builder, gibbs, hardpoint, number, stub, turned

NM_PER_DEG = 1000 * 180 / np.pi


def assembled(**topology: object):
    b = builder(**topology)
    for side in SIDES:
        b.bodies[f"ball joint.{side}"] = stub(f"arm {side}", hardpoint("LWB", side), [0.0, 1.0, 20.0])
    Knuckle().assemble(b)
    return b


def test_the_strut_axis_is_a_unit_vector_from_damper_to_top_mount() -> None:
    b = assembled()
    for side in SIDES:
        along = hardpoint("UPB", side) - hardpoint("LWD", side)
        np.testing.assert_allclose(number(b, strut_axis(b, side)), along / np.linalg.norm(along))


def test_the_knuckle_hangs_on_the_ball_joint_which_carries_no_moment() -> None:
    b = assembled()
    joint = next(j for j in b.joints if j.label == "knuckle L")
    assert not joint.carries_moment
    np.testing.assert_allclose(number(b, joint.child.origin), hardpoint("LWB") + np.array([0, 1, 20]))
    assert b.bodies["tube.L"] is b.bodies["knuckle.L"]


@pytest.mark.parametrize("flexibility", [0.5, 1.0, 2.0])
def test_clamp_springs_bend_across_and_twist_along_the_damper(flexibility: float) -> None:
    b = assembled(strut_bending=True)
    axis = hardpoint("UPB") - hardpoint("LWD")
    axis /= np.linalg.norm(axis)
    across = np.cross(axis, [1.0, 0, 0])
    across /= np.linalg.norm(across)
    for direction, stiffness in ((axis, 30000.0), (across, 8000.0), (np.cross(axis, across), 8000.0)):
        phi = 0.003 * direction
        given = {f"tube L.{a}": v for a, v in zip(("rx", "ry", "rz"), gibbs(phi), strict=True)}
        given["strut.flexibility@L"] = flexibility
        joint = next(j for j in b.joints if j.label == "strut clamp L")
        moment = [number(b, b.resistances[f.name] / f.compliance, given) for f in joint.freedoms]
        np.testing.assert_allclose(moment, stiffness / flexibility * NM_PER_DEG * phi, rtol=1e-9, atol=1e-3)


def test_the_tube_turns_about_the_clamp() -> None:
    b = assembled(strut_bending=True)
    phi = [0.01, -0.02, 0.005]
    given = {f"tube L.{a}": v for a, v in zip(("rx", "ry", "rz"), gibbs(phi), strict=True)}
    given["strut.flexibility@L"] = 1.0
    clamp, seat = hardpoint("CLAMP"), hardpoint("LWS")
    expected = clamp + [0, 1, 20] + turned(phi) @ (seat - clamp)
    np.testing.assert_allclose(number(b, b.bodies["tube.L"].point(seat), given), expected)
