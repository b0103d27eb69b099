"""Mirror symmetry, independence of the path, loops with friction, effects in their limits."""

from __future__ import annotations

import tomllib
from dataclasses import replace

import numpy as np
import pytest

from doe_kc.axle import Axle, with_values
from doe_kc.axle.model import BUSHINGS
from doe_kc.axle_file.read import axle_from_document
from doe_kc.effects import apply_effect
from doe_kc.load_cases import LoadCase
from doe_kc.load_cases.roll import ROLL_TECHNIQUES
from doe_kc.solver.elements.responses import OUTPUT_UNITS
from doe_kc.solver.newton import NewtonSettings
from doe_kc.solver.result import Solution
from doe_kc.solver.suite import solve
from tests.reference import EXAMPLE, common_rows, nominal
from tests.solver.tangent import Rig

LATERAL = ("wc_y", "cp_y")
SYMMETRIC = ("vertical", "lateral_opposite", "drive", "brake")
ANTISYMMETRIC = ("roll", "lateral", "lateral_offset", "steer")


@pytest.fixture(scope="module")
def solution() -> Solution:
    return solve(nominal(), compiled=False)


def curves(solution: Solution, case: str, side: str) -> np.ndarray:
    """(branches, n, outputs) of a side in left-hand coordinates."""
    columns = [solution.column(f"{n}@{side}") for n in OUTPUT_UNITS]
    signs = np.array([-1.0 if side == "R" and n in LATERAL else 1.0 for n in OUTPUT_UNITS])
    return np.array([b.y[:, columns] * signs for b in solution.cases[case].branches])


@pytest.mark.parametrize("case", SYMMETRIC)
def test_left_equals_right_in_symmetric_load_cases(solution: Solution, case: str) -> None:
    np.testing.assert_allclose(curves(solution, case, "L"), curves(solution, case, "R"), rtol=0, atol=1e-6)


@pytest.mark.parametrize("case", ANTISYMMETRIC)
def test_left_with_plus_equals_right_with_minus(solution: Solution, case: str) -> None:
    left, right = curves(solution, case, "L"), curves(solution, case, "R")
    np.testing.assert_allclose(left, right[::-1], rtol=0, atol=1e-6)
    assert np.abs(left - right).max() > 0.1


UNLIKE = {
    **{
        axis: [[-4.0, -9e3], [-1.0, -4e3], [0.0, 200.0], [2.0, 1.2e4], [4.0, 4e4]]
        for axis in ("Fx", "Fy", "Fz")
    },
    **{
        axis: [[-4.0, -90.0], [-1.0, -40.0], [0.0, 15.0], [2.0, 200.0], [4.0, 900.0]]
        for axis in ("Tx", "Ty", "Tz")
    },
}
"""Tables that are not odd: unlike in compression and extension, with a force at rest."""


@pytest.mark.parametrize("bushing", BUSHINGS)
@pytest.mark.parametrize("kind", "FT")
def test_a_table_that_is_not_odd_is_mirrored(bushing: str, kind: str) -> None:
    document = tomllib.loads((EXAMPLE / "axle.toml").read_text())
    document["bushings"][bushing]["table"] = {a: t for a, t in UNLIKE.items() if a[0] == kind}
    axle = axle_from_document(document, source="test")
    found = solve(axle, ["vertical", "steer"], compiled=False)
    plain = solve(nominal(), ["vertical"], compiled=False)
    for case, order in (("vertical", 1), ("steer", -1)):
        left, right = curves(found, case, "L"), curves(found, case, "R")[::order]
        np.testing.assert_allclose(left, right, rtol=0, atol=1e-6)
    assert np.abs(curves(found, "vertical", "L") - curves(plain, "vertical", "L")).max() > 1e-3


def test_counter_phase_roll_is_antisymmetric_and_rolls_the_same_way() -> None:
    axle = replace(
        nominal(), load_cases={"roll": nominal().load_cases["roll"], "pads": ROLL_TECHNIQUES["counter_phase"]}
    )
    found = solve(axle, compiled=False)
    left, right = curves(found, "pads", "L"), curves(found, "pads", "R")
    np.testing.assert_allclose(left, right[::-1], rtol=0, atol=1e-6)
    load = found.column("tyre_load@R")
    for case in ("roll", "pads"):
        up = found.cases[case].branches[0].y[:, load]
        assert up[1] > up[0]


