"""Sub-frame of a structure: one body, or halves sprung to a centre part."""

from __future__ import annotations

import casadi as ca
import numpy as np
import pytest

from doe_kc.effects.subframe_flexibility import JOINT_STIFFNESS
from doe_kc.solver.elements.subframe import flexible_joint, free_body
from tests.solver.elements.mini import (
    about_origin,
    builder,
    gibbs,
    hardpoint,
    number,
    stub,
    turned,
    whole,
    wrench,
)

NM_PER_DEG = 1000 * 180 / np.pi
CENTRE = np.array([180.0, 0.0, 247.5])
NO_ARMS = {f"{n}.{k}{a}@{s}": 0.0 for n in ("llf", "llr") for k in "FT" for a in "xyz" for s in "LR"}
"""Lower arms that hold nothing: the sub-frame by itself."""
FLEXIBLE = NO_ARMS | {f"subframe.{k}": v for k, v in JOINT_STIFFNESS.items()}


def test_a_free_body_stands_where_its_six_freedoms_say() -> None:
    b = builder()
    frame = free_body(b, "frame", ca.SX(CENTRE))
    given = {"frame.x": 1.0, "frame.z": -2.0} | dict(zip(("frame.rx",), gibbs([0.1, 0, 0])[:1], strict=True))
    assert len(b.joints[0].freedoms) == 6 and b.joints[0].parent is None
    expected = CENTRE + [1.0, 0.0, -2.0] + turned([0.1, 0, 0]) @ [0.0, 50.0, 0.0]
    np.testing.assert_allclose(
        number(b, frame.point(ca.SX(CENTRE + np.array([0.0, 50.0, 0.0]))), given), expected
    )


def test_the_springs_of_a_joint_ride_on_its_inner_part() -> None:
    b, phi = builder(), [0.1, -0.2, 0.3]
    inner, outer = stub("inner", CENTRE, rotation=phi), stub("outer", CENTRE, [0.1, 0.2, -0.3], phi)
    flexible_joint(b, inner, outer, ca.SX(CENTRE))
    force, moment = wrench(b, "outer", FLEXIBLE)
    k, r = np.array([80000.0, 80000.0, 40000.0]), turned(phi)
    np.testing.assert_allclose(force, -r @ (k * (r.T @ [0.1, 0.2, -0.3])))
    np.testing.assert_allclose(moment, 0, atol=1e-6)


def test_a_rigid_sub_frame_is_one_body_at_the_mean_of_its_mounts() -> None:
    b = whole()
    assert b.bodies["subframe.L"] is b.bodies["subframe.R"] is b.bodies["subframe"]
    np.testing.assert_allclose(number(b, b.bodies["subframe.L"].design), CENTRE)


def test_the_mounts_resist_a_shift_with_the_sum_of_their_stiffnesses() -> None:
    b = whole()
    shift = NO_ARMS | {"sub-frame.x": 0.1, "sub-frame.y": -0.2, "sub-frame.z": 0.05}
    force, moment = wrench(b, "sub-frame", shift)
    total = 2 * np.array([8000 + 5000, 9000 + 10000, 12000 + 12000])
    np.testing.assert_allclose(force, -total * [0.1, -0.2, 0.05])
    expected = np.zeros(3)
    for name, k in (("SFF", [8000, 9000, 12000]), ("SFR", [5000, 10000, 12000])):
        for side in ("L", "R"):
            arm = hardpoint(name, side) - CENTRE
            expected += np.cross(arm, -np.array(k) * [0.1, -0.2, 0.05])
    np.testing.assert_allclose(moment, expected)


def test_halves_are_sprung_to_the_centre_part() -> None:
    b = whole(flexible_subframe=True)
    shift = np.array([0.02, -0.01, 0.03])
    given = FLEXIBLE | {f"sub-frame half L.{a}": v for a, v in zip("xyz", shift, strict=True)}
    centre, _ = wrench(b, "sub-frame", given)
    np.testing.assert_allclose(centre, np.array([80000, 80000, 40000]) * shift)


@pytest.mark.parametrize(("axis", "stiffness"), [(0, 3000.0), (1, 6000.0), (2, 12000.0)])
def test_halves_turn_against_rotation_springs(axis: int, stiffness: float) -> None:
    b = whole(flexible_subframe=True)
    phi = 0.001 * np.eye(3)[axis]
    given = FLEXIBLE | {f"sub-frame half R.r{a}": v for a, v in zip("xyz", gibbs(phi), strict=True)}
    _, moment = wrench(b, "sub-frame", given)
    np.testing.assert_allclose(moment, stiffness * NM_PER_DEG * phi, rtol=1e-9, atol=1e-3)


def test_the_joint_of_a_half_balances_when_everything_has_moved() -> None:
    """What centre and halves feel beyond the mounts cancels."""
    b = whole(flexible_subframe=True)
    rng = np.random.default_rng(5)
    names = [
        f"{n}.{a}"
        for n in ("sub-frame", "sub-frame half L", "sub-frame half R")
        for a in ("x", "y", "z", "rx", "ry", "rz")
    ]
    pose = {n: float(rng.uniform(-1, 1) * (0.02 if ".r" in n else 1.0)) for n in names}
    mountless = pose | {
        f"{m}.{a}@{s}": 0.0
        for m in ("sff", "sfr")
        for a in ("Fx", "Fy", "Fz", "Tx", "Ty", "Tz")
        for s in "LR"
    }
    force, moment = np.zeros(3), np.zeros(3)
    for name in ("sub-frame", "sub-frame half L", "sub-frame half R"):
        f, m = wrench(b, name, FLEXIBLE | mountless)
        origin = CENTRE + [pose[f"{name}.{a}"] for a in "xyz"]
        force, moment = force + f, moment + about_origin(origin, f, m)
        assert np.linalg.norm(f) > 1e3
    np.testing.assert_allclose(force, 0, atol=1e-6)
    np.testing.assert_allclose(moment, 0, atol=1e-3)
