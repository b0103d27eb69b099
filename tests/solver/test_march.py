"""The march follows one path: no snap passes for a result, corners and reversals of friction are met."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from doe_kc.axle import Axle, parameter_value, with_values
from doe_kc.axle.model import HARDPOINTS
from doe_kc.effects import apply_effect
from doe_kc.ground.typing import FloatArray
from doe_kc.load_cases import LoadCase
from doe_kc.solver import suite
from doe_kc.solver.curve_set import curve_set
from doe_kc.solver.library import find_compiler
from doe_kc.solver.suite import branch_inputs, solve
from tests.reference import common_rows, nominal, step_rows

needs_compiler = pytest.mark.skipif(find_compiler() is None, reason="no C compiler here")


def with_steps(axle: Axle, case: str, steps: int, amplitude: float | None = None) -> Axle:
    only = replace(axle.load_cases[case], steps=steps)
    return replace(axle, load_cases={case: only if amplitude is None else replace(only, amplitude=amplitude)})


def scattered(seed: int) -> Axle:
    rng, axle = np.random.default_rng(seed), nominal()
    paths = [f"{name}.{axis}" for name in HARDPOINTS if name not in axle.follow for axis in "xyz"]
    return with_values(axle, {p: parameter_value(axle, p) + rng.uniform(-60.0, 60.0) for p in paths})


SNAPPING = (77, 105, 176, 203)
"""Scattered axles whose steering folds over between two of the default steps."""


@pytest.mark.parametrize("seed", [*SNAPPING, 1, 2])
def test_coarse_and_fine_steps_end_alike(seed: int) -> None:
    axle = scattered(seed)
    coarse, fine = (
        solve(with_steps(axle, "steer", steps), compiled=False, throw=False) for steps in (30, 120)
    )
    assert (coarse.failure is None) == (fine.failure is None)
    if coarse.failure is not None and fine.failure is not None:
        assert coarse.failure.cause.startswith("over-centre")
        assert coarse.failure.last_input == pytest.approx(fine.failure.last_input, abs=0.5)
    else:
        assert seed not in SNAPPING
        for a, b in zip(coarse.cases["steer"].branches, fine.cases["steer"].branches, strict=True):
            np.testing.assert_allclose(b.y[::4], a.y, rtol=1e-9, atol=1e-6)


@needs_compiler
@pytest.mark.parametrize("effect", ["", "strut_friction", "tie_rod_free_play"])
def test_compiled_and_interpreted_take_the_same_steps(effect: str) -> None:
    axle = scattered(77)
    if effect:
        axle = apply_effect(nominal(), effect, {}, source="test")
    one, other = (solve(axle, ["vertical", "steer"], compiled=c, throw=False) for c in (None, False))
    assert (one.failure is None) == (other.failure is None)
    if one.failure is not None and other.failure is not None:
        assert str(one.failure) == str(other.failure)
    for case, solved in one.cases.items():
        for a, b in zip(solved.branches, other.cases[case].branches, strict=True):
            np.testing.assert_allclose(a.path.counts, b.path.counts, rtol=0.02, atol=2)
            np.testing.assert_allclose(a.x, b.x, rtol=1e-9, atol=1e-9)
            if a.path.between is not None and b.path.between is not None:
                np.testing.assert_array_equal(a.path.between.share, b.path.between.share)
                np.testing.assert_allclose(a.path.between.z, b.path.between.z, rtol=1e-7, atol=1e-7)


@pytest.mark.parametrize(("law", "force"), [("dahl", 200.0), ("iwan", 600.0)])
def test_a_lifted_wheel_held_by_friction_does_not_depend_on_the_steps(law: str, force: float) -> None:
    """In roll one wheel lifts off; at touch-down its strut reverses inside a step."""
    axle = apply_effect(nominal(), "strut_friction", {"force_N": force, "law": law}, source="test")
    axle = with_steps(axle, "roll", 24, 12.0)
    coarse, fine = (
        solve(with_steps(axle, "roll", 24 * n, 12.0), compiled=False).cases["roll"].branches for n in (1, 8)
    )
    load = solve(axle, compiled=False).column("tyre_load@L")
    assert min(b.y[:, load].min() for b in coarse) == 0.0
    for a, b in zip(coarse, fine, strict=True):
        rows, same = common_rows(a.input, b.input)
        assert np.abs(a.y[rows, load] - b.y[same, load]).max() < 0.02 * force / 4


def test_what_is_driven_before_the_loop_needs_half_the_equilibria(monkeypatch: pytest.MonkeyPatch) -> None:
    """Of curves that noise of 5 N and 0.002 deg covers on a rig."""
    axle = nominal().conditioned(1)
    for ident, options in (
        ("rubber_hysteresis", {"share": 0.2}),
        ("strut_friction", {"force_N": 150.0, "law": "iwan"}),
        ("steering_friction", {"force_N": 200.0}),
    ):
        axle = apply_effect(axle, ident, options, source="test")
    found = curve_set(solve(axle))

    def all_inputs(case: LoadCase, *, loop: bool) -> dict[str, FloatArray]:
        own = branch_inputs(case, loop=loop)
        assert loop and own["unload_1"].size == case.steps + 1 < own["unload"].size
        first = case.inputs()[case.steps :]
        return own | {"init": first, "unload_1": own["unload"], "load_1": own["load"]}

    monkeypatch.setattr(suite, "branch_inputs", all_inputs)
    exact = curve_set(solve(axle))
    for ident, case in exact.cases.items():
        for response, off in (("toe", 1e-5), ("wc_x", 1e-4), ("tyre_load", 0.05)):
            for kind in ("mean", "half_width"):
                one, other = (getattr(c, kind)[response] for c in (found.cases[ident], case))
                np.testing.assert_allclose(one, other, rtol=0.0, atol=off, err_msg=f"{ident} {response}")


def test_a_loop_is_as_smooth_at_its_ends_as_with_a_quarter_of_the_step() -> None:
    """Beside full lock the rack turns round within a few degrees of the wheel, less than a step."""
    axle = apply_effect(nominal(), "steering_friction", {"force_N": 400.0}, source="test")
    curves = [
        curve_set(solve(with_steps(axle, "steer", n), compiled=False)).cases["steer"] for n in (30, 120)
    ]
    coarse, fine = (c.mean["toe"][0] for c in curves)
    at = 0.97 * axle.load_cases["steer"].amplitude * np.array([-1.0, 1.0])
    inputs, exact = curves[0].input, np.interp(at, curves[1].input, fine)
    assert np.abs(np.interp(at, inputs, coarse) - exact).max() < 2e-3
    rows = step_rows(inputs, with_steps(axle, "steer", 30).load_cases["steer"])
    assert np.abs(np.interp(at, inputs[rows], coarse[rows]) - exact).max() > 5e-3