def test_a_right_side_override_breaks_the_symmetry() -> None:
    found = solve(with_values(nominal(), {"right.llr.Fx": 1.5}), ["drive"], compiled=False)
    assert np.abs(curves(found, "drive", "L") - curves(found, "drive", "R")).max() > 0.01


def test_an_axle_with_its_sides_swapped_gives_mirrored_curves() -> None:
    cases = ["vertical", "roll", "steer", "brake"]
    one = with_values(nominal(), {"right.llr.Fx": 1.5, "right.ROB.y": 711.0})
    other = with_values(nominal(), {"left.llr.Fx": 1.5, "left.ROB.y": -711.0})
    a, b = solve(one, cases, compiled=False), solve(other, cases, compiled=False)
    for case in cases:
        mirrored = curves(b, case, "R")
        if case in ANTISYMMETRIC:
            mirrored = mirrored[::-1]
        np.testing.assert_allclose(curves(a, case, "L"), mirrored, rtol=0, atol=1e-6)


def test_the_same_point_by_another_path() -> None:
    rig = Rig(nominal())
    there = {"pad_L": 30.0, "pad_R": -20.0, "lateral_L": 1500.0, "brake_R": 1000.0, "rack": 15.0}
    direct = rig.path([there], 10)
    detour = rig.path([{"pad_L": -40.0, "lateral_R": -1000.0}, {"rack": -40.0, "roll": 0.03}, there], 7)
    np.testing.assert_allclose(direct.y[-1], detour.y[-1], rtol=1e-9, atol=1e-7)


def with_steps(axle: Axle, factor: int) -> Axle:
    cases: dict[str, LoadCase] = {i: replace(c, steps=c.steps * factor) for i, c in axle.load_cases.items()}
    return replace(axle, load_cases=cases)


def test_twice_the_steps_give_the_same_points(solution: Solution) -> None:
    fine = solve(with_steps(nominal(), 2), compiled=False)
    for case, coarse in solution.cases.items():
        for a, b in zip(coarse.branches, fine.cases[case].branches, strict=True):
            np.testing.assert_allclose(b.y[::2], a.y, rtol=1e-9, atol=1e-7)


@pytest.mark.parametrize("law", ["dahl", "iwan"])
@pytest.mark.parametrize(
    ("effect", "case", "output"),
    [("steering_friction", "steer", "column_force"), ("strut_friction", "vertical", "tyre_load@L")],
)
def test_friction_opens_a_closed_loop(law: str, effect: str, case: str, output: str) -> None:
    axle = apply_effect(nominal(), effect, {"law": law}, source="test")
    found = solve(axle, [case], compiled=False)
    init, unload, load = found.cases[case].branches
    column = found.column(output)
    # continuous at the reversals, state included
    np.testing.assert_array_equal(unload.x[0], init.x[-1])
    np.testing.assert_array_equal(unload.z[0], init.z[-1])
    np.testing.assert_array_equal(load.z[0], unload.z[-1])
    # closed: what was left at +A is met again
    np.testing.assert_allclose(load.y[-1], unload.y[0], rtol=1e-6, atol=1e-3)
    zero = len(load.input) // 2
    assert load.input[zero] == 0.0
    assert unload.input[zero] == 0.0
    half_width = (load.y[zero, column] - unload.y[zero, column]) / 2
    expected = {"steering_friction": 250.0, "strut_friction": 100.0}[effect]
    assert 0.8 * expected < half_width < 1.3 * expected
    assert np.abs(init.y[0] - found.static.y).max() == 0.0  # type: ignore[union-attr]


def test_a_loop_that_slides_little_closes_only_after_another() -> None:
    """In steer the strut moves by millimetres, so that the static state is not forgotten at once."""
    axle = apply_effect(nominal(), "strut_friction", {"force_N": 200.0}, source="test")
    open_end = []
    for loops in (0, 1, 2):
        found = solve(axle.conditioned(loops), ["steer"], compiled=False)
        case, column = found.cases["steer"], found.column("tyre_load@L")
        assert [b.name for b in case.branches[-2:]] == ["unload", "load"]
        assert len(case.branches) == 3 + 2 * loops
        *_, unload, load = case.branches
        open_end.append(abs(load.y[-1, column] - unload.y[0, column]))
    assert open_end[0] > 5.0
    assert open_end[1] < 0.3 * open_end[0]
    assert open_end[2] < open_end[1]


