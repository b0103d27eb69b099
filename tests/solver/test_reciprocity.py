"""Maxwell and Betti: an axle without friction is conservative, so its tangents are symmetric.

Inputs and their work conjugates: drive force and -x of the wheel centre, pad height and tyre load, pinion
travel and column force. The derivatives of the complementary energy are wc_x, tyre load and column force,
whose Hessian must be symmetric at every equilibrium, loaded or not.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from doe_kc.axle import Axle, with_values
from doe_kc.effects import apply_effect
from tests.reference import nominal, variant, with_effect
from tests.solver.tangent import Rig

INPUTS = ("drive_L", "drive_R", "pad_L", "pad_R", "rack")
CONJUGATES = ("wc_x@L", "wc_x@R", "tyre_load@L", "tyre_load@R", "column_force")
SCALE = np.array([1e3, 1e3, 1.0, 1.0, 1.0])
"""1 kN and 1 mm as units."""


def everything() -> Axle:
    """Every conservative effect at once."""
    axle = nominal()
    for ident in (
        "hub_compliance",
        "strut_bending",
        "steer_arm_compliance",
        "rack_mount_compliance",
        "subframe_flexibility",
        "bushing_progression",
        "tie_rod_free_play",
    ):
        axle = apply_effect(axle, ident, {}, source="test")
    return axle


AXLES = {
    "nominal": nominal,
    "variant_1": lambda: variant(1),
    "variant_3": lambda: variant(3),
    "asymmetric": lambda: with_values(nominal(), {"right.LLR.y": 374.0, "left.llf.Fx": 0.5}),
    "hub_compliance": lambda: with_effect("hub_compliance"),
    "hub_that_stiffens": lambda: apply_effect(
        nominal(), "hub_compliance", {"law": "stiffening", "loaded_factor": 1.6}, source="test"
    ),
    "strut_that_stiffens": lambda: apply_effect(
        nominal(), "strut_bending", {"law": "stiffening", "loaded_factor": 0.6}, source="test"
    ),
    "strut_bending": lambda: with_effect("strut_bending"),
    "subframe_flexibility": lambda: with_effect("subframe_flexibility"),
    "everything": everything,
}
LOADED = {"pad_L": 25.0, "pad_R": -15.0, "drive_L": 1500.0, "drive_R": -800.0, "rack": 20.0}


@pytest.mark.parametrize("name", AXLES)
def test_tangents_are_symmetric_at_rest_and_under_load(name: str) -> None:
    rig = Rig(AXLES[name]())
    path = rig.path([LOADED], 12, load_case=True)
    for x, u in ((rig.static.x, rig.static.u), (path.x[-1], rig.u[-1])):
        hessian = rig.tangent(x, u, CONJUGATES, INPUTS) * SCALE * SCALE[:, None]
        np.testing.assert_allclose(hessian, hessian.T, rtol=0, atol=1e-9 * np.abs(hessian).max())
        assert np.abs(hessian - np.diag(np.diag(hessian))).max() > 1.0


def test_lateral_force_and_drive_force_are_reciprocal() -> None:
    """Lateral force moves the wheel centre in x as a drive force moves the wheel at P in y."""
    rig = Rig(nominal())
    x, u = rig.static.x, rig.static.u
    ((ahead,),) = rig.tangent(x, u, ["wc_x@L"], ["lateral_L"])
    outputs = ["wc_x@L", "wc_y@L", "wc_z@L", "toe@L", "camber@L", "spin@L"]
    by_drive = rig.tangent(x, u, outputs, ["drive_L"])[:, 0]
    y = dict(zip(rig.kernel.layout.output_names, rig.static.y, strict=True))
    toe, camber = np.radians(y["toe@L"]), np.radians(y["camber@L"])
    # the wheel's rotation about x from the spin axis s = (-sin toe, -cos toe, -tan camber) cos camber
    d_toe, d_camber, d_spin = np.radians(by_drive[3:])
    arm = np.array([y[f"cp_{a}@L"] - y[f"wc_{a}@L"] for a in "xyz"])
    spin = np.array([-np.sin(toe) * np.cos(camber), -np.cos(toe) * np.cos(camber), -np.sin(camber)])
    d_spin_axis = d_toe * np.array([-np.cos(toe), np.sin(toe), 0.0]) * np.cos(camber) + d_camber * np.array(
        [np.sin(toe) * np.sin(camber), np.cos(toe) * np.sin(camber), -np.cos(camber)]
    )
    # w = s x ds + a s; the part along s follows from the kingpin line's turn in side view
    w = np.cross(spin, d_spin_axis)
    k = kingpin(rig)
    rate = line_angle_rate(k, w), line_angle_rate(k, spin)
    w = w + (d_spin - rate[0]) / rate[1] * spin
    sideways = by_drive[1] + np.cross(w, arm)[1]
    assert ahead == pytest.approx(-sideways, rel=1e-6)


def kingpin(rig: Rig) -> np.ndarray:
    from tests.solver.independent import poses, position

    knuckle = poses(rig.axle, rig.kernel, rig.static.x)["knuckle.L"]
    return knuckle.rotation.apply(position(rig.axle, "UPB", "L") - position(rig.axle, "LWB", "L"))


def line_angle_rate(line: np.ndarray, w: np.ndarray) -> float:
    """d atan2(x, z) of a line that turns with w."""
    d = np.cross(w, line)
    return float((d[0] * line[2] - line[0] * d[2]) / (line[0] ** 2 + line[2] ** 2))


def test_a_one_sided_coupling_would_be_noticed() -> None:
    """The same axle, read with a wrong conjugate, is far from symmetric."""
    rig = Rig(replace(nominal()))
    wrong = ("wc_y@L", *CONJUGATES[1:])
    hessian = rig.tangent(rig.static.x, rig.static.u, wrong, INPUTS) * SCALE * SCALE[:, None]
    assert np.abs(hessian - hessian.T).max() > 1e-3 * np.abs(hessian).max()
