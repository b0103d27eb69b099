"""Reads an axle file."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from doe_kc.axle.freedoms import check_freedoms
from doe_kc.axle.geometry import check_geometry
from doe_kc.axle.model import BUSHING_AXES, Axle, both, strut_clamp
from doe_kc.axle.parameters import with_values
from doe_kc.axle.structure import Structure, of_side
from doe_kc.axle.topology import Topology
from doe_kc.axle_file.schema import AxleFile, SteerArmTable, StrutTable
from doe_kc.axle_file.tables import bushing_values, chosen_load_cases, stop_values, strut_values
from doe_kc.axle_types import DEFAULT_TYPE, read_axle_type
from doe_kc.axle_types.checks import check_follow
from doe_kc.axle_types.read import bushing_axes
from doe_kc.effects import apply_effect, refuse_on_rig
from doe_kc.ground.errors import InputError, nearest
from doe_kc.ground.files import read_toml, validate


def file_topology(file: AxleFile, structure: Structure) -> Topology:
    tables = [
        (name, axis, len(bushing.table[axis]))
        for name, bushing in file.bushings.items()
        for axis in BUSHING_AXES
        if axis in bushing.table
    ]
    return Topology(
        structure=structure,
        strut_bending=structure.strut is not None and _strut(file).flexibility > 0,
        steer_arm=structure.steer_arm is not None and _steer_arm(file).flexible,
        bump_points=len(file.bump_stop.curve) if file.bump_stop is not None else 0,
        rebound_points=len(file.rebound_stop.curve) if file.rebound_stop is not None else 0,
        tables=tuple(tables),
    )


def _strut(file: AxleFile) -> StrutTable:
    return file.strut or StrutTable()


def _steer_arm(file: AxleFile) -> SteerArmTable:
    return file.steer_arm or SteerArmTable()


def file_values(file: AxleFile, structure: Structure) -> dict[str, float]:
    out: dict[str, float] = {}

    def put(name: str, value: float, *, single: bool) -> None:
        out.update({of_side(name, side): value for side in structure.sides(single=single)})

    for name, point in _hardpoints(file, structure).items():
        for axis, value in zip("xyz", point, strict=True):
            put(f"{name}.{axis}", value, single=name in structure.single_points)
    for bush in structure.bushings:
        for name, value in bushing_values(bush.name, file.bushings[bush.name]).items():
            put(name, value, single=bush.single)
    for spring in structure.springs:
        put(f"{spring.name}.rate", file.springs[spring.name].rate, single=spring.single)
    for rod in structure.rods:
        put(f"{rod.name}.flexibility", 0.0, single=rod.single)
    for name, stop in (("bump_stop", file.bump_stop), ("rebound_stop", file.rebound_stop)):
        if stop is not None:
            out |= stop_values(name, stop)
    out |= both("static.toe", file.static.toe) | both("static.camber", file.static.camber)
    out |= both("tyre.rate", file.tyre.rate) | {"tyre.static_load": file.tyre.static_load}
    if structure.damper is not None:
        out |= both("damper.gas_force", file.damper.gas_force)
    if structure.strut is not None:
        out |= strut_values(_strut(file))
    if structure.steer_arm is not None:
        out |= both("steer_arm.radius", _steer_arm(file).radius)
    if file.arb is not None:
        out |= {f"arb.{key}": value for key, value in file.arb.model_dump().items()}
        out["arb.link_flexibility"] = 0.0
    if file.steering is not None:
        out |= {f"steering.{key}": value for key, value in file.steering.model_dump().items()}
        out["scb.Tz"] = file.scb.Tz
    return out | {"ride_height": file.ride_height}


def _hardpoints(file: AxleFile, structure: Structure) -> dict[str, list[float]]:
    """Those of the file, and the strut's clamp."""
    strut = structure.strut
    if strut is None or strut.at in file.hardpoints:
        return file.hardpoints
    return {strut.at: strut_clamp(file.hardpoints, strut.line), **file.hardpoints}


def oriented(file: AxleFile, structure: Structure, source: str) -> Structure:
    """The structure with the local axes of bushings that the file gives."""
    bushings = []
    for bush in structure.bushings:
        table, where = file.bushings[bush.name], f"{source}: [bushings.{bush.name}]"
        if table.x is not None or table.y is not None:
            if bush.line is not None:
                raise InputError(f"{where}: its axes follow two points of the type; remove x and y.")
            bush = replace(bush, axes=bushing_axes(table.x, table.y, where))
        bushings.append(bush)
    return (
        structure if tuple(bushings) == structure.bushings else replace(structure, bushings=tuple(bushings))
    )