def test_half_the_friction_is_nearly_half_the_loop() -> None:
    widths = []
    for force in (50.0, 100.0):
        axle = apply_effect(nominal(), "steering_friction", {"force_N": force}, source="test")
        found = solve(axle, ["steer"], compiled=False)
        _, unload, load = found.cases["steer"].branches
        column, zero = found.column("toe@L"), len(load.input) // 2
        widths.append(abs(load.y[zero, column] - unload.y[zero, column]))
    assert widths[1] / widths[0] == pytest.approx(2.0, rel=0.02)


LIMITS = {
    "hub_compliance": {"camber_Nm_deg": 1e10, "toe_Nm_deg": 1e10},
    "strut_bending": {"k_Nm_deg": 1e10, "torsion_Nm_deg": 1e10},
    "rack_mount_compliance": {"k_N_mm": 1e11},
    "subframe_flexibility": {"scale": 1e6},
    "tyre_horizontal_compliance": {"k_lat_N_mm": 1e11, "k_long_N_mm": 1e11},
    "steer_arm_compliance": {"radius_mm": 2000.0},
    "steering_friction": {"force_N": 1e-6},
    "rubber_hysteresis": {"share": 1e-8},
    "strut_friction": {"force_N": 1e-6},
    "bushing_preload": {"LLR": [0.0, 0.0, 0.0]},
    "bushing_progression": {"LLR": [0.01, 0.01, 0.01]},
    "left_right_asymmetry": {"LLR_R": 1.0},
    "ride_height_offset": {"offset_mm": 0.0},
}
STIFF = ("subframe_flexibility",)
TOLERANCE = {"tie_rod_free_play": 2e-2, "hub_compliance": 2e-3}
"""mm and deg. Free play: its contact stays elastic; hub: 1e8 Nm/rad about the spin axis."""


@pytest.mark.parametrize("ident", LIMITS)
def test_an_effect_in_its_limit_is_the_nominal_axle(ident: str, solution: Solution) -> None:
    axle = apply_effect(nominal(), ident, LIMITS[ident], source="test")
    # in the stiffest limits the rounding of a coordinate weighs 1e-3 N
    found = solve(axle, compiled=False, settings=NewtonSettings(tol=1e-2 if ident in STIFF else 1e-7))
    names = [f"{n}@{s}" for n in ("toe", "camber", "spin", "wc_x", "wc_y", "wc_z") for s in "LR"]
    columns = [solution.column(n) for n in names]
    for case, expected in solution.cases.items():
        branches = found.cases[case].branches
        if branches[0].name == "init":
            pairs = [(branches[0], expected.branches[0])]
        else:
            pairs = list(zip(branches, expected.branches, strict=True))
        for a, b in pairs:
            rows, same = common_rows(a.input, b.input)
            assert rows.all()
            one, other = a.y[rows][:, columns], b.y[same][:, columns]
            np.testing.assert_allclose(one, other, rtol=0, atol=TOLERANCE.get(ident, 1e-4))


def test_free_play_without_a_gap_leaves_the_contact_s_stiffness_alone(solution: Solution) -> None:
    found = solve(
        apply_effect(nominal(), "tie_rod_free_play", {"gap_mm": 1e-6}, source="test"),
        ["drive"],
        compiled=False,
    )
    column, tension = found.column("toe@L"), found.column("tie_rod@L")
    ours, rigid = found.cases["drive"].branches[0].y, solution.cases["drive"].branches[0].y
    # lengthening = tension / 20 kN/mm and the smoothing, on the steer-arm lever of about 120 mm
    stretch = np.abs(rigid[-1, tension]) / 20000.0 + 2e-3
    assert np.abs(ours[:, column] - rigid[:, column]).max() < np.degrees(stretch / 100.0)


def test_absent_effects_cost_no_unknowns() -> None:
    from doe_kc.solver.kernel import kernel

    sizes = {i: kernel(apply_effect(nominal(), i, {}, source="t").topology).nx for i in LIMITS}
    base = kernel(nominal().topology).nx
    assert sizes["bushing_preload"] == sizes["tyre_horizontal_compliance"] == base
    assert sizes["hub_compliance"] == sizes["strut_bending"] == base + 6
    assert sizes["rack_mount_compliance"] == base + 1
    assert sizes["subframe_flexibility"] == base + 12
    assert sizes["steering_friction"] == base
