"""Axes along a line between two hardpoints."""

from __future__ import annotations

import numpy as np

from doe_kc.solver.structure.line import line_axes, line_direction
from tests.solver.elements.mini import MIRROR, SIDES, builder, hardpoint, number


def test_the_direction_is_a_unit_vector_from_the_first_point_to_the_second() -> None:
    b = builder()
    for side in SIDES:
        along = hardpoint("UPB", side) - hardpoint("LWD", side)
        expected = along / np.linalg.norm(along)
        np.testing.assert_allclose(number(b, line_direction(b, "LWD", "UPB", side)), expected)


def test_a_vertical_line_has_the_axes_of_the_chassis() -> None:
    b = builder()
    np.testing.assert_allclose(number(b, line_axes(b, "UPB", "UPBBI", "L")), np.eye(3), atol=1e-15)
    np.testing.assert_allclose(number(b, line_axes(b, "UPB", "UPBBI", "R")), MIRROR, atol=1e-15)


def test_z_lies_along_a_tilted_line_and_the_right_side_is_mirrored() -> None:
    b = builder()
    tilted = {f"UPBBI.{a}@{s}": v for a, v in zip("xyz", (60.0, -545.0, 950.0), strict=True) for s in SIDES}
    axes = number(b, line_axes(b, "UPB", "UPBBI", "L"), tilted)
    np.testing.assert_allclose(axes[:, 2], np.array([20.0, 30.0, 90.0]) / np.linalg.norm([20.0, 30.0, 90.0]))
    np.testing.assert_allclose(axes.T @ axes, np.eye(3), atol=1e-14)
    np.testing.assert_allclose(number(b, line_axes(b, "UPB", "UPBBI", "R"), tilted), MIRROR @ axes)
