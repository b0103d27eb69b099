"""Designs without an equilibrium fail as a value that says where, and with throw=True as NotConverged."""

from __future__ import annotations

import tomllib
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import numpy as np
import pytest

from doe_kc.axle import Axle, with_values
from doe_kc.axle_file.read import axle_from_document
from doe_kc.effects import apply_effect
from doe_kc.ground.errors import DoeKcError, RunError
from doe_kc.solver.diagnosis import unresisted
from doe_kc.solver.equilibria import Halt
from doe_kc.solver.kernel import kernel
from doe_kc.solver.newton import NewtonSettings
from doe_kc.solver.result import Failure, NotConverged
from doe_kc.solver.suite import solve
from tests.reference import EXAMPLE, nominal

STEER = replace(nominal().load_cases["steer"], amplitude=3600.0)


def far_steer() -> Axle:
    """A rack that travels half a metre: the tie rod cannot follow."""
    return replace(nominal(), load_cases={**nominal().load_cases, "steer": STEER})


def test_the_reason_names_load_case_step_input_last_equilibrium_and_cause() -> None:
    found = solve(far_steer(), ["vertical", "steer"], compiled=False, throw=False)
    failure = found.failure
    assert failure is not None
    assert failure.load_case == "steer"
    assert failure.branch == "pos"
    assert failure.input_unit == "deg"
    assert failure.input == pytest.approx(failure.step * 3600.0 / 30)
    assert 400.0 < failure.input < 3600.0
    assert failure.input - 3600.0 / 30 <= failure.last_input < failure.input
    assert failure.cause.startswith("over-centre: ")
    text = str(failure)
    for part in (
        "steer",
        "pos",
        f"step {failure.step}",
        f"{failure.input:g} deg",
        f"last equilibrium at {failure.last_input:g} deg",
        failure.deflection,
        failure.cause,
    ):
        assert part in text
    # it stands where fine steps end too
    case = found.cases["vertical"].load_case
    axle = replace(far_steer(), load_cases={"vertical": case, "steer": replace(STEER, steps=240)})
    fine = solve(axle, ["steer"], compiled=False, throw=False).failure
    assert fine is not None
    assert fine.last_input == pytest.approx(failure.last_input, abs=1.5)


def test_what_was_solved_before_the_failure_is_kept() -> None:
    found = solve(far_steer(), ["vertical", "steer", "drive"], compiled=False, throw=False)
    assert set(found.cases) == {"vertical"}
    assert found.static is not None


@pytest.mark.parametrize("threads", [1, 3])
def test_a_failure_beside_other_load_cases_is_the_one_that_comes_first(threads: int) -> None:
    """Of more load cases than there are lanes, in one thread and in several."""
    axle = far_steer()
    others = [name for name in axle.load_cases if name not in ("vertical", "steer", "drive")]
    cases = ["vertical", "steer", "drive", *others]
    with ThreadPoolExecutor(threads) as pool:
        beside = solve(axle, cases, throw=False, lanes=True, pool=pool if threads > 1 else None)
    alone = solve(axle, cases, throw=False)
    assert beside.failure is not None
    assert str(beside.failure) == str(alone.failure)
    assert list(beside.cases) == list(alone.cases) == ["vertical"]


def test_throw_raises_not_converged_with_the_failure() -> None:
    with pytest.raises(NotConverged) as caught:
        solve(far_steer(), ["steer"], compiled=False)
    assert isinstance(caught.value, RunError)
    assert isinstance(caught.value, DoeKcError)
    assert caught.value.exit_code == 1
    assert isinstance(caught.value.failure, Failure)
    assert str(caught.value) == str(caught.value.failure)


def test_a_static_failure_says_so() -> None:
    found = solve(nominal(), compiled=False, throw=False, settings=NewtonSettings(max_iterations=0))
    assert found.failure is not None
    assert found.static is None
    assert found.cases == {}
    assert str(found.failure).startswith("no equilibrium: static equilibrium, ")


