"""Reads an axle file."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from doe_kc.axle.force_curve import curve_values
from doe_kc.axle.geometry import check_geometry
from doe_kc.axle.model import BUSHING_AXES, STRUT_BENDING, STRUT_TORSION, Axle, both, strut_clamp
from doe_kc.axle.parameters import with_values
from doe_kc.axle.topology import Topology
from doe_kc.axle_file.schema import AxleFile, Stop, Sweep
from doe_kc.effects import apply_effect, refuse_on_rig
from doe_kc.ground.errors import InputError, nearest
from doe_kc.ground.files import read_toml, validate
from doe_kc.load_cases import CASE_ORDER, LOAD_CASES, LoadCase
from doe_kc.load_cases.roll import ROLL_TECHNIQUES


def read_axle(path: Path) -> Axle:
    """Axle from its TOML file; InputError naming file and key for anything wrong."""
    return axle_from_document(read_toml(path), source=str(path))


def axle_from_document(document: Mapping[str, Any], *, source: str) -> Axle:
    """Axle from the parsed file; `source` names it in messages."""
    file = validate(AxleFile, document, source)
    axle = Axle(
        name=file.name,
        topology=_topology(file),
        values=_values(file),
        follow=dict(file.follow),
        load_cases=_load_cases(file, source),
    )
    if file.right:
        axle = with_values(axle, {f"right.{path}": v for path, v in file.right.items()}, source=source)
    for ident, options in file.effects.items():
        refuse_on_rig(ident, source)
        axle = apply_effect(axle, ident, options, source=source)
    check_geometry(axle, source)
    return axle


def _topology(file: AxleFile) -> Topology:
    tables = [
        (name, axis, len(bushing.table[axis]))
        for name, bushing in file.bushings
        for axis in BUSHING_AXES
        if axis in bushing.table
    ]
    return Topology(
        strut_bending=file.strut.flexibility > 0,
        steer_arm=file.steer_arm.flexible,
        bump_points=len(file.bump_stop.curve),
        rebound_points=len(file.rebound_stop.curve),
        tables=tuple(tables),
    )


def _values(file: AxleFile) -> dict[str, float]:
    out: dict[str, float] = {}
    points = {name: point for name, point in file.hardpoints if point is not None}
    for name, point in ({"CLAMP": strut_clamp(points)} | points).items():
        for axis, value in zip("xyz", point, strict=True):
            out |= both(f"{name}.{axis}", value)
    for name, bushing in file.bushings:
        out |= _bushing_values(name, bushing)
    for name, stop in (("bump_stop", file.bump_stop), ("rebound_stop", file.rebound_stop)):
        out |= _stop_values(name, stop)
    out |= both("static.toe", file.static.toe) | both("static.camber", file.static.camber)
    out |= both("tyre.rate", file.tyre.rate) | both("spring.rate", file.spring.rate)
    out |= both("damper.gas_force", file.damper.gas_force)
    out |= both("steer_arm.radius", file.steer_arm.radius)
    out |= both("strut.flexibility", file.strut.flexibility)
    out |= both("strut.bending", STRUT_BENDING) | both("strut.torsion", STRUT_TORSION)
    out |= both("tie_rod.flexibility", 0.0)
    out |= {
        "tyre.static_load": file.tyre.static_load,
        "arb.rate": file.arb.rate,
        "arb.radius": file.arb.radius,
        "arb.nominal_radius": file.arb.nominal_radius,
        "arb.link_flexibility": 0.0,
        "steering.column": file.steering.column,
        "steering.rack_mm_per_rev": file.steering.rack_mm_per_rev,
        "scb.Tz": file.scb.Tz,
        "ride_height": file.ride_height,
    }
    return out


def _bushing_values(name: str, bushing: Any) -> dict[str, float]:
    out: dict[str, float] = {}
    for axis in BUSHING_AXES:
        out |= both(f"{name}.{axis}", bushing.factor.get(axis, 1.0))
        out |= both(f"{name}.stiffness.{axis}", bushing.stiffness.get(axis, 0.0))
        if axis.startswith("F"):
            out |= both(f"{name}.cubic.{axis}", bushing.cubic.get(axis, 0.0))
            out |= both(f"{name}.preload.{axis}", bushing.preload.get(axis, 0.0))
        if axis in bushing.table:
            out |= _table_values(f"{name}.table.{axis}", np.array(bushing.table[axis]), axis)
    return out


def _table_values(prefix: str, table: Any, axis: str) -> dict[str, float]:
    x, y = table[:, 0], table[:, 1]
    if axis.startswith("T"):
        x, y = np.radians(x), y * 1000.0
    out: dict[str, float] = {}
    for key, value in curve_values(prefix, x, y).items():
        out |= both(key, value)
    return out


def _stop_values(name: str, stop: Stop) -> dict[str, float]:
    points = np.array(stop.curve)
    return (
        dict(curve_values(f"{name}.table", points[:, 0], points[:, 1]))
        | both(f"{name}.clearance", stop.clearance)
        | both(f"{name}.factor", stop.factor)
    )


def _load_cases(file: AxleFile, source: str) -> dict[str, LoadCase]:
    cases = {ident: LOAD_CASES[ident] for ident in CASE_ORDER}
    for ident, sweep in file.load_cases.items():
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
