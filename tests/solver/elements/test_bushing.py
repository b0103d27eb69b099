"""Six-axis bushing: hand formulas, balance of the pair, mirror image, curves."""

from __future__ import annotations

import casadi as ca
import numpy as np
import pytest
from scipy.interpolate import PchipInterpolator

from doe_kc.axle.force_curve import curve_values
from doe_kc.solver.builder import Body, Builder
from doe_kc.solver.elements import bushing
from tests.solver.elements.mini import MIRROR, about_origin, builder, number, stub, turned, wrench

ARM_AXES = ca.SX([[0, 1, 0], [-1, 0, 0], [0, 0, 1]])
"""Chassis axes turned -90 deg about Z, as columns: local x = -Y, local y = +X (thesis, section 3.3)."""

AT = np.array([300.0, -370.0, 218.0])
NM_PER_DEG = 1000 * 180 / np.pi
K = np.array([1500.0, 600.0, 1500.0])
KR = np.array([2.0, 1.0, 1.5]) * NM_PER_DEG
LINEAR = {f"llr.cubic.F{a}@{s}": 0.0 for a in "xyz" for s in "LR"}


def connected(
    inner: Body | None,
    outer: Body,
    *,
    side: str = "L",
    axes: object = None,
    at: np.ndarray = AT,
    **topology: object,
) -> Builder:
    b = builder(**topology)
    local = ca.SX.eye(3) if axes is None else ca.SX(axes)
    bushing.connect(b, "llr", side, at=ca.SX(at), axes=local, inner=inner, outer=outer)
    return b


def test_a_linear_bushing_pulls_back_by_k_times_deflection() -> None:
    shift = np.array([0.3, -0.5, 0.2])
    force, moment = wrench(connected(None, stub("outer", AT, shift)), "outer", LINEAR)
    np.testing.assert_allclose(force, -K * shift)
    np.testing.assert_allclose(moment, 0, atol=1e-9)


def test_the_cubic_term_stiffens() -> None:
    shift = np.array([2.0, -3.0, 1.0])
    force, _ = wrench(connected(None, stub("outer", AT, shift)), "outer")
    np.testing.assert_allclose(force, -K * (shift + 0.01 * shift**3))


def test_preload_and_factor() -> None:
    given = LINEAR | {"llr.preload.Fy@L": 600.0, "llr.Fy@L": 1.5, "llr.Fx@L": 0.5}
    shift = np.array([0.2, 0.4, 0.0])
    force, _ = wrench(connected(None, stub("outer", AT, shift)), "outer", given)
    np.testing.assert_allclose(force, [-0.5 * 1500 * 0.2, -(1.5 * 600 * 0.4 + 600), 0])


@pytest.mark.parametrize("axis", range(3))
def test_the_torque_about_one_axis_is_k_phi(axis: int) -> None:
    phi = np.radians(40.0) * np.eye(3)[axis]
    _, moment = wrench(connected(None, stub("outer", AT, rotation=phi)), "outer")
    np.testing.assert_allclose(moment, -KR * phi, atol=1e-8)


def test_the_torque_factor_scales_the_torque_alone() -> None:
    phi = [0.0, 0.1, 0.0]
    force, moment = wrench(connected(None, stub("outer", AT, rotation=phi)), "outer", {"llr.Ty@L": 3.0})
    np.testing.assert_allclose(moment, [0, -3 * KR[1] * 0.1, 0], atol=1e-8)
    np.testing.assert_allclose(force, 0, atol=1e-9)


def test_local_axes_of_the_arm_are_turned_a_quarter_backwards() -> None:
    """Local x = -Y, local y = +X: kx acts on y, ky on x."""
    np.testing.assert_array_equal(np.array(ca.DM(ARM_AXES)) @ [1, 0, 0], [0, -1, 0])
    np.testing.assert_array_equal(np.array(ca.DM(ARM_AXES)) @ [0, 1, 0], [1, 0, 0])
    b = connected(None, stub("outer", AT, [0.1, 0.1, 0.1]), axes=ARM_AXES)
    force, _ = wrench(b, "outer", LINEAR)
    np.testing.assert_allclose(force, -np.array([600.0, 1500.0, 1500.0]) * 0.1)


def moved() -> tuple[Body, Body]:
    inner = stub("inner", [180.0, 0.0, 247.0], [1.0, -2.0, 0.5], [0.02, -0.3, 0.1])
    return inner, stub("outer", [-8.0, -748.0, 205.0], [2.0, 1.0, -3.0], [0.25, 0.1, -0.2])


