"""Reads an axle file."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from doe_kc.axle.freedoms import check_freedoms
from doe_kc.axle.geometry import check_geometry
from doe_kc.axle.model import BUSHING_AXES, Axle, both, strut_clamp
from doe_kc.axle.parameters import with_values
from doe_kc.axle.structure import Structure
from doe_kc.axle.topology import Topology
from doe_kc.axle_file.schema import AxleFile
from doe_kc.axle_file.tables import bushing_values, chosen_load_cases, stop_values, strut_values
from doe_kc.axle_file.typed import typed_axle
from doe_kc.axle_file.typed_schema import TypedAxleFile
from doe_kc.axle_types import DEFAULT_TYPE, built_in
from doe_kc.effects import apply_effect, refuse_on_rig
from doe_kc.ground.files import read_toml, validate


def read_axle(path: Path) -> Axle:
    """Axle from its TOML file; InputError naming file and key for anything wrong."""
    return axle_from_document(read_toml(path), source=str(path), folder=Path(path).parent)


def axle_from_document(document: Mapping[str, Any], *, source: str, folder: Path | None = None) -> Axle:
    """Axle from the parsed file; `source` names it in messages. folder: that a type file is seen from."""
    file, axle = _plain_axle(document, folder or Path(), source)
    if file.right:
        axle = with_values(axle, {f"right.{path}": v for path, v in file.right.items()}, source=source)
    for ident, options in file.effects.items():
        refuse_on_rig(ident, source)
        axle = apply_effect(axle, ident, options, source=source)
    check_geometry(axle, source)
    check_freedoms(axle, axle.topology.structure, source)
    return axle


def _plain_axle(
    document: Mapping[str, Any], folder: Path, source: str
) -> tuple[AxleFile | TypedAxleFile, Axle]:
    """The checked file, and its axle without the right side's own values and effects."""
    if document.get("type", DEFAULT_TYPE) != DEFAULT_TYPE:
        return typed_axle(document, folder, source)
    file = validate(AxleFile, {k: v for k, v in document.items() if k != "type"}, source)
    axle_type = built_in(DEFAULT_TYPE)
    return file, Axle(
        name=file.name,
        topology=_topology(file, axle_type.structure),
        values=_values(file),
        follow=dict(file.follow),
        load_cases=chosen_load_cases(file.load_cases, source),
        labels=axle_type.labels,
        lines=axle_type.lines,
    )


def _topology(file: AxleFile, structure: Structure) -> Topology:
    tables = [
        (name, axis, len(bushing.table[axis]))
        for name, bushing in file.bushings
        for axis in BUSHING_AXES
        if axis in bushing.table
    ]
    return Topology(
        structure=structure,
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
        for key, value in bushing_values(name, bushing).items():
            out |= both(key, value)
    for name, stop in (("bump_stop", file.bump_stop), ("rebound_stop", file.rebound_stop)):
        out |= stop_values(name, stop)
    out |= both("static.toe", file.static.toe) | both("static.camber", file.static.camber)
    out |= both("tyre.rate", file.tyre.rate) | both("spring.rate", file.spring.rate)
    out |= both("damper.gas_force", file.damper.gas_force)
    out |= both("steer_arm.radius", file.steer_arm.radius)
    out |= strut_values(file.strut)
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
