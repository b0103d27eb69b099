"""Mirror images, hardpoints and units that several elements share."""

from __future__ import annotations

import casadi as ca

from doe_kc.axle.structure import of_side
from doe_kc.solver.builder import Builder

DEG = 180 / ca.pi


def mirror(side: str) -> int:
    """-1 for the right side, +1 for the left and for what is of no side."""
    return -1 if side == "R" else 1


def reflection(side: str) -> ca.SX:
    """Matrix that takes left-side vectors to this side."""
    return ca.diag(ca.SX([1, mirror(side), 1]))


def hardpoint(b: Builder, name: str, side: str) -> ca.SX:
    """Design position (3,) of a hardpoint in the chassis frame, mm; side empty: of a single point."""
    key = of_side(name, side)
    if key not in b.points:
        x, y, z = (b.parameter(of_side(f"{name}.{axis}", side)) for axis in "xyz")
        b.points[key] = b.constant(ca.vertcat(x, mirror(side) * y, z))
    return b.points[key]