def test_forces_and_moments_of_the_pair_cancel() -> None:
    """The couple d x F goes to the inner part."""
    inner, outer = moved()
    b = connected(inner, outer, axes=ARM_AXES)
    sums = np.zeros(3), np.zeros(3)
    for body in (inner, outer):
        force, moment = wrench(b, body.name)
        origin = np.array(ca.DM(body.origin)).ravel()
        sums = sums[0] + force, sums[1] + about_origin(origin, force, moment)
        assert np.linalg.norm(force) > 1e3
    np.testing.assert_allclose(sums[0], 0, atol=1e-7)
    np.testing.assert_allclose(sums[1], 0, atol=1e-4)


def test_the_force_acts_at_the_displaced_outer_point_in_the_axes_of_the_inner_part() -> None:
    inner, outer = moved()
    b = connected(inner, outer)
    r = turned([0.02, -0.3, 0.1])
    on_outer = (
        np.array([-8.0, -748.0, 205.0]) + [2, 1, -3] + turned([0.25, 0.1, -0.2]) @ (AT - [-8, -748, 205])
    )
    on_inner = np.array([180.0, 0.0, 247.0]) + [1, -2, 0.5] + r @ (AT - [180, 0, 247])
    d = r.T @ (on_outer - on_inner)
    force, moment = wrench(b, "outer")
    np.testing.assert_allclose(force, -r @ (K * (d + 0.01 * d**3)), rtol=1e-12)
    torque_free = {f"llr.T{a}@L": 0.0 for a in "xyz"}
    _, moment = wrench(b, "outer", torque_free)
    np.testing.assert_allclose(moment, np.cross(on_outer - [-6, -747, 202], force), rtol=1e-10)


def test_the_right_bushing_is_the_mirror_image() -> None:
    shift, phi = np.array([0.7, -0.4, 0.2]), np.array([0.1, -0.05, 0.2])
    given = {f"llr.preload.F{a}@{s}": f for a, f in zip("xyz", (10.0, 20.0, 30.0), strict=True) for s in "LR"}
    axes = np.array(ca.DM(ARM_AXES))
    left = wrench(connected(None, stub("outer", AT, shift, phi), axes=axes), "outer", given)
    # an axial vector is mirrored with the opposite sign
    mirrored = stub("outer", MIRROR @ AT, MIRROR @ shift, -MIRROR @ phi)
    b = connected(None, mirrored, side="R", axes=MIRROR @ axes, at=MIRROR @ AT)
    right = wrench(b, "outer", given)
    np.testing.assert_allclose(right[0], MIRROR @ left[0], atol=1e-9)
    np.testing.assert_allclose(right[1], -MIRROR @ left[1], atol=1e-6)


X = np.array([-4.0, -1.0, 0.0, 1.0, 5.0])
F = np.array([-9000.0, -900.0, 0.0, 500.0, 12000.0])
TABLE = {"tables": (("llr", "Fx", 5),)}
TABLE_VALUES = {f"{k}@{s}": v for k, v in curve_values("llr.table.Fx", X, F).items() for s in "LR"}


@pytest.mark.parametrize("d", [-3.9, -1.0, -0.3, 0.0, 0.4, 1.0, 4.9])
def test_a_tabulated_axis_follows_pchip_times_its_factor(d: float) -> None:
    b = connected(None, stub("outer", AT, [d, 0, 0]), **TABLE)
    force, _ = wrench(b, "outer", TABLE_VALUES | {"llr.Fx@L": 1.2, "llr.preload.Fx@L": 50.0})
    assert force[0] == pytest.approx(-(1.2 * PchipInterpolator(X, F)(d) + 50.0))


@pytest.mark.parametrize(("d", "end"), [(-7.0, 0), (9.0, -1)])
def test_beyond_the_table_the_curve_is_straight(d: float, end: int) -> None:
    b = connected(None, stub("outer", AT, [d, 0, 0]), **TABLE)
    force, _ = wrench(b, "outer", TABLE_VALUES)
    pchip = PchipInterpolator(X, F)
    expected = pchip(X[end]) + pchip.derivative()(X[end]) * (d - X[end])
    assert -force[0] == pytest.approx(float(expected))


def test_a_tabulated_torque_is_in_rad_and_n_mm() -> None:
    phi, torque = np.radians([-20.0, 0.0, 20.0]), np.array([-3e4, 0.0, 5e4])
    given = {f"{k}@L": v for k, v in curve_values("llr.table.Tz", phi, torque).items()}
    b = connected(None, stub("outer", AT, rotation=[0, 0, 0.2]), tables=(("llr", "Tz", 3),))
    _, moment = wrench(b, "outer", given)
    assert moment[2] == pytest.approx(-float(PchipInterpolator(phi, torque)(0.2)))


def test_nothing_acts_at_the_design_position() -> None:
    b = connected(stub("inner", [1, 2, 3]), stub("outer", [-8, -748, 205]))
    for part in ("inner", "outer"):
        np.testing.assert_allclose(np.concatenate(wrench(b, part)), 0, atol=1e-9)
    assert number(b, ca.SX(0)) == 0
