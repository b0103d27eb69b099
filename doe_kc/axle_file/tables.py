"""Values and load cases from the tables that every axle file has."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from doe_kc.axle.force_curve import curve_values
from doe_kc.axle.model import BUSHING_AXES, STRUT_BENDING, STRUT_TORSION, both
from doe_kc.axle_file.schema import Bushing, Stop, StrutTable, Sweep
from doe_kc.ground.errors import InputError, nearest
from doe_kc.load_cases import CASE_ORDER, LOAD_CASES, LoadCase
from doe_kc.load_cases.roll import ROLL_TECHNIQUES


def bushing_values(name: str, bushing: Bushing) -> dict[str, float]:
    """Factors, stiffnesses, progressions, preloads and tables of a bushing, without a side."""
    out: dict[str, float] = {}
    for axis in BUSHING_AXES:
        out[f"{name}.{axis}"] = bushing.factor.get(axis, 1.0)
        out[f"{name}.stiffness.{axis}"] = bushing.stiffness.get(axis, 0.0)
        if axis.startswith("F"):
            out[f"{name}.cubic.{axis}"] = bushing.cubic.get(axis, 0.0)
            out[f"{name}.preload.{axis}"] = bushing.preload.get(axis, 0.0)
        if axis in bushing.table:
            out |= _table_values(f"{name}.table.{axis}", np.array(bushing.table[axis]), axis)
    return out


def _table_values(prefix: str, table: Any, axis: str) -> dict[str, float]:
    x, y = table[:, 0], table[:, 1]
    if axis.startswith("T"):
        x, y = np.radians(x), y * 1000.0
    return dict(curve_values(prefix, x, y))


def stop_values(name: str, stop: Stop) -> dict[str, float]:
    """Curve, clearance and factor of a stop, internal names."""
    points = np.array(stop.curve)
    return (
        dict(curve_values(f"{name}.table", points[:, 0], points[:, 1]))
        | both(f"{name}.clearance", stop.clearance)
        | both(f"{name}.factor", stop.factor)
    )


def strut_values(strut: StrutTable) -> dict[str, float]:
    """Flexibility and stiffnesses of the strut clamp, internal names."""
    return (
        both("strut.flexibility", strut.flexibility)
        | both("strut.bending", STRUT_BENDING)
        | both("strut.torsion", STRUT_TORSION)
    )


def chosen_load_cases(sweeps: Mapping[str, Sweep], source: str) -> dict[str, LoadCase]:
    """Default load cases as the file's tables change them; InputError for an unknown one or option."""
    cases = {ident: LOAD_CASES[ident] for ident in CASE_ORDER}
    for ident, sweep in sweeps.items():
        if ident not in cases:
            raise InputError(
                f"{source}: [load_cases.{ident}] is not a load case; "
                f"known are {_listed(cases)}.{nearest(ident, cases)}"
            )
        cases[ident] = _changed_case(cases[ident], sweep, source)
    return cases


def _changed_case(case: LoadCase, sweep: Sweep, source: str) -> LoadCase:
    options = sweep.model_dump(exclude_none=True)
    technique = options.pop("technique", None)
    if technique is not None:
        if case.id != "roll":
            raise InputError(f"{source}: [load_cases.{case.id}] technique belongs to roll only.")
        case = ROLL_TECHNIQUES[technique]
    for key in options:
        if not hasattr(case, key):
            raise InputError(f"{source}: [load_cases.{case.id}] has no option {key!r}; remove it.")
    return replace(case, **options)


def _listed(names: Iterable[str]) -> str:
    return ", ".join(names)
