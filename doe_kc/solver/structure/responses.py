"""What is read off an equilibrium of a structure.

Without a kingpin the design vertical on the carrier stands in for it, and there is neither scrub radius nor
caster trail.
"""

from __future__ import annotations

import casadi as ca

from doe_kc.axle.structure import Structure
from doe_kc.curves import SIDES
from doe_kc.solver.builder import Builder
from doe_kc.solver.elements._base import DEG, hardpoint, mirror
from doe_kc.solver.elements.responses import OUTPUT_UNITS, line_angles


def add_responses(b: Builder, structure: Structure) -> None:
    """Outputs `name@L`/`@R` per side, and those of the rack."""
    for side in SIDES:
        values = _angles(b, structure, side) | _positions(b, structure, side) | _forces(b, structure, side)
        for name in dict.fromkeys((*OUTPUT_UNITS, *values)):
            if name in values:
                b.output(f"{name}@{side}", values[name])
    if structure.rack is not None:
        lateral = b.bodies[structure.rack.carrier].axes[:, 1]
        rods = [name.replace("_", " ") for name in structure.rack.rods]
        pulls = sum((b.points[f"{r} pull.{side}"] for r in rods for side in SIDES), ca.SX.zeros(3))
        b.output("rack_travel", b.points["rack"])
        b.output("rack_force", ca.dot(pulls, lateral))
        b.output("column_force", b.points["column force"])


def _kingpin(b: Builder, structure: Structure, side: str) -> tuple[ca.SX, ca.SX] | None:
    """(lower point, upper minus lower point) now."""
    if (pin := structure.kingpin) is None:
        return None
    lower = b.bodies[structure.part_on_side(pin.lower_body, side)].point(hardpoint(b, pin.lower, side))
    upper = b.bodies[structure.part_on_side(pin.upper_body, side)].point(hardpoint(b, pin.upper, side))
    return lower, upper - lower


def _carried_line(b: Builder, structure: Structure, side: str) -> ca.SX:
    """The design kingpin, or the design vertical, carried rigidly by the carrier."""
    design = ca.SX([0, 0, 1])
    if (pin := structure.kingpin) is not None:
        design = hardpoint(b, pin.upper, side) - hardpoint(b, pin.lower, side)
    return b.bodies[f"carrier.{side}"].axes @ design


def _angles(b: Builder, structure: Structure, side: str) -> dict[str, ca.SX]:
    spin, normal = b.points[f"spin.{side}"], b.points["pad normal"]
    carried = _carried_line(b, structure, side)
    pin = _kingpin(b, structure, side)
    caster, kpi = line_angles(carried if pin is None else pin[1], side)
    return {
        "toe": DEG * ca.atan2(-spin[0], -mirror(side) * spin[1]),
        "camber": -DEG * ca.asin(spin[2]),
        "camber_ground": -DEG * ca.asin(ca.dot(spin, normal)),
        "caster": caster,
        "kpi": kpi,
        "spin": line_angles(carried, side)[0],
    }


def _positions(b: Builder, structure: Structure, side: str) -> dict[str, ca.SX]:
    centre, contact = b.points[f"wheel centre.{side}"], b.points[f"contact.{side}"]
    out = {f"wc_{axis}": centre[i] for i, axis in enumerate("xyz")}
    out |= {f"cp_{axis}": contact[i] for i, axis in enumerate("xyz")}
    out |= {"pad_z": b.points[f"pad.{side}"], "strut_compression": b.points[f"shortening.{side}"]}
    pin = _kingpin(b, structure, side)
    if pin is None:
        return out
    lower, line = pin
    foot = lower + line * (contact[2] - lower[2]) / line[2]
    return out | {
        "scrub_radius": mirror(side) * (foot[1] - contact[1]),
        "caster_trail": contact[0] - foot[0],
    }


def _forces(b: Builder, structure: Structure, side: str) -> dict[str, ca.SX]:
    """The rods that there are on either side, by name, and the forces that every axle has."""
    rods = [rod.name for rod in structure.rods if not rod.single]
    return {name: b.points[f"{name.replace('_', ' ')}.{side}"] for name in rods} | {
        "tyre_load": b.points[f"tyre.{side}"],
        "spring": b.points[f"spring.{side}"],
        "stop": b.points[f"stop.{side}"],
    }
