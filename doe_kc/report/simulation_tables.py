"""Simulation results as files: curves.csv, characteristics.csv and the JSON document."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from doe_kc.characteristics import CHARACTERISTICS, reduce_all
from doe_kc.curves import SIDES
from doe_kc.ground.output import write_csv
from doe_kc.solver.curve_set import curve_set
from doe_kc.solver.elements.responses import AXLE_OUTPUT_UNITS, OUTPUT_UNITS
from doe_kc.solver.result import BranchSolution, CaseSolution, Solution


def curves_frame(solution: Solution) -> pd.DataFrame:
    """One row a load case, branch, step and side; angles absolute, wheel centre as change from static."""
    rows = [
        _branch_frame(solution, case, branch, side)
        for case in solution.cases.values()
        for branch in case.branches
        for side in SIDES
    ]
    return pd.concat(rows, ignore_index=True)


def _branch_frame(solution: Solution, case: CaseSolution, branch: BranchSolution, side: str) -> pd.DataFrame:
    assert solution.static is not None
    columns: dict[str, Any] = {
        "load_case": case.load_case.id,
        "branch": branch.name,
        "step": np.arange(len(branch.input)),
        "input": branch.input,
        "input_unit": case.load_case.unit,
        "side": side,
    }
    for name, unit in OUTPUT_UNITS.items():
        column = solution.column(f"{name}@{side}")
        values = branch.y[:, column]
        if name.startswith("wc_"):
            values = values - solution.static.y[column]
        columns[f"{name}_{unit}"] = values
    for name, unit in AXLE_OUTPUT_UNITS.items():
        columns[f"{name}_{unit}"] = branch.y[:, solution.column(name)]
    return pd.DataFrame(columns)


def characteristics_frame(solution: Solution) -> pd.DataFrame:
    """name, load_case, response, unit, value of every characteristic that the solution has."""
    values = reduce_all(curve_set(solution))
    rows = [
        (name, entry.load_case, entry.response, entry.unit, values[name])
        for name, entry in CHARACTERISTICS.items()
        if math.isfinite(values[name])
    ]
    return pd.DataFrame(rows, columns=["name", "load_case", "response", "unit", "value"])


def characteristics_document(solution: Solution, seconds: float) -> dict[str, Any]:
    """`{"characteristics": {name: {"value", "unit", "load_case"}}, "seconds"}`."""
    frame = characteristics_frame(solution)
    entries = {
        row["name"]: {key: row[key] for key in ("value", "unit", "load_case")}
        for row in frame.to_dict("records")
    }
    return {"characteristics": entries, "seconds": seconds}


def write_simulation(solution: Solution, folder: Path) -> list[Path]:
    """curves.csv and characteristics.csv."""
    return [
        write_csv(folder / "curves.csv", curves_frame(solution)),
        write_csv(folder / "characteristics.csv", characteristics_frame(solution)),
    ]