def test_a_load_that_the_axle_cannot_carry_names_its_share() -> None:
    """Newton's method alone finds a state beyond a fold, with the wheels turned over."""
    mounts = ("llf", "llr", "sff", "sfr", "upb")
    soft = with_values(nominal(), {f"{b}.F{a}": 0.007 for b in mounts for a in "xyz"})
    found = solve(soft, compiled=False, throw=False).failure
    assert found is not None
    assert found.cause.startswith("too soft: it carries ")
    assert 0.0 < found.last_input < 1.0
    assert f"{100 * found.last_input:.3g} % of the static load" in str(found)


def test_what_nothing_resists_is_named() -> None:
    """A top mount without any resistance to turning: the rod may twist as it likes."""
    document = tomllib.loads((EXAMPLE / "axle.toml").read_text())
    for resists in (True, False):
        line = [[-5.0, -20.0 * resists], [5.0, 20.0 * resists]]
        document["bushings"]["upb"]["table"] = {"Tx": line, "Ty": line, "Tz": line}
        axle = axle_from_document(document, source="test")
        k = kernel(axle.topology)
        design = Halt(0.0, np.zeros(k.nx), np.zeros(k.nu), np.zeros(k.nz), 0.0)
        active = k.nx - k.layout.tail
        found = unresisted(k, k.constant_values(dict(axle.values)), design, active)
        assert found == "" if resists else found.startswith("strut twist ")


def test_where_newton_fails_the_load_is_ramped_up() -> None:
    soft = with_values(nominal(), {f"{b}.F{a}": 0.01 for b in ("llf", "llr") for a in "xyz"})
    direct = solve(soft, [], compiled=False)
    ramped = solve(soft, [], compiled=False, settings=NewtonSettings(max_iterations=6))
    assert direct.static is not None
    assert ramped.static is not None
    np.testing.assert_allclose(ramped.static.y, direct.static.y, rtol=1e-9, atol=1e-6)


@pytest.mark.parametrize(
    "values",
    [
        {"ROB.x": 152.0, "ROB.y": -350.0, "ROB.z": 279.0},  # on RIB
        {"LWD.x": 40.0, "LWD.y": -575.0, "LWD.z": 860.0},  # on UPB
        {"LLF.x": 300.0, "LLF.y": -370.0, "LLF.z": 218.0},  # on LLR
        {"WLC.z": -5000.0},
        {"tyre.static_load": 1e9},
        {"LWB.z": 2000.0},
        {"RIB.x": -1500.0},
    ],
    ids=["no tie rod", "no strut axis", "no pivot axis", "underground", "heavy", "inside out", "long rod"],
)
def test_impossible_designs_are_a_value_never_an_exception(values: dict[str, float]) -> None:
    found = solve(with_values(nominal(), values), compiled=False, throw=False)
    if found.failure is not None:
        assert found.failure.deflection
        assert found.failure.cause
        assert found.failure.load_case in str(found.failure)


@pytest.mark.parametrize(
    "values",
    [{"ROB.x": 152.0, "ROB.y": -350.0, "ROB.z": 279.0}, {"LWD.x": 40.0, "LWD.y": -575.0, "LWD.z": 860.0}],
    ids=["no tie rod", "no strut axis"],
)
def test_coincident_points_do_not_pass_for_a_solution(values: dict[str, float]) -> None:
    assert solve(with_values(nominal(), values), compiled=False, throw=False).failure is not None


def test_a_huge_gap_still_ends_in_a_value() -> None:
    axle = apply_effect(nominal(), "tie_rod_free_play", {"gap_mm": 200.0}, source="test")
    found = solve(axle, compiled=False, throw=False)
    assert found.failure is None or found.failure.load_case


@pytest.mark.parametrize("factor", [100.0, 300.0, 1000.0])
def test_a_rigidly_bolted_sub_frame_is_no_failure(factor: float) -> None:
    """1e6 to 1e7 N/mm, where rounding alone is more than the tolerance of the residual."""
    values = {f"{name}.F{axis}": factor for name in ("sff", "sfr") for axis in "xyz"}
    found = solve(with_values(nominal(), values), compiled=False, throw=False)
    assert found.failure is None, str(found.failure)
