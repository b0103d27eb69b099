"""Units of what is read off an equilibrium, and the angles of lines."""

from __future__ import annotations

import casadi as ca

from doe_kc.curves import RESPONSE_UNITS
from doe_kc.solver.elements._base import DEG, mirror

OUTPUT_UNITS = {
    **RESPONSE_UNITS,
    "camber_ground": "deg",
    "kpi": "deg",
    "cp_x": "mm",
    "cp_y": "mm",
    "cp_z": "mm",
    "pad_z": "mm",
    "tie_rod": "N",
    "strut_compression": "mm",
    "spring": "N",
    "stop": "N",
    "scrub_radius": "mm",
    "caster_trail": "mm",
}
"""Per side; the chassis frame, absolute values."""

AXLE_OUTPUT_UNITS = {"rack_travel": "mm", "rack_force": "N", "column_force": "N"}
"""Of the axle as a whole."""


def output_unit(name: str) -> str:
    """Unit of an output without its side; outputs beyond the tables are the forces of rods."""
    return OUTPUT_UNITS.get(name) or AXLE_OUTPUT_UNITS.get(name) or "N"


def line_angles(line: ca.SX, side: str) -> tuple[ca.SX, ca.SX]:
    """(top rearwards, top inwards) angles of an upwards line in side and rear view, deg."""
    return DEG * ca.atan2(line[0], line[2]), DEG * ca.atan2(mirror(side) * line[1], line[2])
