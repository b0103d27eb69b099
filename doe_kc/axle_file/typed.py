"""Reads the axle file of a type that is data: the numbers of its points, bushings and springs."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from doe_kc.axle.model import BUSHING_AXES, Axle, both
from doe_kc.axle.structure import Structure, of_side
from doe_kc.axle.topology import Topology
from doe_kc.axle_file.schema import SteerArmTable, StrutTable
from doe_kc.axle_file.tables import bushing_values, chosen_load_cases, stop_values, strut_values
from doe_kc.axle_file.typed_schema import TypedAxleFile
from doe_kc.axle_types import read_axle_type
from doe_kc.axle_types.read import bushing_axes
from doe_kc.ground.errors import InputError, nearest
from doe_kc.ground.files import validate

STEER_RACK_TRAVEL = 60.0
"""mm to either side that a steering input drives by default."""


def typed_axle(document: Mapping[str, Any], folder: Path, source: str) -> tuple[TypedAxleFile, Axle]:
    """The checked file, and the axle without its right side's own values and effects.

    folder: that a type file is seen from.
    """
    axle_type = read_axle_type(str(document["type"]), folder, source=source)
    file = validate(TypedAxleFile, _with_springs(document, axle_type.structure), source)
    _check_names(file, axle_type.structure, source)
    structure = _oriented(file, axle_type.structure, source)
    cases = chosen_load_cases(file.load_cases, source)
    if file.steering is None:
        cases.pop("steer")
    elif "steer" not in file.load_cases or file.load_cases["steer"].amplitude is None:
        cases["steer"] = replace(
            cases["steer"], amplitude=STEER_RACK_TRAVEL * 360.0 / file.steering.rack_mm_per_rev
        )
    return file, Axle(
        name=file.name,
        topology=_topology(file, structure),
        values=_values(file, structure),
        follow=dict(file.follow),
        load_cases=cases,
        labels=axle_type.labels,
        lines=axle_type.lines,
    )


def _with_springs(document: Mapping[str, Any], structure: Structure) -> dict[str, Any]:
    """The document with its springs' tables in one."""
    names = {spring.name for spring in structure.springs}
    out = {key: value for key, value in document.items() if key not in names}
    return out | {"springs": {key: document[key] for key in names if key in document}}


def _check_names(file: TypedAxleFile, structure: Structure, source: str) -> None:
    """InputError unless the file has a number for all that the type names, and nothing else."""
    points = (*structure.points, *structure.single_points)
    bushings = [bush.name for bush in structure.bushings]
    springs = [spring.name for spring in structure.springs]
    for table, names, wanted in (
        ("hardpoints", file.hardpoints, points),
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
    for follower, leader in file.follow.items():
        for point in (follower, leader):
            if point not in structure.points:
                raise InputError(
                    f"{source}: follow names {point!r}, which is not a hardpoint.{nearest(point, points)}"
                )


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


def _topology(file: TypedAxleFile, structure: Structure) -> Topology:
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


def _strut(file: TypedAxleFile) -> StrutTable:
    return file.strut or StrutTable()


def _steer_arm(file: TypedAxleFile) -> SteerArmTable:
    return file.steer_arm or SteerArmTable()


def _values(file: TypedAxleFile, structure: Structure) -> dict[str, float]:
    out: dict[str, float] = {}

    def put(name: str, value: float, *, single: bool) -> None:
        out.update({of_side(name, side): value for side in structure.sides(single=single)})

    for name, point in file.hardpoints.items():
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


def _oriented(file: TypedAxleFile, structure: Structure, source: str) -> Structure:
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
