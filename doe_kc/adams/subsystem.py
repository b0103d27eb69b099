"""A subsystem file of ADAMS/Car: hardpoints, elements with their property files, parameters."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import numpy as np

from doe_kc.adams.teim_orbit import Cell, CellTable, OrbitBlock, TeimOrbitFile, read_teim_orbit
from doe_kc.adams.units import FileUnits, file_units
from doe_kc.ground.errors import InputError
from doe_kc.ground.typing import FloatArray

AdamsSide = Literal["left/right", "left", "right", "single"]
"""left/right: of the left side, mirrored for the right."""
SYMMETRIES: tuple[AdamsSide, ...] = ("left/right", "left", "right", "single")
ELEMENT_BLOCKS = {
    "BUSHING_ASSEMBLY": "bushing",
    "NSPRING_ASSEMBLY": "spring",
    "SPRING_ASSEMBLY": "spring",
    "DAMPER_ASSEMBLY": "damper",
    "BUMPSTOP_ASSEMBLY": "bump stop",
    "REBOUNDSTOP_ASSEMBLY": "rebound stop",
    "REBOUND_STOP_ASSEMBLY": "rebound stop",
    "GEAR_ASSEMBLY": "gear",
    "WHEEL_ASSEMBLY": "wheel",
    "TIRE_ASSEMBLY": "wheel",
}
"""Blocks of elements, and what each is."""
KNOWN_BLOCKS = {
    *("MDI_HEADER", "SUBSYSTEM_HEADER", "UNITS", "HARDPOINT", "PARAMETER", "PLOT", "HARDPOINT_TABLE"),
    *("PART_ASSEMBLY", "LINK_GEOMETRY", "ARM_GEOMETRY", "SWITCH_PART", "ADJUSTABLE_FORCE", "GENERAL_SPLINE"),
    *("GENERAL_PARAMETER", "TESTRIG", "OUTLINE_GEOMETRY", "ELLIPSOID_GEOMETRY", "CYLINDER_GEOMETRY"),
    *ELEMENT_BLOCKS,
}
"""Blocks that are read, or that hold nothing of an axle's kinematics and compliance."""


@dataclass(frozen=True)
class HardpointRow:
    """A hardpoint of one file. place: (3,) in mm, file's frame. cells: of x, y, z; side_cell: symmetry."""

    name: str
    side: AdamsSide
    place: FloatArray
    cells: tuple[Cell, Cell, Cell]
    side_cell: Cell


@dataclass(frozen=True)
class AdamsElement:
    """A block of a bushing, spring, stop, gear or wheel. kind: as in `ELEMENT_BLOCKS`. usage: its name."""

    kind: str
    usage: str
    side: AdamsSide
    block: OrbitBlock


@dataclass(frozen=True)
class AdamsParameter:
    """A row of `[PARAMETER]`: its value as it stands."""

    name: str
    side: AdamsSide
    cell: Cell
    side_cell: Cell


@dataclass(frozen=True)
class AdamsSubsystem:
    """One `.sub`. role: `suspension`, `steering`, …; minor_role: `front`, `rear`, `any`, ….

    unknown: blocks of which nothing is known, each once.
    """

    file: TeimOrbitFile
    units: FileUnits
    role: str
    minor_role: str
    template: str
    hardpoints: tuple[HardpointRow, ...]
    elements: tuple[AdamsElement, ...]
    parameters: tuple[AdamsParameter, ...]
    unknown: tuple[str, ...]

    @property
    def path(self) -> Path:
        """The file."""
        return self.file.path

    def number_of(self, element: AdamsElement, key: str, default: float | None = None) -> float:
        """A number of an element; the default where the key is missing, InputError without one."""
        if default is not None and key not in element.block.entries:
            return default
        return self.file.number(self.file.cell(element.block, key))

    def where(self, element: AdamsElement) -> str:
        """The element's place, for messages: `front.sub: line 12: [BUSHING_ASSEMBLY] lca_front`."""
        return f"{self.path}: line {element.block.line}: [{element.block.name}] {element.usage}"


@dataclass(frozen=True)
class SubsystemRole:
    """What part of a car a subsystem is. role: `suspension`, …; minor_role: `front`, …, `any` without one."""

    role: str
    minor_role: str
    template: str


