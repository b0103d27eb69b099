"""What every axle type owes: mirror images, conserved energy, steps that do not matter, exact derivatives."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache

import numpy as np
import pytest

from doe_kc.axle import Axle, with_values
from doe_kc.solver.elements.responses import OUTPUT_UNITS
from doe_kc.solver.result import Solution
from doe_kc.solver.sensitivity import sensitivities
from doe_kc.solver.suite import solve
from tests.axle_type_reference import TYPES, nominal
from tests.solver.tangent import Rig
from tests.solver.test_sensitivity import TIGHT, tight, worst

LATERAL = ("wc_y", "cp_y")
SYMMETRIC, ANTISYMMETRIC = ("vertical", "lateral_opposite", "brake"), ("roll", "lateral", "steer")
STEPS = 4


@lru_cache
def short(axle_type: str) -> Axle:
    axle = nominal(axle_type)
    wanted = (*SYMMETRIC, *ANTISYMMETRIC)
    cases = {i: replace(c, steps=STEPS) for i, c in axle.load_cases.items() if i in wanted}
    return replace(axle, load_cases=cases)


@lru_cache
def solution(axle_type: str) -> Solution:
    return solve(short(axle_type), compiled=False, settings=TIGHT)


def mirrored(axle: Axle) -> Axle:
    """The axle's mirror image: its single points go to the other side."""
    structure = axle.topology.structure
    values = {f"{p}.y": -axle.values[f"{p}.y"] for p in structure.single_points}
    return axle.changed(values)


def curves(solved: Solution, case: str, side: str) -> np.ndarray:
    """(branches, n, outputs) of a side in left-hand coordinates."""
    names = [n for n in OUTPUT_UNITS if f"{n}@L" in solved.output_names]
    columns = [solved.column(f"{n}@{side}") for n in names]
    signs = np.array([-1.0 if side == "R" and n in LATERAL else 1.0 for n in names])
    return np.array([b.y[:, columns] * signs for b in solved.cases[case].branches])


@pytest.mark.parametrize("axle_type", TYPES)
def test_the_mirror_image_of_an_axle_has_mirrored_curves(axle_type: str) -> None:
    ours, theirs = solution(axle_type), solve(mirrored(short(axle_type)), compiled=False, settings=TIGHT)
    tolerance = {"rtol": 0.0, "atol": 1e-6}
    for case in ours.cases:
        left, right = curves(ours, case, "L"), curves(theirs, case, "R")
        turned = right if case in SYMMETRIC else right[::-1]
        np.testing.assert_allclose(left, turned, **tolerance)
    left, right = curves(ours, "roll", "L"), curves(ours, "roll", "R")
    assert np.abs(left - right).max() > 0.1


@pytest.mark.parametrize("axle_type", TYPES)
def test_twice_the_steps_give_the_same_points(axle_type: str) -> None:
    axle, coarse = short(axle_type), solution(axle_type)
    finer = {i: replace(c, steps=2 * c.steps) for i, c in axle.load_cases.items()}
    fine = solve(replace(axle, load_cases=finer), compiled=False, settings=TIGHT)
    for ident, case in coarse.cases.items():
        for ours, theirs in zip(case.branches, fine.cases[ident].branches, strict=True):
            np.testing.assert_allclose(ours.y, theirs.y[::2], rtol=1e-8, atol=1e-6)


SCALE = np.array([1e3, 1e3, 1.0, 1.0])
"""1 kN and 1 mm as units."""


@pytest.mark.parametrize("axle_type", TYPES)
def test_an_axle_without_friction_stores_energy(axle_type: str) -> None:
    """Its tangents are symmetric, at rest and loaded: drive force with -wc_x, pad height with tyre load."""
    rig = Rig(nominal(axle_type))
    path = rig.path([{"pad_L": 25.0, "pad_R": -15.0, "drive_L": 1500.0, "drive_R": -800.0}], 12)
    outputs = ("wc_x@L", "wc_x@R", "tyre_load@L", "tyre_load@R")
    inputs = ("drive_L", "drive_R", "pad_L", "pad_R")
    for x, u in ((rig.static.x, rig.static.u), (path.x[-1], rig.u[-1])):
        hessian = rig.tangent(x, u, outputs, inputs) * SCALE * SCALE[:, None]
        np.testing.assert_allclose(hessian, hessian.T, rtol=0, atol=1e-9 * np.abs(hessian).max())
        assert np.abs(hessian - np.diag(np.diag(hessian))).max() > 1.0


@pytest.mark.parametrize("axle_type", TYPES)
def test_a_closed_loop_gives_its_state_back(axle_type: str) -> None:
    rig = Rig(nominal(axle_type))
    loaded = {"pad_L": 20.0, "pad_R": -10.0, "lateral_L": 1000.0, "brake_R": 500.0}
    path = rig.path([loaded, {"pad_L": 20.0, "brake_R": 500.0}, {}], 8)
    assert np.abs(path.y[:8] - rig.static.y).max() > 1.0
    np.testing.assert_allclose(path.y[-1], rig.static.y, rtol=0, atol=1e-6)


PATHS = {
    "double_wishbone_front": ("UBJ.z", "LWS.x", "RIB.z", "right.llf.Fx", "ulr.Tx", "scb.Tz", "spring.rate"),
    "five_link_rear": ("TLO.z", "SLI.x", "WLC.y", "right.lfi.Fx", "slo.Ty", "static.camber", "arb.radius"),
    "rigid_rear": ("LLA.z", "PHB.y", "left.ULB.x", "phb.Fx", "lla.Fx", "tyre.rate", "spring.rate"),
    "semi_trailing_rear": ("AIB.z", "UPS.x", "right.AOB.x", "aob.Fx", "sfr.Fz", "ride_height", "static.toe"),
    "twist_beam_rear": ("TAB.z", "BC.z", "beam_joint.Ty", "right.tab.Fy", "DLO.x", "bump_stop.clearance"),
}
"""Points, bushings, one side alone, and what every axle has."""


@pytest.mark.parametrize("axle_type", TYPES)
def test_sensitivities_are_exact(axle_type: str) -> None:
    axle = short(axle_type)
    cases = {i: c for i, c in axle.load_cases.items() if i in ("vertical", "lateral", "steer")}
    axle = with_values(replace(axle, load_cases=cases), {})
    exact = sensitivities(axle, tight(axle), PATHS[axle_type])
    for path in PATHS[axle_type]:
        ratio, where = worst(axle, exact, path)
        assert ratio < 1e-5, f"{path}: {ratio:.2g} at {where}"
