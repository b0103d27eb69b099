"""Topology and internal values of an axle from its checked file."""

from __future__ import annotations

from dataclasses import replace

from doe_kc.axle.model import BUSHING_AXES, both, strut_clamp
from doe_kc.axle.structure import Structure, of_side
from doe_kc.axle.topology import Topology
from doe_kc.axle_file.schema import AxleFile, SteerArmTable, StrutTable
from doe_kc.axle_file.tables import bushing_values, stop_values, strut_values
from doe_kc.axle_types.read import bushing_axes
from doe_kc.ground.errors import InputError


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
