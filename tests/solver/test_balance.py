"""Force and moment balance of the whole axle, reactions recomputed in numpy from the state alone."""

from __future__ import annotations

import numpy as np
import pytest

from doe_kc.load_cases import CASE_ORDER
from doe_kc.solver.kernel import kernel
from doe_kc.solver.result import Solution
from doe_kc.solver.suite import solve
from tests.reference import nominal, variant
from tests.solver.independent import evaluate, position

FORCE, MOMENT = 1e-5, 1e-2
"""N and N mm."""


@pytest.fixture(scope="module", params=["nominal", "variant 2", "one side stiffer"])
def solved(request: pytest.FixtureRequest):
    from doe_kc.axle import with_values

    axle = {
        "nominal": nominal,
        "variant 2": lambda: variant(2),
        "one side stiffer": lambda: with_values(nominal(), {"right.LLR.y": 374.0, "left.llf.Fx": 0.5}),
    }[request.param]()
    return axle, solve(axle, compiled=False)


def external(control: dict[str, float], y: dict[str, float]) -> tuple[np.ndarray, np.ndarray]:
    """Sum of tyre and applied forces, and their moment about the chassis origin."""
    roll = control["roll"]
    normal = np.array([0.0, -np.sin(roll), np.cos(roll)])
    force, moment = np.zeros(3), np.zeros(3)
    for side in ("L", "R"):
        contact = np.array([y[f"cp_{a}@{side}"] for a in "xyz"])
        centre = np.array([y[f"wc_{a}@{side}"] for a in "xyz"])
        behind = contact + np.array([control["lateral_offset"], 0.0, 0.0])
        for f, at in (
            (y[f"tyre_load@{side}"] * normal, contact),
            (np.array([control[f"brake_{side}"], 0.0, 0.0]), contact),
            (np.array([0.0, control[f"lateral_{side}"], 0.0]), behind),
            (np.array([-control[f"drive_{side}"], 0.0, 0.0]), centre),
        ):
            force, moment = force + f, moment + np.cross(at, f)
    return force, moment


def unbalanced(axle, solution: Solution, case: str) -> tuple[float, float]:
    k = kernel(axle.topology)
    forces, moments = [], []
    for branch in solution.cases[case].branches:
        for row in (0, len(branch.x) // 2, -1):
            control = dict(zip(k.layout.control_names, branch.u[row], strict=True))
            y = dict(zip(solution.output_names, branch.y[row], strict=True))
            force, moment = external(control, y)
            state = evaluate(axle, k, branch.x[row], branch.u[row])
            for reaction, at in state.reactions:
                force, moment = force + reaction, moment + np.cross(at, reaction)
            moment = moment + sum(state.couples)
            forces.append(np.abs(force).max())
            moments.append(np.abs(moment).max())
    return max(forces), max(moments)


@pytest.mark.parametrize("case", CASE_ORDER)
def test_forces_and_moments_of_the_whole_axle_sum_to_zero(solved, case: str) -> None:
    axle, solution = solved
    force, moment = unbalanced(axle, solution, case)
    assert force < FORCE
    assert moment < MOMENT


def test_the_balance_notices_a_missing_force(solved) -> None:
    axle, solution = solved
    k = kernel(axle.topology)
    branch = solution.cases["lateral"].branches[0]
    state = evaluate(axle, k, branch.x[-1], branch.u[-1])
    y = dict(zip(solution.output_names, branch.y[-1], strict=True))
    no_lateral = dict.fromkeys(k.layout.control_names, 0.0)
    force, _ = external(no_lateral, y)
    assert np.abs(force + sum(f for f, _ in state.reactions))[1] == pytest.approx(4000.0, rel=1e-6)


def test_the_independent_poses_give_the_solver_s_wheel_centre(solved) -> None:
    axle, solution = solved
    k = kernel(axle.topology)
    for case in solution.cases.values():
        branch = case.branches[0]
        state = evaluate(axle, k, branch.x[-1], branch.u[-1])
        for side in ("L", "R"):
            centre = state.poses[f"knuckle.{side}"].point(position(axle, "WLC", side))
            found = [branch.y[-1][solution.column(f"wc_{a}@{side}")] for a in "xyz"]
            np.testing.assert_allclose(centre, found, rtol=0, atol=1e-9)
