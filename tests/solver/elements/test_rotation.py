"""Finite rotations against scipy, and the rotation spring against the gradient of its energy."""

from __future__ import annotations

import casadi as ca
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from doe_kc.solver import rotation
from tests.solver.elements.mini import gibbs

AXES = [np.array(a) / np.linalg.norm(a) for a in ([1, 0, 0], [0, 0, -1], [1, 2, -3], [-2, 0.1, 1])]
ANGLES = [0.0, 1e-9, 1e-4, 1.0, 15.9, 16.1, 45.0, 90.0, 135.0, 170.0]


def call(function, *arguments: np.ndarray) -> np.ndarray:
    symbols = [ca.SX.sym("a", *np.asarray(a).reshape(len(a), -1).shape) for a in arguments]
    return np.array(ca.Function("f", symbols, [function(*symbols)])(*arguments)).squeeze()


@pytest.mark.parametrize("angle", ANGLES)
@pytest.mark.parametrize("axis", AXES, ids=str)
def test_the_matrix_is_the_rotation(axis: np.ndarray, angle: float) -> None:
    phi = np.radians(angle) * axis
    r = call(rotation.matrix, gibbs(phi))
    np.testing.assert_allclose(r, Rotation.from_rotvec(phi).as_matrix(), atol=1e-14)
    np.testing.assert_allclose(r.T @ r, np.eye(3), atol=1e-14)
    assert np.linalg.det(r) == pytest.approx(1.0)


@pytest.mark.parametrize("angle", ANGLES)
@pytest.mark.parametrize("axis", AXES, ids=str)
def test_the_rotation_vector_comes_back(axis: np.ndarray, angle: float) -> None:
    phi = np.radians(angle) * axis
    np.testing.assert_allclose(
        call(lambda p: rotation.angle_ratio(ca.dot(p, p))[0] * p, gibbs(phi)), phi, rtol=1e-13, atol=1e-16
    )


def test_compose_is_the_product_and_relative_its_inverse() -> None:
    rng = np.random.default_rng(1)
    for _ in range(50):
        a, b = (gibbs(v) for v in rng.uniform(-0.8, 0.8, (2, 3)))
        ra, rb = call(rotation.matrix, a), call(rotation.matrix, b)
        np.testing.assert_allclose(call(rotation.matrix, call(rotation.compose, a, b)), ra @ rb, atol=1e-14)
        np.testing.assert_allclose(
            call(rotation.matrix, call(rotation.relative, a, b)), ra.T @ rb, atol=1e-14
        )


def test_angle_ratio_and_its_slope_are_smooth_where_series_and_formula_meet() -> None:
    s = np.array([1e-12, 1e-3, 0.0199999, 0.02, 0.0200001, 0.5, 100.0])
    for si in s:
        kappa, slope = (float(v) for v in rotation.angle_ratio(ca.SX(si)))
        root = np.sqrt(si)
        assert kappa == pytest.approx(2 * np.arctan(root) / root, rel=1e-13)
        h = 1e-5 * si
        exact = [2 * np.arctan(np.sqrt(v)) / np.sqrt(v) for v in (si - h, si + h)]
        expected = (exact[1] - exact[0]) / (2 * h) if si > 1e-9 else -2 / 3
        assert slope == pytest.approx(expected, rel=1e-6)


@pytest.mark.parametrize("angle", [0.01, 5.0, 30.0, 100.0, 160.0])
def test_the_spring_moment_is_the_gradient_of_its_energy(angle: float) -> None:
    """Energy 1/2 phi^T K phi, turned by a small rotation about each fixed axis."""
    rng = np.random.default_rng(2)
    k = np.diag([3.0, 1.0, 7.0])
    for _ in range(5):
        axis = rng.normal(size=3)
        r = Rotation.from_rotvec(np.radians(angle) * axis / np.linalg.norm(axis))

        def energy(turn: np.ndarray, r: Rotation = r) -> float:
            phi = (Rotation.from_rotvec(turn) * r).as_rotvec()
            return float(phi @ k @ phi) / 2

        h = 1e-5
        expected = [(energy(h * e) - energy(-h * e)) / (2 * h) for e in np.eye(3)]
        p = gibbs(r.as_rotvec())

        def moment(p: ca.SX) -> ca.SX:
            kappa, slope = rotation.angle_ratio(ca.dot(p, p))
            return rotation.spring_moment(p, ca.DM(k) @ (kappa * p), kappa, slope)

        np.testing.assert_allclose(call(moment, p), expected, rtol=1e-7, atol=1e-8)


def test_the_minimal_rotation_takes_z_to_the_direction_and_turns_no_further() -> None:
    rng = np.random.default_rng(3)
    for direction in [*rng.normal(size=(10, 3)), np.array([0, 0, 1.0])]:
        e = direction / np.linalg.norm(direction)
        r = call(rotation.minimal_rotation_from_z, e)
        np.testing.assert_allclose(r @ [0, 0, 1], e, atol=1e-13)
        assert Rotation.from_matrix(r).magnitude() == pytest.approx(np.arccos(e[2]), abs=1e-7)
