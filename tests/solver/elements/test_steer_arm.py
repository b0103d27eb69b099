"""Steer arm as a clamped round beam."""

from __future__ import annotations

import casadi as ca
import numpy as np
import pytest

from doe_kc.solver.elements.steer_arm import beam_end, beam_stiffness
from tests.solver.elements.mini import SIDES, builder, hardpoint, number, stub, turned


def test_beam_formulas() -> None:
    r, length, e = 14.0, 46.0, 210e3
    axial, transverse = (float(v) for v in beam_stiffness(ca.SX(r), ca.SX(length)))
    assert axial == pytest.approx(e * np.pi * r**2 / length)
    assert transverse == pytest.approx(3 * e * (np.pi * r**4 / 4) / length**3)


@pytest.mark.parametrize("side", SIDES)
def test_the_end_of_the_beam_resists_along_and_across(side: str) -> None:
    b, phi = builder(), [0.1, -0.2, 0.3]
    knuckle = stub(f"knuckle {side}", hardpoint("LWB", side), rotation=phi)
    end = beam_end(b, f"steer arm {side}", knuckle, "SAH", "ROB", side)
    arm = hardpoint("ROB", side) - hardpoint("SAH", side)
    length = np.linalg.norm(arm)
    e = arm / length
    axial = 210e3 * np.pi * 14.0**2 / length
    transverse = 3 * 210e3 * np.pi * 14.0**4 / 4 / length**3
    k = axial * np.outer(e, e) + transverse * (np.eye(3) - np.outer(e, e))
    d = np.array([0.01, -0.03, 0.02])
    given = {f"steer arm {side}.{a}": v for a, v in zip("xyz", d, strict=True)}
    found = [number(b, b.resistances[f"steer arm {side}.{a}"], given) for a in "xyz"]
    np.testing.assert_allclose(found, k @ d, rtol=1e-12)
    # the ball is displaced in the knuckle's axes
    expected = hardpoint("LWB", side) + turned(phi) @ (hardpoint("ROB", side) + d - hardpoint("LWB", side))
    np.testing.assert_allclose(number(b, end.origin, given), expected)


def test_the_stiffness_follows_the_radius() -> None:
    b = builder()
    beam_end(b, "steer arm L", stub("knuckle L", hardpoint("LWB")), "SAH", "ROB", "L")
    arm = hardpoint("ROB") - hardpoint("SAH")
    across = np.cross(arm, [0, 0, 1.0])
    d = 0.01 * across / np.linalg.norm(across)
    given = {f"steer arm L.{a}": v for a, v in zip("xyz", d, strict=True)}

    def force(radius: float) -> float:
        values = given | {"steer_arm.radius@L": radius}
        return float(np.linalg.norm([number(b, b.resistances[f"steer arm L.{a}"], values) for a in "xyz"]))

    assert force(20.0) / force(10.0) == pytest.approx(16.0)
