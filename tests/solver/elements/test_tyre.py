"""Tyre: load, contact point, lift-off and the equations that hold the pads."""

from __future__ import annotations

from typing import Any

import casadi as ca
import numpy as np
import pytest

from doe_kc.solver.builder import Builder
from doe_kc.solver.elements.tyre import add_tyres
from tests.solver.elements.mini import MIRROR, SIDES, builder, number, stub, wrench

RATE, STATIC, HEIGHT = 220.0, 4300.0, 310.0


def assembled(
    centre: object = (0.0, -790.0, HEIGHT), camber: float = -0.5, toe: float = 0.05, **topology: Any
) -> Builder:
    """Both wheels at mirrored positions; angles in deg."""
    b = builder(**topology)
    b.points["preload"] = b.tail_unknown("preload", "spring preload", 1.0)
    t, g = np.radians([toe, camber])
    spin = np.array([-np.sin(t) * np.cos(g), -np.cos(t) * np.cos(g), -np.sin(g)])
    for side in SIDES:
        flip = np.eye(3) if side == "L" else MIRROR
        b.bodies[f"wheel.{side}"] = stub(f"wheel {side}", centre if side == "L" else MIRROR @ centre)
        b.points[f"wheel centre.{side}"] = ca.SX(flip @ np.asarray(centre, dtype=float))
        b.points[f"spin.{side}"] = ca.SX(flip @ spin)
    add_tyres(b)
    return b


def unloaded_radius() -> float:
    """(static camber -0.5 deg)"""
    c = np.cos(np.radians(0.5))
    return HEIGHT / c + STATIC * c / RATE


def test_the_static_load_at_design_height() -> None:
    b = assembled()
    assert number(b, b.points["tyre.L"]) == pytest.approx(STATIC, rel=1e-12)


@pytest.mark.parametrize("camber", [-6.0, -0.5, 0.0, 4.0])
@pytest.mark.parametrize("pad", [-12.0, 0.0, 35.0])
def test_load_is_k_times_deflection_in_the_wheel_plane(camber: float, pad: float) -> None:
    b = assembled(camber=camber)
    cosine = np.cos(np.radians(camber))
    t = (HEIGHT - pad) / cosine
    load = number(b, b.points["tyre.L"], {"pad L": pad})
    assert load == pytest.approx(RATE * (unloaded_radius() - t) / cosine)


def test_the_contact_point_is_on_the_pad_and_in_the_wheel_plane() -> None:
    b = assembled(camber=3.0, toe=1.0)
    given = {"pad L": 20.0, "roll": 0.04}
    contact = number(b, b.points["contact.L"], given)
    normal = np.array([0.0, -np.sin(0.04), np.cos(0.04)])
    assert normal @ contact == pytest.approx(20.0)
    spin = number(b, b.points["spin.L"])
    assert spin @ (contact - [0.0, -790.0, HEIGHT]) == pytest.approx(0.0, abs=1e-9)
    # the steepest ray downwards: no part along the horizontal of the wheel plane
    along = np.cross(normal, spin)
    assert along @ (contact - [0.0, -790.0, HEIGHT]) == pytest.approx(0.0, abs=1e-9)


def test_a_lifted_wheel_has_its_contact_point_at_the_unloaded_radius() -> None:
    b = assembled(camber=3.0)
    centre = np.array([0.0, -790.0, HEIGHT])
    cosine = np.cos(np.radians(3.0))
    radius = HEIGHT / np.cos(np.radians(0.5)) + STATIC * np.cos(np.radians(0.5)) / RATE
    lifted = number(b, b.points["contact.L"], {"pad L": -60.0}) - centre
    assert np.linalg.norm(lifted) == pytest.approx(radius, rel=1e-12)
    held = number(b, b.points["contact.L"], {"pad L": -60.0, "bilateral": 1.0}) - centre
    assert np.linalg.norm(held) == pytest.approx((HEIGHT + 60.0) / cosine, rel=1e-12)


def test_lift_off_and_the_two_sided_actuator() -> None:
    b = assembled()
    assert number(b, b.points["tyre.L"], {"pad L": -25.0}) == 0.0
    pulled = number(b, b.points["tyre.L"], {"pad L": -25.0, "bilateral": 1.0})
    assert pulled == pytest.approx(
        RATE * (unloaded_radius() - (HEIGHT + 25) / np.cos(np.radians(0.5))) / np.cos(np.radians(0.5))
    )
    assert pulled < 0


def test_forces_act_where_the_definition_says() -> None:
    b = assembled()
    given = {"lateral_L": 700.0, "brake_L": 300.0, "drive_L": 500.0, "lateral_offset": 30.0}
    force, moment = wrench(b, "wheel L", given)
    contact = number(b, b.points["contact.L"])
    np.testing.assert_allclose(force, [300.0 - 500.0, 700.0, STATIC], rtol=1e-9)
    arm = contact - [0.0, -790.0, HEIGHT]
    expected = np.cross(arm, [300.0, 0.0, STATIC]) + np.cross(arm + np.array([30.0, 0, 0]), [0, 700.0, 0])
    np.testing.assert_allclose(moment, expected, rtol=1e-9, atol=1e-6)


def test_a_horizontally_compliant_tyre_moves_its_contact_along_the_force() -> None:
    b = assembled(tyre_horizontal=True)
    given = {
        "tyre.lat_rate@L": 180.0,
        "tyre.long_rate@L": 250.0,
        "tyre.lat_rate@R": 180.0,
        "tyre.long_rate@R": 250.0,
    }
    still = number(b, b.points["contact.L"], given)
    moved = number(b, b.points["contact.L"], given | {"lateral_L": 900.0, "brake_L": 500.0})
    np.testing.assert_allclose(moved - still, [2.0, 5.0, 0.0], atol=1e-12)


def test_the_pads_are_held_by_height_by_wheel_centre_or_by_load() -> None:
    b = assembled()
    equation = b.tail_equations["pad L"]
    assert number(b, equation, {"pad L": 7.0, "pad_L": 5.0}) == pytest.approx(2.0)
    by_centre = {"hold_wheel_centre": 1.0, "wc_z_L": 300.0}
    assert number(b, equation, by_centre) == pytest.approx(10.0)
    assert number(b, equation, {"hold_load": 1.0}) == pytest.approx(0.0, abs=1e-9)
    assert number(b, equation, {"hold_load": 1.0, "pad L": 1.0}) == pytest.approx(1.0, rel=1e-3)


def test_the_static_preload_holds_the_mean_wheel_centre_at_design_height() -> None:
    b = assembled([0.0, -790.0, HEIGHT + 2.0])
    equation = b.tail_equations["preload"]
    assert number(b, equation, {"hold_height": 1.0}) == pytest.approx(28.0 * 2.0)


def test_the_right_tyre_is_the_mirror_image() -> None:
    b = assembled(camber=-2.0, toe=0.7)
    left, right = wrench(b, "wheel L"), wrench(b, "wheel R")
    np.testing.assert_allclose(right[0], MIRROR @ left[0], atol=1e-9)
    np.testing.assert_allclose(right[1], -MIRROR @ left[1], atol=1e-6)
