"""Every curve of every reference file of the McPherson axle: 1e-5 deg, 1e-4 mm, 0.01 N."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest

from doe_kc.solver.result import BranchSolution, Solution
from doe_kc.solver.suite import solve
from tests.reference import CASE_NAMES, FILES, reference_axle, reference_curves

SIDED = {
    "toe_deg": "toe",
    "camber_deg": "camber",
    "camber_ground_deg": "camber_ground",
    "caster_deg": "caster",
    "caster_knuckle_deg": "spin",
    "kpi_deg": "kpi",
    "wc_x_mm": "wc_x",
    "wc_y_mm": "wc_y",
    "wc_z_mm": "wc_z",
    "cp_x_mm": "cp_x",
    "cp_y_mm": "cp_y",
    "cp_z_mm": "cp_z",
    "fz_N": "tyre_load",
    "tierod_N": "tie_rod",
    "strut_comp_mm": "strut_compression",
    "spring_N": "spring",
    "stop_N": "stop",
}
AXLE_WIDE = {
    "rack_pos_mm": "rack_travel",
    "rack_force_N": "rack_force",
    "column_force_N": "column_force",
}
TOLERANCE = {"deg": 1e-5, "mm": 1e-4, "N": 0.01}
CHANGES = {
    "d_toe_deg": "toe",
    "d_camber_deg": "camber",
    "d_caster_deg": "caster",
    "d_caster_knuckle_deg": "spin",
    "wc_dx_mm": "wc_x",
    "wc_dy_mm": "wc_y",
    "wc_dz_mm": "wc_z",
}


def tolerance(column: str) -> float:
    return TOLERANCE[column.rsplit("_", 1)[1]]


def to_our_input(case: str, value: np.ndarray) -> np.ndarray:
    if case == "roll_pads":
        return -value
    return value * 360.0 / 52.0 if case == "steer" else value


def our_branch(solution: Solution, case: str, branch: str) -> BranchSolution:
    """Theirs rolls the other way: their `pos` is our `neg`, their loop our loop mirrored left to right."""
    branches = {b.name: b for b in solution.cases[CASE_NAMES[case]].branches}
    if case == "roll_pads" and branch in {"pos", "neg"}:
        branch = {"pos": "neg", "neg": "pos"}[branch]
    return branches[branch]


def differences(
    solution: Solution, rows: pd.DataFrame, case: str, branch: str, side: str
) -> dict[str, np.ndarray]:
    """Ours minus theirs by their column name."""
    ours = our_branch(solution, case, branch)
    wanted, mirrored = to_our_input(case, rows["input"].to_numpy()), False
    if case == "roll_pads" and branch not in {"pos", "neg"}:
        wanted, mirrored = -wanted, True
    index = [int(np.argmin(np.abs(ours.input - v))) for v in wanted]
    assert np.allclose(ours.input[index], wanted, atol=1e-5)
    own = {"L": "R", "R": "L"}[side] if mirrored else side
    static = solution.static
    assert static is not None
    columns = (
        [(t, f"{o}@{own}", False) for t, o in SIDED.items()]
        + [(t, o, False) for t, o in AXLE_WIDE.items()]
        + [(t, f"{o}@{own}", True) for t, o in CHANGES.items()]
    )
    out = {}
    for theirs, name, change in columns:
        column = solution.column(name)
        values = ours.y[index, column] - (static.y[column] if change else 0.0)
        lateral = theirs in {"wc_y_mm", "cp_y_mm", "wc_dy_mm", *AXLE_WIDE}
        out[theirs] = (-values if mirrored and lateral else values) - rows[theirs].to_numpy()
    return out


@pytest.mark.parametrize("name", FILES)
def test_every_curve_of_the_reference(name: str) -> None:
    solution = solve(reference_axle(name))
    curves = reference_curves(name)
    assert set(curves["case"]) == set(CASE_NAMES)
    wrong = []
    for (case, branch, side), rows in curves.groupby(["case", "branch", "side"], sort=False):
        for column, gap in differences(solution, rows, str(case), str(branch), str(side)).items():
            excess = np.abs(gap).max() / tolerance(column)
            if excess > 1.0:
                wrong.append(f"{case} {branch} {side} {column}: {excess:.3g} x tolerance")
    assert not wrong, "\n".join(wrong[:20])
