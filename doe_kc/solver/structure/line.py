"""Directions along the line between two hardpoints."""

from __future__ import annotations

import casadi as ca

from doe_kc.solver import rotation
from doe_kc.solver.builder import Builder
from doe_kc.solver.elements._base import hardpoint, reflection


def line_direction(b: Builder, start: str, end: str, side: str) -> ca.SX:
    """Unit vector (3,) from one hardpoint to another at design."""
    key = f"{start} -> {end}@{side}"
    if key not in b.points:
        along = hardpoint(b, end, side) - hardpoint(b, start, side)
        b.points[key] = b.constant(along / ca.norm_2(along))
    return b.points[key]


def line_axes(b: Builder, start: str, end: str, side: str) -> ca.SX:
    """(3, 3) axes as columns: z along the line, x and y by the shortest turn from the chassis, mirrored on
    the right."""
    mirrored = reflection(side)
    return mirrored @ rotation.minimal_rotation_from_z(mirrored @ line_direction(b, start, end, side))
