"""Largest difference to the independent multibody code over every curve of every reference file."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import pandas as pd
from _common import publish

from doe_kc.axle import Axle
from doe_kc.solver.result import Solution
from doe_kc.solver.suite import solve
from tests.axle_type_reference import curves
from tests.reference import FILES, reference_axle, reference_curves
from tests.solver.structure import test_reference as types
from tests.solver.test_reference import TOLERANCE, differences

WANTED = ", ".join(f"{limit:g} {unit}" for unit, limit in TOLERANCE.items())
Gaps = Iterator[tuple[str, float]]
"""Their column's name and the largest difference in it."""


def mcpherson_gaps(solution: Solution, rows: pd.DataFrame, case: str, branch: str, side: str) -> Gaps:
    """Of one branch of the McPherson axle."""
    for column, gap in differences(solution, rows, case, branch, side).items():
        yield column, float(abs(gap).max())


def worst(axle: Axle, reference: pd.DataFrame, gaps: Callable[..., Gaps]) -> dict[str, float]:
    """Largest absolute difference by unit."""
    solution, out = solve(axle), dict.fromkeys(TOLERANCE, 0.0)
    for (case, branch, side), rows in reference.groupby(["case", "branch", "side"], sort=False):
        for column, gap in gaps(solution, rows, str(case), str(branch), str(side)):
            unit = column.rsplit("_", 1)[1]
            out[unit] = max(out[unit], gap)
    return out


def type_worst(axle_type: str, name: str) -> dict[str, float]:
    """The same of a file of another axle type."""
    axle = types.axle_of(axle_type, name)

    def gaps(solution: Solution, rows: pd.DataFrame, case: str, branch: str, side: str) -> Gaps:
        for column, excess in types.differences(solution, axle, rows, case, branch, side).items():
            yield column, excess * TOLERANCE[column.rsplit("_", 1)[1]]

    return worst(axle, curves(axle_type, name), gaps)


def main() -> None:
    lines = [
        "# Accuracy against EXUDYN 1.13.6",
        "",
        "Largest difference over all load cases, branches, sides and columns of each reference file.",
        f"Wanted: {WANTED}.",
        "",
        "| axle type | reference file | angle [deg] | position [mm] | force [N] |",
        "|---|---|---|---|---|",
    ]
    every = [
        ("mcpherson_front", n, worst(reference_axle(n), reference_curves(n), mcpherson_gaps)) for n in FILES
    ]
    every += [(t, n, type_worst(t, n)) for t, n in types.FILES]
    lines += [
        f"| {t} | {n} | {gaps['deg']:.1e} | {gaps['mm']:.1e} | {gaps['N']:.1e} |" for t, n, gaps in every
    ]
    most = {unit: max(gaps[unit] for *_, gaps in every) for unit in TOLERANCE}
    lines += ["", f"{len(every)} files, at most " + ", ".join(f"{v:.1e} {u}" for u, v in most.items()) + "."]
    publish("accuracy", lines)


if __name__ == "__main__":
    main()
