"""Simulation results as files: curves.csv, characteristics.csv and the JSON document."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from doe_kc.characteristics import CHARACTERISTICS, Characteristic, reduce_all
from doe_kc.curves import SIDES
from doe_kc.ground.output import write_csv
from doe_kc.report.render.csv import table_frame
from doe_kc.report.render.json import table_records
from doe_kc.report.table import Column, Table
from doe_kc.solver.curve_set import curve_set
from doe_kc.solver.elements.responses import output_unit
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
    for column, output in enumerate(solution.output_names):
        name, _, own = output.partition("@")
        if own not in ("", side):
            continue
        values = branch.y[:, column]
        if name.startswith("wc_"):
            values = values - solution.static.y[column]
        columns[f"{name}_{output_unit(name)}"] = values
    return pd.DataFrame(columns)


@dataclass(frozen=True)
class SimulatedCharacteristic:
    """One characteristic of a simulation, in `entry.unit`."""

    entry: Characteristic
    value: float


SIMULATED_COLUMNS: tuple[Column[SimulatedCharacteristic], ...] = (
    Column("name", "Id", lambda r: r.entry.id),
    Column("load_case", "Load case", lambda r: r.entry.load_case, json="load_case"),
    Column("response", "Response", lambda r: r.entry.response),
    Column("unit", "Unit", lambda r: r.entry.unit, json="unit"),
    Column("value", "Value", lambda r: r.value, "0.0000", json="value"),
)


def simulated_characteristic_table(solution: Solution) -> Table[SimulatedCharacteristic]:
    """Every characteristic that the solution has."""
    values = reduce_all(curve_set(solution))
    rows = [
        SimulatedCharacteristic(entry, values[name])
        for name, entry in CHARACTERISTICS.items()
        if math.isfinite(values[name])
    ]
    return Table("Characteristics", "Of the simulated axle, left wheel.", SIMULATED_COLUMNS, rows)


def characteristics_frame(solution: Solution) -> pd.DataFrame:
    """name, load_case, response, unit, value of every characteristic that the solution has."""
    return table_frame(simulated_characteristic_table(solution))


def characteristics_document(solution: Solution, seconds: float) -> dict[str, Any]:
    """`{"characteristics": {name: {"value", "unit", "load_case"}}, "seconds"}`."""
    table = simulated_characteristic_table(solution)
    entries = dict(zip((r.entry.id for r in table.rows), table_records(table), strict=True))
    return {"characteristics": entries, "seconds": seconds}


def write_simulation(solution: Solution, folder: Path) -> list[Path]:
    """curves.csv and characteristics.csv."""
    return [
        write_csv(folder / "curves.csv", curves_frame(solution)),
        write_csv(folder / "characteristics.csv", characteristics_frame(solution)),
    ]