def check_names(file: AxleFile, follow: Mapping[str, str], structure: Structure, source: str) -> None:
    """InputError unless the file has a number for all that the type names, and nothing else.

    follow: of the file, or of the type. A strut's clamp may be left out.
    """
    points = (*structure.points, *structure.single_points)
    bushings = [bush.name for bush in structure.bushings]
    springs = [spring.name for spring in structure.springs]
    derived = () if structure.strut is None else (structure.strut.at,)
    for table, names, wanted in (
        ("hardpoints", [*file.hardpoints, *derived], points),
        ("bushings", file.bushings, bushings),
        ("springs", file.springs, springs),
    ):
        _same_names(table, names, wanted, structure.type, source)
    for table, needed in (
        ("bump_stop", structure.damper),
        ("rebound_stop", structure.damper),
        ("arb", structure.bar),
        ("steering", structure.rack),
    ):
        present = getattr(file, table) is not None
        if needed is not None and not present:
            raise InputError(f"{source}: table [{table}] is missing; the type {structure.type} needs it.")
        if needed is None and present:
            raise InputError(f"{source}: [{table}] is for nothing that a {structure.type} has; remove it.")
    for table, part in (("strut", structure.strut), ("steer_arm", structure.steer_arm)):
        if part is None and getattr(file, table) is not None:
            raise InputError(f"{source}: [{table}] is for nothing that a {structure.type} has; remove it.")
    check_follow(follow, structure.points, source)


def _same_names(
    table: str, present: Collection[str], wanted: Collection[str], type_name: str, source: str
) -> None:
    for name in present:
        if name not in wanted:
            raise InputError(
                f"{source}: {table}.{name} is unknown to the type {type_name}; "
                f"it has {', '.join(wanted)}.{nearest(name, wanted)}"
            )
    for name in wanted:
        if name not in present:
            raise InputError(f"{source}: {table}.{name} is missing; the type {type_name} needs it.")


STEER_RACK_TRAVEL = 60.0
"""mm to either side that a steering input drives by default."""


def read_axle(path: Path) -> Axle:
    """Axle from its TOML file; InputError naming file and key for anything wrong."""
    return axle_from_document(read_toml(path), source=str(path), folder=Path(path).parent)


def axle_from_document(document: Mapping[str, Any], *, source: str, folder: Path | None = None) -> Axle:
    """Axle from the parsed file; `source` names it in messages. folder: that a type file is seen from."""
    file, axle = plain_axle(document, source=source, folder=folder)
    axle = apply_effects(axle, file.effects, source=source)
    check_geometry(axle, source)
    check_freedoms(axle, axle.topology.structure, source)
    return axle


def apply_effects(axle: Axle, tables: Mapping[str, Mapping[str, Any]], *, source: str) -> Axle:
    """The axle with the effects of a file's tables, in their order."""
    for ident, options in tables.items():
        refuse_on_rig(ident, source)
        axle = apply_effect(axle, ident, options, source=source)
    return axle


def plain_axle(
    document: Mapping[str, Any], *, source: str, folder: Path | None = None
) -> tuple[AxleFile, Axle]:
    """The checked file, and its axle without effects, which may have a geometry that no car has."""
    file, axle = _symmetric_axle(document, folder or Path(), source)
    if not file.right:
        return file, axle
    return file, with_values(axle, {f"right.{path}": v for path, v in file.right.items()}, source=source)


def _symmetric_axle(document: Mapping[str, Any], folder: Path, source: str) -> tuple[AxleFile, Axle]:
    """The checked file, and its axle without the right side's own values and effects."""
    axle_type = read_axle_type(str(document.get("type", DEFAULT_TYPE)), folder, source=source)
    file = validate(AxleFile, _with_springs(document, axle_type.structure), source)
    follow = axle_type.follow if file.follow is None else file.follow
    check_names(file, follow, axle_type.structure, source)
    structure = oriented(file, axle_type.structure, source)
    cases = chosen_load_cases(file.load_cases, source)
    if file.steering is None:
        cases.pop("steer")
    elif "steer" not in file.load_cases or file.load_cases["steer"].amplitude is None:
        angle = STEER_RACK_TRAVEL * 360.0 / file.steering.rack_mm_per_rev
        cases["steer"] = replace(cases["steer"], amplitude=angle)
    return file, Axle(
        name=file.name,
        topology=file_topology(file, structure),
        values=file_values(file, structure),
        follow=dict(follow),
        load_cases=cases,
        labels=axle_type.labels,
        lines=axle_type.lines,
    )


def _with_springs(document: Mapping[str, Any], structure: Structure) -> dict[str, Any]:
    """The document with its springs' tables in one."""
    names = {spring.name for spring in structure.springs}
    out = {key: value for key, value in document.items() if key not in names}
    return out | {"springs": {key: document[key] for key in names if key in document}}
