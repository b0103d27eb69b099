"""What is read off an equilibrium: wheel angles, positions, loads, forces, per side and of the axle."""

from __future__ import annotations

from typing import ClassVar

import casadi as ca

from doe_kc.curves import RESPONSE_UNITS, SIDES
from doe_kc.solver.builder import Builder
from doe_kc.solver.elements._base import DEG, Element, Stage, element, hardpoint, mirror

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


@element
class Responses(Element):
    """Outputs `name@L`/`@R` per side, and those of the rack."""

    id: ClassVar[str] = "responses"
    stage: ClassVar[Stage] = "output"

    def assemble(self, b: Builder) -> None:
        for side in SIDES:
            values = _angles(b, side) | _positions(b, side) | _forces(b, side)
            for name in OUTPUT_UNITS:
                b.output(f"{name}@{side}", values[name])
        lateral = b.bodies["subframe.centre"].axes[:, 1]
        b.output("rack_travel", b.points["rack"])
        pulls = b.points["tie rod pull.L"] + b.points["tie rod pull.R"]
        b.output("rack_force", ca.dot(pulls, lateral))
        b.output("column_force", b.points["column force"])


def line_angles(line: ca.SX, side: str) -> tuple[ca.SX, ca.SX]:
    """(top rearwards, top inwards) angles of an upwards line in side and rear view, deg."""
    return DEG * ca.atan2(line[0], line[2]), DEG * ca.atan2(mirror(side) * line[1], line[2])


def _angles(b: Builder, side: str) -> dict[str, ca.SX]:
    spin, normal = b.points[f"spin.{side}"], b.points["pad normal"]
    knuckle, rod = b.bodies[f"knuckle.{side}"], b.bodies[f"rod.{side}"]
    lower, upper = hardpoint(b, "LWB", side), hardpoint(b, "UPB", side)
    caster, kpi = line_angles(rod.origin - knuckle.origin, side)
    carried, _ = line_angles(knuckle.axes @ (upper - lower), side)
    return {
        "toe": DEG * ca.atan2(-spin[0], -mirror(side) * spin[1]),
        "camber": -DEG * ca.asin(spin[2]),
        "camber_ground": -DEG * ca.asin(ca.dot(spin, normal)),
        "caster": caster,
        "kpi": kpi,
        "spin": carried,
    }


def _positions(b: Builder, side: str) -> dict[str, ca.SX]:
    centre, contact = b.points[f"wheel centre.{side}"], b.points[f"contact.{side}"]
    knuckle, rod = b.bodies[f"knuckle.{side}"], b.bodies[f"rod.{side}"]
    kingpin = rod.origin - knuckle.origin
    foot = knuckle.origin + kingpin * (contact[2] - knuckle.origin[2]) / kingpin[2]
    out = {f"wc_{axis}": centre[i] for i, axis in enumerate("xyz")}
    out |= {f"cp_{axis}": contact[i] for i, axis in enumerate("xyz")}
    return out | {
        "pad_z": b.points[f"pad.{side}"],
        "scrub_radius": mirror(side) * (foot[1] - contact[1]),
        "caster_trail": contact[0] - foot[0],
        "strut_compression": -b.points[f"slide.{side}"],
    }


def _forces(b: Builder, side: str) -> dict[str, ca.SX]:
    return {
        "tyre_load": b.points[f"tyre.{side}"],
        "tie_rod": b.points[f"tie rod.{side}"],
        "spring": b.points[f"spring.{side}"],
        "stop": b.points[f"stop.{side}"],
    }
