"""Bushings of a structure: where they sit and what their axes ride on; a lower arm on its sub-frame."""

from __future__ import annotations

import numpy as np
import pytest

from tests.solver.elements.mini import (
    MIRROR,
    SIDES,
    about_origin,
    gibbs,
    hardpoint,
    number,
    turned,
    whole,
    wrench,
)

MEAN = np.array([180.0, 0.0, 247.5])
LOCAL = {"llf": np.array([10000.0, 2000.0, 10000.0]), "llr": np.array([1500.0, 600.0, 1500.0])}
LINEAR = {f"llr.cubic.F{a}@{s}": 0.0 for a in "xyz" for s in SIDES}
SOFT_MOUNTS = {f"{m}.{k}{a}@{s}": 0.0 for m in ("sff", "sfr") for k in "FT" for a in "xyz" for s in SIDES}


def turned_frame(phi: list[float]) -> dict[str, float]:
    return {f"sub-frame.r{a}": v for a, v in zip("xyz", gibbs(phi), strict=True)}


def test_a_shift_meets_local_x_as_minus_y_and_local_y_as_x() -> None:
    shift = {"lower arm L.x": 0.1, "lower arm L.y": 0.2, "lower arm L.z": -0.05}
    force, moment = wrench(whole(), "lower arm L", LINEAR | shift)
    expected, turning = np.zeros(3), np.zeros(3)
    for name, k in LOCAL.items():
        f = -k[[1, 0, 2]] * [0.1, 0.2, -0.05]
        expected += f
        point = hardpoint(name.upper()) + np.array([0.1, 0.2, -0.05])
        turning += np.cross(point - (hardpoint("LWB") + np.array([0.1, 0.2, -0.05])), f)
    np.testing.assert_allclose(force, expected)
    np.testing.assert_allclose(moment, turning)


def test_axes_ride_on_the_sub_frame_and_the_pair_balances() -> None:
    phi, b = [0.05, -0.1, 0.2], whole()
    r = turned(phi)
    given = LINEAR | SOFT_MOUNTS | turned_frame(phi) | {"lower arm L.x": 0.3}
    on_arm = wrench(b, "lower arm L", given)
    expected = np.zeros(3)
    for name, k in LOCAL.items():
        point = hardpoint(name.upper())
        apart = point + np.array([0.3, 0, 0]) - (MEAN + r @ (point - MEAN))
        expected += -r @ (k[[1, 0, 2]] * (r.T @ apart))
    np.testing.assert_allclose(on_arm[0], expected)
    # the right arm is at its design place: sum over the three bodies
    force, moment = np.zeros((2, 3))
    for name, origin in (
        ("sub-frame", MEAN),
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
    force, _ = wrench(whole(), "lower arm L", given)
    np.testing.assert_allclose(force, [-600.0, 100.0, 0.0], atol=1e-9)


def test_a_bushing_whose_axes_follow_a_line() -> None:
    """UPBBI tilts the top mount."""
    tilted = {f"UPBBI.{a}@{s}": v for a, v in zip("xyz", (60.0, -545.0, 950.0), strict=True) for s in SIDES}
    along = np.array([20.0, 30.0, 90.0]) / np.linalg.norm([20.0, 30.0, 90.0])
    strut = hardpoint("UPB") - hardpoint("LWD")
    strut /= np.linalg.norm(strut)
    b = whole()
    force, _ = wrench(b, "rod L", tilted | {"strut slide L": 2.0})
    k = 3000.0 * (np.eye(3) - np.outer(along, along)) + 1200.0 * np.outer(along, along)
    np.testing.assert_allclose(force, -k @ (2.0 * strut))
    right, _ = wrench(b, "rod R", tilted | {"strut slide R": 2.0})
    np.testing.assert_allclose(right, MIRROR @ force)


@pytest.mark.parametrize("side", SIDES)
def test_a_ball_on_a_spring_yields_in_the_axes_of_the_part_that_it_sits_in(side: str) -> None:
    phi, d = [0.1, -0.2, 0.3], np.array([0.1, -0.3, 0.2])
    b = whole(elastic_balls=("ball_joint@L", "ball_joint@R"))
    given = {f"ball joint {side}.{a}": v for a, v in zip("xyz", d, strict=True)}
    given |= {f"lower arm {side}.r{a}": v for a, v in zip("xyz", gibbs(phi), strict=True)}
    given |= {"ball_joint.rate@L": 12000.0, "ball_joint.rate@R": 12000.0}
    found = [number(b, b.resistances[f"ball joint {side}.{a}"], given) for a in "xyz"]
    np.testing.assert_allclose(found, 12000.0 * d)
    expected = hardpoint("LWB", side) + turned(phi) @ d
    np.testing.assert_allclose(number(b, b.bodies[f"knuckle.{side}"].origin, given), expected)
