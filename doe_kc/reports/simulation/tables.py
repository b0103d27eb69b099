"""Simulation results as files: curves.csv, characteristics.csv and the JSON document."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from doe_kc.characteristics import CHARACTERISTICS, Characteristic, reduce_all
from doe_kc.characteristics.of_axle import KINGPIN_RESPONSE
from doe_kc.curves import SIDES
from doe_kc.ground.output import write_columns
from doe_kc.reports.characteristic_columns import CHARACTERISTIC_COLUMNS
from doe_kc.reports.render.csv import table_columns, table_frame
from doe_kc.reports.render.json import table_records
from doe_kc.reports.table import Column, PageCell, PageLayout, Table
from doe_kc.solver.curve_set import curve_set
from doe_kc.solver.elements.responses import output_unit
from doe_kc.solver.result import BranchSolution, CaseSolution, Solution

if TYPE_CHECKING:
    import pandas as pd


def curves_columns(solution: Solution) -> dict[str, NDArray[Any]]:
    """One row a load case, branch, step and side; angles absolute, wheel centre as change from static."""
    parts = [
        _branch_columns(solution, case, branch, side)
        for case in solution.cases.values()
        for branch in case.branches
        for side in SIDES
    ]
    return {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}


def curves_frame(solution: Solution) -> pd.DataFrame:
    """`curves_columns` as a data frame."""
    import pandas as pd

    return pd.DataFrame(curves_columns(solution))


def _branch_columns(
    solution: Solution, case: CaseSolution, branch: BranchSolution, side: str
) -> dict[str, NDArray[Any]]:
    assert solution.static is not None
    n = len(branch.input)
    columns: dict[str, NDArray[Any]] = {
        "load_case": np.full(n, case.load_case.id, dtype=object),
        "branch": np.full(n, branch.name, dtype=object),
        "step": np.arange(n),
        "input": branch.input,
        "input_unit": np.full(n, case.load_case.unit, dtype=object),
        "side": np.full(n, side, dtype=object),
    }
    for column, output in enumerate(solution.output_names):
        name, _, own = output.partition("@")
        if own not in ("", side):
            continue
        values = branch.y[:, column]
        if name.startswith("wc_"):
            values = values - solution.static.y[column]
        columns[f"{name}_{output_unit(name)}"] = values
    return columns


@dataclass(frozen=True)
class SimulatedCharacteristic:
    """One characteristic of a simulation, in `entry.unit`."""

    entry: Characteristic
    value: float


SIMULATED_COLUMNS: tuple[Column[SimulatedCharacteristic], ...] = (
    *CHARACTERISTIC_COLUMNS,
    Column("value", "Value", lambda r: r.value, "0.0000", json="value", page=PageCell()),
)  # fmt: skip


def simulated_characteristic_table(solution: Solution) -> Table[SimulatedCharacteristic]:
    """Every characteristic that the solution has."""
    values = reduce_all(curve_set(solution))
    rows = [
        SimulatedCharacteristic(entry, values[name])
        for name, entry in CHARACTERISTICS.items()
        if math.isfinite(values[name]) and (solution.has_kingpin or entry.response != KINGPIN_RESPONSE)
    ]
    return simulated_table(rows)


def simulated_table(rows: Sequence[SimulatedCharacteristic]) -> Table[SimulatedCharacteristic]:
    """One row a characteristic."""
    layout = PageLayout[SimulatedCharacteristic]("simulated-table", "Characteristics", filtered=True)
    remark = "Of the simulated axle, left wheel."
    return Table("Characteristics", remark, SIMULATED_COLUMNS, rows, page=layout)


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
        write_columns(folder / "curves.csv", curves_columns(solution)),
        write_columns(
            folder / "characteristics.csv", table_columns(simulated_characteristic_table(solution))
        ),
    ]
