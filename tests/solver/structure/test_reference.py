"""Every curve of every reference file of five axle types: 1e-5 deg, 1e-4 mm, 0.01 N."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest

from doe_kc.axle import Axle
from doe_kc.solver.result import Solution
from doe_kc.solver.suite import solve
from tests.axle_type_reference import TYPES, curves, files, nominal, variant, with_effect
from tests.reference import CASE_NAMES
from tests.solver.test_reference import AXLE_WIDE, SIDED

TOLERANCE = {"deg": 1e-5, "mm": 1e-4, "N": 0.01}
FILES = [(t, name) for t in TYPES for name in files(t)]


def axle_of(axle_type: str, name: str) -> Axle:
    if name.startswith("effect_"):
        return with_effect(axle_type, name)
    return nominal(axle_type) if name == "nominal" else variant(axle_type, name)


def differences(
    solution: Solution, axle: Axle, rows: pd.DataFrame, case: str, branch: str, side: str
) -> dict[str, float]:
    """Largest difference over its tolerance by their column's name."""
    ours = {b.name: b for b in solution.cases[CASE_NAMES[case]].branches}[branch]
    wanted = rows["input"].to_numpy()
    if case == "steer":  # their input is the rack's travel
        wanted = wanted * 360.0 / axle.rack_mm_per_rev
    index = [int(np.argmin(np.abs(ours.input - value))) for value in wanted]
    assert np.allclose(ours.input[index], wanted, atol=1e-5)
    columns = {theirs: f"{own}@{side}" for theirs, own in SIDED.items()} | AXLE_WIDE
    there = {theirs: name for theirs, name in columns.items() if name in solution.output_names}
    off = ours.y[index][:, [solution.column(name) for name in there.values()]] - rows[list(there)].to_numpy()
    tolerances = np.array([TOLERANCE[theirs.rsplit("_", 1)[1]] for theirs in there])
    return dict(zip(there, (np.abs(off).max(axis=0) / tolerances).tolist(), strict=True))


@pytest.mark.parametrize(("axle_type", "name"), FILES, ids=[f"{t}-{name}" for t, name in FILES])
def test_every_curve_of_the_reference(axle_type: str, name: str) -> None:
    axle = axle_of(axle_type, name)
    solution = solve(axle, compiled=None if name.startswith("variant") else False)  # by either kind of march
    reference = curves(axle_type, name)
    assert {CASE_NAMES[case] for case in reference["case"]} == set(solution.cases)
    wrong = [
        f"{case} {branch} {side} {column}: {excess:.3g} x tolerance"
        for (case, branch, side), rows in reference.groupby(["case", "branch", "side"], sort=False)
        for column, excess in differences(solution, axle, rows, case, branch, side).items()
        if excess > 1.0
    ]
    assert not wrong, "\n".join(wrong[:20])
