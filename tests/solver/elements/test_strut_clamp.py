"""Strut clamp: springs between a damper tube and what carries it."""

from __future__ import annotations

import casadi as ca
import numpy as np
import pytest

from doe_kc.solver.elements.strut_clamp import clamped_part
from tests.solver.elements.mini import builder, gibbs, hardpoint, number, stub, turned

NM_PER_DEG = 1000 * 180 / np.pi
AXIS = (hardpoint("UPB") - hardpoint("LWD")) / np.linalg.norm(hardpoint("UPB") - hardpoint("LWD"))


def clamped(**topology: object):
    b = builder(**topology)
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


@pytest.mark.parametrize("factor", [0.5, 1.0, 1.6])
def test_a_clamp_that_stiffens_counts_from_rest(factor: float) -> None:
    """K (phi + (phi - phi0) (f - 1) q / (1 + q)): half of the way at 300 Nm of bending beyond the rest."""
    b, _ = clamped(strut_stiffens=True)
    ((before, after),) = b.states
    law = {"strut.loaded_factor@L": factor, "strut.reference@L": 300.0, "strut.flexibility@L": 1.0}
    across = np.cross(AXIS, [1.0, 0, 0])
    across /= np.linalg.norm(across)
    rest = np.radians(0.05) * across
    joint = next(j for j in b.joints if j.label == "strut clamp L")

    def of(expressions: list[ca.SX], phi: np.ndarray, case: float) -> np.ndarray:
        given = {f"tube L.{a}": v for a, v in zip(("rx", "ry", "rz"), gibbs(phi), strict=True)}
        at = [ca.substitute(e, before, ca.DM(rest)) for e in expressions]
        return np.array([number(b, e, law | given | {"load_case": case}) for e in at]).ravel()

    torque = [b.resistances[f.name] / f.compliance for f in joint.freedoms]
    stiffness = 8000.0
    for loads, share in ((1e-3, 0.0), (1.0, 0.5), (-1.0, 0.5), (100.0, 1.0)):
        beyond = np.radians(loads * 300.0 / stiffness)
        phi = rest + beyond * across
        linear = of(torque, phi, 0.0) @ across
        assert linear == pytest.approx(stiffness * NM_PER_DEG * (0.05 * np.pi / 180 + beyond), rel=1e-9)
        further = stiffness * NM_PER_DEG * beyond * share * (factor - 1.0)
        assert of(torque, phi, 1.0) @ across == pytest.approx(linear + further, rel=2e-4)
    np.testing.assert_allclose(of([after], 3 * rest, 1.0), rest, rtol=1e-12)
    np.testing.assert_allclose(of([after], 2 * rest, 0.0), 2 * rest, rtol=1e-12)


def test_the_tube_turns_about_the_clamp() -> None:
    b, tube = clamped()
    phi = [0.01, -0.02, 0.005]
    given = {f"tube L.{a}": v for a, v in zip(("rx", "ry", "rz"), gibbs(phi), strict=True)}
    given["strut.flexibility@L"] = 1.0
    clamp, seat = hardpoint("CLAMP"), hardpoint("LWS")
    expected = clamp + [0, 1, 20] + turned(phi) @ (seat - clamp)
    np.testing.assert_allclose(number(b, tube.point(seat), given), expected)
