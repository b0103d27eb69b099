"""Strut clamp: springs between a damper tube and what carries it."""

from __future__ import annotations

import casadi as ca
import numpy as np
import pytest

from doe_kc.solver.elements.strut_clamp import clamped_part
from tests.solver.elements.mini import builder, gibbs, hardpoint, number, stub, turned

NM_PER_DEG = 1000 * 180 / np.pi
AXIS = (hardpoint("UPB") - hardpoint("LWD")) / np.linalg.norm(hardpoint("UPB") - hardpoint("LWD"))


def clamped():
    b = builder()
    knuckle = stub("knuckle L", hardpoint("LWB"), [0.0, 1.0, 20.0])
    return b, clamped_part(b, "tube L", knuckle, "CLAMP", ca.SX(AXIS), "L")


@pytest.mark.parametrize("flexibility", [0.5, 1.0, 2.0])
def test_clamp_springs_bend_across_and_twist_along_the_damper(flexibility: float) -> None:
    b, _ = clamped()
    across = np.cross(AXIS, [1.0, 0, 0])
    across /= np.linalg.norm(across)
    for direction, stiffness in ((AXIS, 30000.0), (across, 8000.0), (np.cross(AXIS, across), 8000.0)):
        phi = 0.003 * direction
        given = {f"tube L.{a}": v for a, v in zip(("rx", "ry", "rz"), gibbs(phi), strict=True)}
        given["strut.flexibility@L"] = flexibility
        joint = next(j for j in b.joints if j.label == "strut clamp L")
        moment = [number(b, b.resistances[f.name] / f.compliance, given) for f in joint.freedoms]
        np.testing.assert_allclose(moment, stiffness / flexibility * NM_PER_DEG * phi, rtol=1e-9, atol=1e-3)


def test_the_tube_turns_about_the_clamp() -> None:
    b, tube = clamped()
    phi = [0.01, -0.02, 0.005]
    given = {f"tube L.{a}": v for a, v in zip(("rx", "ry", "rz"), gibbs(phi), strict=True)}
    given["strut.flexibility@L"] = 1.0
    clamp, seat = hardpoint("CLAMP"), hardpoint("LWS")
    expected = clamp + [0, 1, 20] + turned(phi) @ (seat - clamp)
    np.testing.assert_allclose(number(b, tube.point(seat), given), expected)
