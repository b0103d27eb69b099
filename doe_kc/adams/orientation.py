"""Local axes of an ADAMS element: from its keys, its comment, or a rule."""

from __future__ import annotations

import re
from dataclasses import dataclass

import numpy as np

from doe_kc.adams.subsystem import AdamsElement, AdamsSubsystem
from doe_kc.axle_types.read import bushing_axes
from doe_kc.ground.errors import InputError
from doe_kc.ground.typing import FloatArray

NUMBER_WORD = r"([-+]?[\d.]+(?:[eEdD][-+]?\d+)?)"
VECTOR_COMMENT = re.compile(
    rf"(ZP|XP)\s+vector\s*=\s*{NUMBER_WORD}\s*,\s*{NUMBER_WORD}\s*,\s*{NUMBER_WORD}", re.IGNORECASE
)
STALE = 1.0
"""deg between a comment and the points it depends on, from which it no longer tells their direction."""


@dataclass(frozen=True)
class AxesSource:
    """axes: (3, 3) local axes as columns, file's frame. z_only: whether x and y are free about z.
    where: what told them, in words."""

    axes: FloatArray
    z_only: bool
    where: str


def element_axes(
    subsystem: AdamsSubsystem, element: AdamsElement, rule: FloatArray | None
) -> AxesSource | None:
    """Axes of an element; None where nothing tells them. rule: (3,) direction of z from points, or None.

    InputError for directions that span no plane.
    """
    file, block = subsystem.file, element.block
    keyed = {name: _keyed(subsystem, element, name) for name in ("ZP", "XP")}
    where = "its keys ORIENTATION"
    if keyed["ZP"] is None:
        where = "its comment"
        for _, text in block.comments:
            if match := VECTOR_COMMENT.match(text):
                numbers = [float(re.sub("[dD]", "e", word)) for word in match.groups()[1:] if _plain(word)]
                if len(numbers) == 3 and max(map(abs, numbers)) > 1e-6:
                    keyed[match[1].upper()] = np.array(numbers)
    z = keyed["ZP"]
    if z is None and rule is not None:
        z, where = rule, "the points it lies between"
    if z is None:
        return None
    return AxesSource(
        _axes(z, keyed["XP"], f"{file.path}: line {block.line}: orientation of {element.usage}"),
        keyed["XP"] is None,
        where,
    )


def _plain(word: str) -> bool:
    try:
        return abs(float(re.sub("[dD]", "e", word))) < 1e6
    except ValueError:
        return False


def _keyed(subsystem: AdamsSubsystem, element: AdamsElement, name: str) -> FloatArray | None:
    keys = [f"ORIENTATION_{name}{i}" for i in (1, 2, 3)]
    if not any(key in element.block.entries for key in keys):
        keys = [f"ORIENTATION_{name}_{axis}" for axis in "XYZ"]
    if not any(key in element.block.entries for key in keys):
        return None
    vector = np.array([subsystem.number_of(element, key) for key in keys])
    if not np.abs(vector).max() > 1e-6:
        raise InputError(f"{subsystem.where(element)}: its {name} vector has no length; correct it.")
    return vector


def _axes(z: FloatArray, x: FloatArray | None, where: str) -> FloatArray:
    """z along ZP, x in the plane of ZP and XP; without XP by the shortest turn from the frame's axes."""
    unit = z / np.linalg.norm(z)
    if x is None:
        return shortest_turn(unit)
    swapped = np.array(bushing_axes(unit.tolist(), x.tolist(), where))  # columns z, x, y
    return np.column_stack([swapped[:, 1], swapped[:, 2], swapped[:, 0]])


def shortest_turn(z: FloatArray) -> FloatArray:
    """(3, 3) axes as columns whose z is that unit vector, turned from the frame's about one axis."""
    c = float(z[2])
    if c < -1.0 + 1e-12:
        return np.diag([1.0, -1.0, -1.0])
    v = np.array([-z[1], z[0], 0.0])
    cross = np.array([[0.0, 0.0, v[1]], [0.0, 0.0, -v[0]], [-v[1], v[0], 0.0]])
    return np.asarray(np.eye(3) + cross + cross @ cross / (1.0 + c))
