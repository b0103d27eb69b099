"""What an ADAMS database becomes on the way to an axle file: tables, where each number came from, remarks."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from doe_kc.adams.database import AdamsDatabase
from doe_kc.adams.frame import AdamsFrame
from doe_kc.adams.name_map import NameMap
from doe_kc.adams.subsystem import AdamsElement, AdamsParameter, AdamsSide, AdamsSubsystem, HardpointRow
from doe_kc.adams.teim_orbit import Cell, OrbitBlock, TeimOrbitFile
from doe_kc.axle.structure import Structure
from doe_kc.ground.errors import InputError

LOCKED_FORCE = 1e6
"""N/mm of a direction that a joint, or a part that is locked, holds."""
LOCKED_TORQUE = 1e5
"""Nm/deg of the same."""
FREE_FORCE = 1e-2
"""N/mm along an axis without force."""
FREE_TORQUE = 1e-3
"""Nm/deg about an axis that a joint leaves free."""


@dataclass(frozen=True)
class NumberPlace:
    """Where the number stands that a parameter is made of: parameter = gain * number + shift.

    path: parameter path, of the left side or of both; `right.` for a row of the right side alone. side_cell,
    block: of the row or block that holds it, to split one of both sides.
    """

    path: str
    file: TeimOrbitFile
    cell: Cell
    side: AdamsSide
    side_cell: Cell
    gain: float = 1.0
    shift: float = 0.0
    block: OrbitBlock | None = None


@dataclass(frozen=True)
class ElementPlace:
    """The element that a part of the axle is made of. signs: (3,) +1 or -1; order: (3,) ADAMS axis, of each
    local axis; of a bushing only."""

    subsystem: AdamsSubsystem
    element: AdamsElement
    property_path: Path | None = None
    order: tuple[int, ...] = (0, 1, 2)
    signs: tuple[float, ...] = (1.0, 1.0, 1.0)


@dataclass
class Conversion:
    """structure: of the type, None for the McPherson axle. document: the axle file's tables. comments: by
    table and key. numbers, elements: where things came from. inferred, left_out, missing: sentences for the
    user. spring_force: N in the spring at design, None where no file says it. files: all that were read."""

    database: AdamsDatabase
    names: NameMap
    structure: Structure | None
    frame: AdamsFrame = field(default_factory=lambda: AdamsFrame(np.ones(3)))
    document: dict[str, Any] = field(default_factory=dict)
    comments: dict[tuple[str, ...], str] = field(default_factory=dict)
    numbers: list[NumberPlace] = field(default_factory=list)
    elements: dict[str, ElementPlace] = field(default_factory=dict)
    inferred: list[str] = field(default_factory=list)
    left_out: list[str] = field(default_factory=list)
    missing: list[str] = field(default_factory=list)
    files: list[Path] = field(default_factory=list)
    spring_force: float | None = None
    axes: dict[str, np.ndarray] = field(default_factory=dict)
    """(3, 3) local axes as columns of bushings, chassis frame, as the files have them."""

    def row(self, names: Iterable[str]) -> list[tuple[AdamsSubsystem, HardpointRow]]:
        """All rows of the first of these hardpoints that a subsystem has, whatever the case."""
        for name in names:
            rows = [
                (s, row)
                for s in self.database.subsystems
                for row in s.hardpoints
                if row.name.lower() == name.lower()
            ]
            if rows:
                return rows
        return []

    def element(self, kind: str, names: Iterable[str]) -> list[tuple[AdamsSubsystem, AdamsElement]]:
        """Blocks of the first of these elements that a subsystem has; without one the only one of its kind,
        unless that is a bushing or a gear."""
        of_kind = [(s, e) for s in self.database.subsystems for e in s.elements if e.kind == kind]
        for name in names:
            blocks = [(s, e) for s, e in of_kind if e.usage.lower() == name.lower()]
            homes = {s.path for s, _ in blocks}
            if len(homes) > 1:
                raise InputError(
                    f"{blocks[1][0].where(blocks[1][1])}: is in {', '.join(p.name for p in sorted(homes))} "
                    "too; "
                    "leave the subsystem out that does not count, or rename it in the name map."
                )
            if blocks:
                return blocks
        usages = {e.usage for _, e in of_kind}
        if kind not in ("bushing", "gear") and len(usages) == 1:
            self.inferred.append(f"the {kind} is {usages.pop()!r}, the only one there")
            return of_kind
        return []

    def parameter(self, names: Iterable[str]) -> tuple[TeimOrbitFile, AdamsParameter] | None:
        """The first of these parameters that a subsystem or the assembly has, of both sides or the left."""
        rows = [(s.file, p) for s in self.database.subsystems for p in s.parameters]
        if self.database.assembly is not None:
            rows += [(self.database.assembly, p) for p in self.database.parameters]
        for name in names:
            for file, row in rows:
                if row.name.lower() == name.lower() and row.side != "right":
                    return file, row
        return None

    def switched_off(self, name: str) -> bool:
        """Whether a parameter is there and 0."""
        if not name:
            return False
        row = self.parameter([name])
        return row is not None and row[0].number(row[1].cell) == 0.0

    def put(self, table: str, key: str, value: Any, comment: str) -> None:
        """One entry of the axle file with what it is made of."""
        self.document.setdefault(table, {})[key] = value
        self.comments[table, key] = comment

    def put_right(self, path: str, value: float, comment: str) -> None:
        """A value of the right side alone."""
        self.put("right", path, value, comment)


def left_and_right(
    rows: list[tuple[AdamsSubsystem, AdamsElement]],
) -> tuple[tuple[AdamsSubsystem, AdamsElement], tuple[AdamsSubsystem, AdamsElement] | None]:
    """The element that counts for the left side, and that of the right where it has its own."""
    left = next((r for r in rows if r[1].side != "right"), rows[0])
    right = next((r for r in rows if r[1].side == "right"), None)
    return left, right if right is not left else None
