"""Strut: cylindrical joint, and the axes of the top mount."""

from __future__ import annotations

import numpy as np
import pytest

from doe_kc.solver.elements.strut import Strut, top_mount_axes
from tests.solver.elements.mini import MIRROR, SIDES, builder, hardpoint, number, stub, turned, wrench

POSE = {"shift": [3.0, -5.0, 12.0], "rotation": [0.02, 0.01, -0.2]}


def assembled(**pose: object):
    b = builder()
    for side in SIDES:
        b.bodies[f"tube.{side}"] = stub(f"tube {side}", hardpoint("LWB", side), **pose)  # type: ignore[arg-type]
    Strut().assemble(b)
    return b


def axis() -> np.ndarray:
    along = hardpoint("UPB") - hardpoint("LWD")
    return along / np.linalg.norm(along)


def test_the_rod_slides_and_twists_along_the_axis_of_the_tube() -> None:
    b = assembled(**POSE)
    given = {"strut slide L": -25.0, "strut twist L": float(np.tan(0.05))}
    r = turned(POSE["rotation"])
    ball = hardpoint("LWB")
    top = ball + POSE["shift"] + r @ (hardpoint("UPB") - ball)
    rod = b.bodies["rod.L"]
    np.testing.assert_allclose(number(b, rod.origin, given), top - 25.0 * r @ axis())
    np.testing.assert_allclose(number(b, rod.axes, given), r @ turned(0.1 * axis()), atol=1e-12)


def test_the_slide_is_the_change_of_the_length_from_damper_to_top_mount() -> None:
    b = assembled(**POSE)
    given = {"strut slide L": 31.0}
    tube, rod = b.bodies["tube.L"], b.bodies["rod.L"]
    damper = number(b, tube.point(np.array(hardpoint("LWD"))), given)
    length = np.linalg.norm(number(b, rod.origin, given) - damper)
    assert length == pytest.approx(np.linalg.norm(hardpoint("UPB") - hardpoint("LWD")) + 31.0)


def test_the_top_mount_pulls_the_rod_back_to_the_body() -> None:
    b = assembled()
    force, _ = wrench(b, "rod L", {"strut slide L": 2.0})
    np.testing.assert_allclose(force, -np.array([3000.0, 3000.0, 1200.0]) * 2.0 * axis())


def test_a_vertical_top_mount_has_the_axes_of_the_chassis() -> None:
    b = assembled()
    np.testing.assert_allclose(number(b, top_mount_axes(b, "L")), np.eye(3), atol=1e-15)
    np.testing.assert_allclose(number(b, top_mount_axes(b, "R")), MIRROR, atol=1e-15)


def test_upbbi_tilts_the_top_mount() -> None:
    b = assembled()
    tilted = {f"UPBBI.{a}@{s}": v for a, v in zip("xyz", (60.0, -545.0, 950.0), strict=True) for s in SIDES}
    axes = number(b, top_mount_axes(b, "L"), tilted)
    along = np.array([20.0, 30.0, 90.0]) / np.linalg.norm([20.0, 30.0, 90.0])
    np.testing.assert_allclose(axes[:, 2], along)
    np.testing.assert_allclose(axes.T @ axes, np.eye(3), atol=1e-14)
    np.testing.assert_allclose(number(b, top_mount_axes(b, "R"), tilted), MIRROR @ axes)
    force, _ = wrench(b, "rod L", tilted | {"strut slide L": 2.0})
    k = axes @ np.diag([3000.0, 3000.0, 1200.0]) @ axes.T
    np.testing.assert_allclose(force, -k @ (2.0 * axis()))
