"""Rubber in the bushings of an axle: absent, vanishing, mirrored, whatever the steps, dissipating, exact."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache

import numpy as np
import pytest

from doe_kc.axle import Axle, parameter_value, with_values
from doe_kc.axle.model import BUSHINGS, FORCE_AXES
from doe_kc.axle.sliders import RUBBER_SLIDERS
from doe_kc.effects import apply_effect
from doe_kc.solver.assembly import assemble
from doe_kc.solver.curve_set import curve_set
from doe_kc.solver.kernel import kernel
from doe_kc.solver.newton import NewtonSettings
from doe_kc.solver.result import Solution
from doe_kc.solver.sensitivity import sensitivities
from doe_kc.solver.suite import solve
from tests.reference import common_rows, nominal, steps_only
from tests.solver.tangent import Rig
from tests.solver.test_energy import work

CASES = {"vertical": 8, "lateral": 6, "lateral_opposite": 6, "brake": 6}
RUBBER = {"share": 0.3, "yield_mm": 0.2}


@lru_cache
def short(factor: int = 1) -> Axle:
    cases = {i: replace(nominal().load_cases[i], steps=factor * n) for i, n in CASES.items()}
    return replace(nominal(), load_cases=cases)


@lru_cache
def rubbery() -> Axle:
    return apply_effect(short(), "rubber_hysteresis", RUBBER, source="test")


@lru_cache
def solved() -> Solution:
    return solve(rubbery(), compiled=False)


def test_an_axle_without_it_has_the_same_equations() -> None:
    assert nominal().topology.rubber == () and not nominal().topology.frictional
    assert not any(".rubber." in name for name in kernel(nominal().topology).layout.parameter_names)
    assert kernel(nominal().topology).nz == 0


def test_states_are_those_of_its_bushings_alone() -> None:
    one = apply_effect(nominal(), "rubber_hysteresis", {"bushings": ["LLR"]}, source="test")
    assert assemble(one.topology).z.numel() == 2 * 3 * RUBBER_SLIDERS
    assert kernel(rubbery().topology).nz == len(BUSHINGS) * 2 * 3 * RUBBER_SLIDERS
    assert kernel(rubbery().topology).nx == kernel(nominal().topology).nx


def test_with_next_to_none_of_it_the_axle_is_the_plain_one() -> None:
    faint = apply_effect(short(), "rubber_hysteresis", {"share": 1e-9}, source="test")
    one, other = (
        steps_only(curve_set(solve(faint, compiled=False)), faint),
        curve_set(solve(short(), compiled=False)),
    )
    for ident, case in one.cases.items():
        for response, mean in case.mean.items():
            np.testing.assert_allclose(mean, other.cases[ident].mean[response], rtol=0, atol=1e-5)
            np.testing.assert_allclose(case.half_width[response], 0.0, atol=1e-5)


def test_loops_open_where_bushings_work_and_half_of_it_is_nearly_half() -> None:
    weak = ({"share": share, "yield_mm": 0.05} for share in (0.1, 0.05))
    axles = (apply_effect(short(), "rubber_hysteresis", options, source="test") for options in weak)
    widths = [curve_set(solve(axle, ["brake", "lateral"], compiled=False)).cases for axle in axles]
    for case, response, least in (("brake", "wc_x", 0.01), ("lateral", "toe", 0.0005)):
        one, other = (np.abs(w[case].half_width[response]).max() for w in widths)
        assert one > least
        assert other / one == pytest.approx(0.5, abs=0.03)


@pytest.mark.parametrize("case", ["vertical", "lateral_opposite", "brake"])
def test_left_equals_right(case: str) -> None:
    curves = curve_set(solved()).cases[case]
    for response in ("toe", "camber", "wc_x", "tyre_load"):
        for each in (curves.mean[response], curves.half_width[response]):
            np.testing.assert_allclose(each[0], each[1], rtol=0, atol=2e-6)


def test_a_loop_closes_at_once() -> None:
    for case in solved().cases.values():
        init, *_, load = case.branches
        np.testing.assert_allclose(load.y[-1], init.y[-1], rtol=1e-6, atol=2e-3)


def test_twice_the_steps_give_the_same_points() -> None:
    fine = apply_effect(short(2), "rubber_hysteresis", RUBBER, source="test")
    found = solve(fine, compiled=False)
    for ident, case in solved().cases.items():
        for a, b in zip(case.branches, found.cases[ident].branches, strict=True):
            rows, same = common_rows(a.input, b.input)
            np.testing.assert_allclose(b.y[same], a.y[rows], rtol=1e-6, atol=2e-3)
            # an axis that hardly works may reverse inside a step
            np.testing.assert_allclose(b.z[same], a.z[rows], rtol=0, atol=2e-3)


def test_what_a_loop_takes_is_what_the_sliders_dissipate() -> None:
    """Outside: pads and forces times their travel. Inside: strength times slip of every slider."""
    axle = apply_effect(nominal(), "rubber_hysteresis", RUBBER, source="test")
    rig, steps = Rig(axle), 60
    corners = [{"drive_L": f, "drive_R": f} for f in (2000.0, -2000.0, 2000.0)]
    path = rig.path(corners, steps, load_case=True)
    _, down, up = work(rig, path, steps)
    slips = np.abs(np.diff(path.z[steps - 1 :], axis=0)).sum(axis=0)
    taken = float(strengths(axle) @ slips)
    assert taken > 1000.0
    assert down + up == pytest.approx(taken, rel=5e-3)


def strengths(axle: Axle) -> np.ndarray:
    """(nz,) N, in the order of the states."""
    names = [(n, s) for n, s in BUSHING_ORDER for _ in range(3 * RUBBER_SLIDERS)]
    axes = np.repeat(FORCE_AXES, RUBBER_SLIDERS).tolist() * len(BUSHING_ORDER)
    v = axle.values
    return np.array(
        [
            RUBBER["share"] * RUBBER["yield_mm"] / RUBBER_SLIDERS
            * v[f"{n}.{a}@{s}"] * v[f"{n}.stiffness.{a}@{s}"]
            for (n, s), a in zip(names, axes, strict=True)
        ]
    )  # fmt: skip


BUSHING_ORDER = [(name, side) for name in BUSHINGS for side in "LR"]

PATHS = {
    "llr.rubber.share": 3e-5, "llr.rubber.yield": 1e-4, "llr.Fy": 1e-4, "hub.toe": 0.9,
}  # fmt: skip


@pytest.fixture(scope="module")
def differentiated() -> tuple[Axle, Solution, dict[str, list[np.ndarray]]]:
    axle = replace(rubbery(), load_cases={i: rubbery().load_cases[i] for i in ("lateral", "brake")})
    axle = apply_effect(axle, "hub_compliance", {}, source="test")
    axle = apply_effect(axle, "steering_friction", {"law": "lognormal"}, source="test")
    solution = solve(axle, compiled=False, settings=NewtonSettings(tol=1e-9))
    exact = sensitivities(axle, solution, list(PATHS))
    columns = {
        path: [b[:, :, j] for case in exact.branches.values() for b in case] for j, path in enumerate(PATHS)
    }
    return axle, solution, columns


@pytest.mark.parametrize("path", PATHS)
def test_sensitivities_along_the_path(differentiated: tuple, path: str) -> None:
    """Against central differences; a slider that yields between the two makes these wrong, at few points."""
    axle, _, columns = differentiated
    h, value = PATHS[path], parameter_value(axle, path)
    up, down = (
        solve(with_values(axle, {path: value + s * h}), compiled=False, settings=NewtonSettings(tol=1e-9))
        for s in (1, -1)
    )
    pairs = zip(
        [b for case in up.cases.values() for b in case.branches],
        [b for case in down.cases.values() for b in case.branches],
        strict=True,
    )
    numeric = [(a.y - b.y) / (2 * h) for a, b in pairs]
    mine, theirs = np.concatenate(columns[path]), np.concatenate(numeric)
    scale = np.maximum(np.abs(mine).max(axis=0), 1e-3)
    gaps = (np.abs(mine - theirs) / scale).max(axis=1)
    assert np.quantile(gaps, 0.8) < 2e-5
    assert np.quantile(gaps, 0.9) < 1e-2
