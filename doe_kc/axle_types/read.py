"""Reads a type file: its tables, checked, to the bodies and connections of an axle."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

import numpy as np

from doe_kc.axle.structure import (
    CHASSIS_AXES,
    BallConnection,
    BarConnection,
    BushingConnection,
    KingpinLine,
    LineConnection,
    RackConnection,
    SplitBody,
    SteerArmBeam,
    Structure,
    StrutClamp,
)
from doe_kc.axle_types.checks import check_axle_type
from doe_kc.axle_types.schema import AxleTypeFile, BushingTable, ClampTable, LineTable
from doe_kc.ground.errors import InputError, nearest
from doe_kc.ground.files import read_toml, validate

FOLDER = Path(__file__).parent
DEFAULT_TYPE = "mcpherson_front"
"""Type of an axle file that names none."""
BUILT_IN = tuple(
    sorted((path.stem for path in FOLDER.glob("*.toml")), key=lambda name: (name != DEFAULT_TYPE, name))
)
"""Types that the package describes, by name, DEFAULT_TYPE first."""


@dataclass(frozen=True)
class AxleType:
    """structure: bodies and connections. label: of the type. labels: of points and elements by name.
    lines: pairs of hardpoints by the part that they draw; empty: drawn from the connections. follow: point ->
    the one whose moves it makes too, where an axle file does not say."""

    structure: Structure
    label: str
    labels: Mapping[str, str]
    lines: Mapping[str, tuple[tuple[str, str], ...]]
    follow: Mapping[str, str]


def read_axle_type(name: str, folder: Path, *, source: str) -> AxleType:
    """A built-in type by its name, else the type file of that path, seen from `folder`.

    InputError when there is neither, or the file is wrong; source: file that names the type.
    """
    if name in BUILT_IN:
        return built_in(name)
    if name.endswith(".toml"):
        path = folder / name
    else:
        raise InputError(
            f"{source}: type = {name!r} is no axle type; known are {', '.join(BUILT_IN)}, "
            f"or the path of a type file (*.toml).{nearest(name, BUILT_IN)}"
        )
    return _read(path)


@lru_cache
def built_in(name: str) -> AxleType:
    """A type of BUILT_IN, read once."""
    return _read(FOLDER / f"{name}.toml")


def _read(path: Path) -> AxleType:
    file = validate(AxleTypeFile, read_toml(path), str(path))
    check_axle_type(file, str(path))
    return AxleType(_structure(file, str(path)), file.label, _labels(file), _lines(file), file.follow)


def bushing_axes(x: list[float] | None, y: list[float] | None, where: str) -> tuple[tuple[float, ...], ...]:
    """(3, 3) as rows, axes as columns: e1 along x, e2 along what of y is across it, e3 = e1 x e2.

    InputError when x and y do not span a plane.
    """
    first = np.array(x or [1.0, 0.0, 0.0])
    second = np.array(y or [0.0, 1.0, 0.0])
    length = float(np.linalg.norm(first))
    e1 = first / length if length > 0 else first
    across = second - np.dot(second, e1) * e1
    if length == 0 or np.linalg.norm(across) < 1e-6 * max(float(np.linalg.norm(second)), 1e-300):
        raise InputError(f"{where}: x and y span no plane; expected two directions that are not parallel.")
    e2 = across / np.linalg.norm(across)
    axes = np.column_stack([e1, e2, np.cross(e1, e2)]) + 0.0  # no -0
    return tuple(tuple(float(value) for value in row) for row in axes)


def _lines(file: AxleTypeFile) -> dict[str, tuple[tuple[str, str], ...]]:
    return {name: tuple((a, b) for a, b in pairs) for name, pairs in file.lines.items()}


def _labels(file: AxleTypeFile) -> dict[str, str]:
    elements = (file.bushings, file.balls, file.rods, file.cylindricals, file.springs)
    out = {name: table.label or name for group in elements for name, table in group.items()}
    return out | file.points | file.single_points


def _structure(file: AxleTypeFile, source: str) -> Structure:
    def lines(tables: Mapping[str, LineTable]) -> tuple[LineConnection, ...]:
        return tuple(_line(name, table) for name, table in tables.items())

    return Structure(
        type=file.type,
        bodies=tuple(n for n, kind in file.bodies.items() if kind == "side"),
        single_bodies=tuple(n for n, kind in file.bodies.items() if kind == "single"),
        points=tuple(file.points),
        single_points=tuple(file.single_points),
        carrier=file.carrier,
        bushings=tuple(_bushing(name, table, source) for name, table in file.bushings.items()),
        balls=tuple(BallConnection(n, t.a, t.b, t.at, t.single, t.seat) for n, t in file.balls.items()),
        rods=lines(file.rods),
        cylindricals=lines(file.cylindricals),
        springs=lines(file.springs),
        damper=None if file.damper is None else _line("damper", file.damper),
        rack=None
        if file.rack is None
        else RackConnection(file.rack.body, file.rack.carrier, file.rack.at, tuple(file.rack.rods)),
        bar=None if file.arb is None else BarConnection(file.arb.body, file.arb.at),
        kingpin=None if file.kingpin is None else KingpinLine(**file.kingpin.model_dump()),
        subframe=None
        if file.subframe is None
        else SplitBody(file.subframe.body, tuple(file.subframe.centre)),
        strut=None if file.strut is None else _clamp(file.strut),
        steer_arm=None if file.steer_arm is None else SteerArmBeam(**file.steer_arm.model_dump()),
        fixed_points=tuple(file.fixed_points),
    )


def _line(name: str, table: LineTable) -> LineConnection:
    return LineConnection(name, table.a, table.at_a, table.b, table.at_b, table.single)


def _bushing(name: str, table: BushingTable, source: str) -> BushingConnection:
    line: tuple[str, str] | None = None
    axes: tuple[tuple[float, ...], ...] = CHASSIS_AXES
    if table.line is not None:
        line = (table.line[0], table.line[1])
    elif table.x is not None:
        axes = bushing_axes(table.x, table.y, f"{source}: [bushings.{name}]")
    return BushingConnection(name, table.inner, table.outer, table.at, table.single, line, axes, table.joint)


def _clamp(table: ClampTable) -> StrutClamp:
    return StrutClamp(table.body, table.carrier, table.at, (table.line[0], table.line[1]))
