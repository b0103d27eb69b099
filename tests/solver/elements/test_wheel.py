"""Wheel: design spin axis, and the hub's springs."""

from __future__ import annotations

import numpy as np
import pytest

from doe_kc.solver.elements.wheel import SPIN_STIFFNESS, add_wheel
from tests.solver.elements.mini import MIRROR, SIDES, builder, gibbs, hardpoint, number, stub, turned

NM_PER_DEG = 1000 * 180 / np.pi
HUB = {f"hub.{n}@{s}": v for n, v in (("camber", 6000.0), ("toe", 9000.0)) for s in SIDES}


def assembled(rotation: object = (0.0, 0.0, 0.0), **topology: object):
    b = builder(**topology)
    for side in SIDES:
        b.bodies[f"carrier.{side}"] = stub(f"knuckle {side}", hardpoint("LWB", side), rotation=rotation)
        add_wheel(b, b.bodies[f"carrier.{side}"], side, "knuckle")
    return b


@pytest.mark.parametrize(("toe", "camber"), [(0.05, -0.5), (2.0, 3.0), (-1.0, 0.0)])
def test_the_spin_axis_reads_back_toe_and_camber(toe: float, camber: float) -> None:
    b = assembled()
    given = {f"static.{n}@{s}": v for n, v in (("toe", toe), ("camber", camber)) for s in SIDES}
    left, right = (number(b, b.points[f"spin.{s}"], given) for s in SIDES)
    assert np.linalg.norm(left) == pytest.approx(1.0)
    assert left[1] < 0 < right[1]  # outwards
    assert np.degrees(np.arctan2(-left[0], -left[1])) == pytest.approx(toe)
    assert -np.degrees(np.arcsin(left[2])) == pytest.approx(camber)
    np.testing.assert_allclose(right, MIRROR @ left)


def test_a_rigid_wheel_is_the_knuckle() -> None:
    phi = [0.02, 0.1, -0.3]
    b = assembled(phi)
    assert b.bodies["wheel.L"] is b.bodies["carrier.L"]
    ball = hardpoint("LWB")
    expected = ball + turned(phi) @ (hardpoint("WLC") - ball)
    np.testing.assert_allclose(number(b, b.points["wheel centre.L"]), expected)


@pytest.mark.parametrize("side", SIDES)
@pytest.mark.parametrize(
    ("axis", "stiffness"), [(0, 6000.0 * NM_PER_DEG), (1, SPIN_STIFFNESS), (2, 9000.0 * NM_PER_DEG)]
)
def test_hub_springs(side: str, axis: int, stiffness: float) -> None:
    """About the knuckle's X (camber) and Z (toe); 1e8 Nm/rad about Y."""
    b = assembled(hub=True)
    phi = 0.01 * np.eye(3)[axis]
    given = HUB | {f"wheel {side}.{a}": v for a, v in zip(("rx", "ry", "rz"), gibbs(phi), strict=True)}
    moment = [number(b, b.resistances[f"wheel {side}.{a}"], given) for a in ("rx", "ry", "rz")]
    np.testing.assert_allclose(moment, stiffness * phi, rtol=1e-9, atol=1e-4)


@pytest.mark.parametrize("side", SIDES)
@pytest.mark.parametrize("factor", [0.5, 1.0, 1.6])
def test_a_hub_that_stiffens(side: str, factor: float) -> None:
    """k phi (1 + (f - 1) q / (1 + q)) about either axis: half of the way at 300 Nm, all of it far beyond."""
    law = {f"hub.{n}@{s}": v for n, v in (("loaded_factor", factor), ("reference", 300.0)) for s in SIDES}
    b = assembled(hub=True, hub_stiffens=True)

    def moment(phi: np.ndarray) -> np.ndarray:
        at = {f"wheel {side}.{a}": v for a, v in zip(("rx", "ry", "rz"), gibbs(phi), strict=True)}
        return np.array(
            [number(b, b.resistances[f"wheel {side}.{a}"], HUB | law | at) for a in ("rx", "ry", "rz")]
        )

    for axis, stiffness in ((0, 6000.0), (2, 9000.0)):
        unit = np.eye(3)[axis]
        for loads, share in ((1e-3, 0.0), (1.0, 0.5), (-1.0, 0.5), (100.0, 1.0)):
            phi = np.radians(loads * 300.0 / stiffness)
            expected = stiffness * NM_PER_DEG * phi * (1.0 + share * (factor - 1.0))
            np.testing.assert_allclose(moment(phi * unit)[axis], expected, rtol=2e-4)


def test_the_sprung_wheel_turns_about_its_centre_in_the_knuckle_s_axes() -> None:
    phi = [0.02, 0.1, -0.3]
    b = assembled(phi, hub=True)
    given = HUB | {"wheel L.rz": float(np.tan(0.005))}
    ball = hardpoint("LWB")
    expected = ball + turned(phi) @ (hardpoint("WLC") - ball)
    np.testing.assert_allclose(number(b, b.points["wheel centre.L"], given), expected)
    axes = number(b, b.bodies["wheel.L"].axes, given)
    np.testing.assert_allclose(axes, turned(phi) @ turned([0, 0, 0.01]), atol=1e-12)
