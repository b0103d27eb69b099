"""K&C tables of an axle for vehicle models, as CSV and JSON."""

from __future__ import annotations

from pathlib import Path

from doe_kc.axle.model import Axle
from doe_kc.ground.output import write_columns, write_json
from doe_kc.reports.simulation.vehicle_tables import (
    ComplianceCoefficient,
    compliance_coefficients,
    kinematic_columns,
    vehicle_document,
)
from doe_kc.solver.curve_set import curve_set
from doe_kc.solver.suite import solve


def export_kc(axle: Axle, out: Path) -> list[Path]:
    """kinematics.csv, steer.csv where the axle steers, compliance.csv, vehicle_tables.json; their paths.

    RunError where the axle has no equilibrium.
    """
    solution = solve(axle)
    assert solution.static is not None
    curves = curve_set(solution)
    radius = axle.values["WLC.z@L"] - solution.static.datum.pad[0]
    coefficients = list(compliance_coefficients(axle, curves, radius))
    tables = {"vertical": "kinematics.csv", "steer": "steer.csv"}
    paths = [
        write_columns(out / name, kinematic_columns(curves, case))
        for case, name in tables.items()
        if case in curves.cases
    ]
    fields = ComplianceCoefficient.__dataclass_fields__
    columns = {name: [getattr(c, name) for c in coefficients] for name in fields}
    paths.append(write_columns(out / "compliance.csv", columns))
    paths.append(write_json(out / "vehicle_tables.json", vehicle_document(curves, coefficients)))
    return paths