def subsystem_role(file: TeimOrbitFile) -> SubsystemRole:
    """Role by the header; InputError for another type of file."""
    kind = file.cell(file.one("MDI_HEADER"), "FILE_TYPE")
    if kind.text.lower() != "sub":
        raise InputError(
            f"{file.path}: line {kind.line}: FILE_TYPE is {kind.text!r}, expected 'sub'; name a subsystem."
        )
    header = file.one("SUBSYSTEM_HEADER")
    minor = header.entries["MINOR_ROLE"].text.lower() if "MINOR_ROLE" in header.entries else ""
    role = file.cell(header, "MAJOR_ROLE").text.lower()
    return SubsystemRole(role, minor or "any", file.cell(header, "TEMPLATE_NAME").text)


def read_subsystem(path: Path) -> AdamsSubsystem:
    """A subsystem; InputError for another type of file, and for anything in it that does not read."""
    return subsystem_of(read_teim_orbit(path, "subsystem file (.sub)"))


def subsystem_of(file: TeimOrbitFile) -> AdamsSubsystem:
    """The subsystem of a file; InputError as `read_subsystem`."""
    role, units = subsystem_role(file), file_units(file)
    known = [block.name for block in file.blocks if block.name not in KNOWN_BLOCKS]
    return AdamsSubsystem(
        file,
        units,
        role=role.role,
        minor_role=role.minor_role,
        template=role.template,
        hardpoints=_hardpoints(file, units),
        elements=_elements(file),
        parameters=tuple(parameters_of(file)),
        unknown=tuple(dict.fromkeys(known)),
    )


def _hardpoints(file: TeimOrbitFile, units: FileUnits) -> tuple[HardpointRow, ...]:
    if not file.has("HARDPOINT"):
        return ()
    table = file.table(file.one("HARDPOINT"))
    at = _columns(file, table, "hardpoint_name", "symmetry", "x_value", "y_value", "z_value")
    rows = []
    for row in table.rows:
        name, side, x, y, z = (row[i] for i in at)
        place = np.array([file.number(cell) for cell in (x, y, z)]) * units.length
        rows.append(HardpointRow(name.text, _side(file, side), place, (x, y, z), side))
    _refuse_repeats(file, [(r.name.lower(), r.side, r.side_cell.line) for r in rows], "hardpoint")
    return tuple(rows)


def parameters_of(file: TeimOrbitFile) -> list[AdamsParameter]:
    """Rows of `[PARAMETER]`, none where there is no such block or it is empty."""
    if not file.has("PARAMETER"):
        return []
    block = file.one("PARAMETER")
    if not block.tables:
        return []
    table = file.table(block)
    at = _columns(file, table, "parameter_name", "symmetry", "value")
    rows = [
        AdamsParameter(row[at[0]].text, _side(file, row[at[1]]), row[at[2]], row[at[1]]) for row in table.rows
    ]
    _refuse_repeats(file, [(r.name.lower(), r.side, r.side_cell.line) for r in rows], "parameter")
    return rows


def _elements(file: TeimOrbitFile) -> tuple[AdamsElement, ...]:
    out = []
    for name in dict.fromkeys(block.name for block in file.blocks):
        if name not in ELEMENT_BLOCKS:
            continue
        for block in file.all_of(name):
            side = file.cell(block, "SYMMETRY")
            usage = file.cell(block, "USAGE").text
            out.append(AdamsElement(ELEMENT_BLOCKS[name], usage, _side(file, side), block))
    _refuse_repeats(file, [(f"{e.kind} {e.usage.lower()}", e.side, e.block.line) for e in out], "element")
    return tuple(out)


def _columns(file: TeimOrbitFile, table: CellTable, *names: str) -> list[int]:
    for name in names:
        if name not in table.columns:
            raise InputError(
                f"{file.path}: line {table.line}: the table has no column {name}; it has "
                f"{', '.join(table.columns)}."
            )
    return [table.columns.index(name) for name in names]


def _side(file: TeimOrbitFile, cell: Cell) -> AdamsSide:
    for word in SYMMETRIES:
        if cell.text.lower() == word:
            return word
    raise InputError(
        f"{file.path}: line {cell.line}: symmetry is {cell.text[:40]!r}, expected {', '.join(SYMMETRIES)}."
    )


def _refuse_repeats(file: TeimOrbitFile, rows: list[tuple[str, AdamsSide, int]], what: str) -> None:
    """InputError for two rows or blocks that say the same side of the same name."""
    sides: dict[str, dict[str, int]] = {}
    for name, side, line in rows:
        for each in ("left", "right") if side == "left/right" else (side,):
            before = sides.setdefault(name, {}).setdefault(each, line)
            if before != line:
                raise InputError(
                    f"{file.path}: line {line}: the {what} {name} ({side}) is there already in line "
                    f"{before}; "
                    "remove the one that does not count."
                )
