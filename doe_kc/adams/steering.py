"""Steering of the files: rack travel per turn, column stiffness, rack mount."""

from __future__ import annotations

import math

import numpy as np

from doe_kc.adams.bushing_orientation import nearest_axes
from doe_kc.adams.bushings import adams_axis, is_plain_bushing
from doe_kc.adams.centre_stiffness import bushing_laws, centre_slope
from doe_kc.adams.conversion import Conversion, ElementPlace, NumberPlace, left_and_right
from doe_kc.adams.orientation import element_axes
from doe_kc.adams.points import PRODUCT_DIGITS, tidy
from doe_kc.axle.model import NM_PER_DEG
from doe_kc.ground.errors import InputError

RATIOS: dict[str, tuple[float, int]] = {
    "mm/deg": (360.0, 1),
    "mm/rad": (2.0 * math.pi, 1),
    "mm/rev": (1.0, 1),
    "rad/mm": (2.0 * math.pi, -1),
    "deg/mm": (360.0, -1),
}
"""Rack travel in mm per turn from a ratio of that unit: factor, and power of the ratio."""


def add_steering(conversion: Conversion) -> None:
    """`[steering]`: rack travel per turn, column stiffness at the rack; rack mount as an effect."""
    c = conversion
    travel = _rack_travel(c)
    if travel is not None:
        c.put("steering", "rack_mm_per_rev", travel[0], travel[1])
    rows = c.element("bushing", c.names.steering.torsion_bar)
    own = c.names.values.get("steering.rack_mm_per_rev", travel[0] if travel else None)
    if rows and own is not None:
        subsystem, element = left_and_right(rows)[0]
        table, path = bushing_laws(c, ("Tz",), subsystem, element, "torsion bar", (0, 1, 2))
        twist = centre_slope(c, table, "Tz", path)
        column = tidy(twist * NM_PER_DEG * (2.0 * math.pi / own) ** 2, PRODUCT_DIGITS)
        c.put(
            "steering",
            "column",
            column,
            f"{subsystem.path.name}: {element.usage}; {path.name}, at the rack",
        )
        c.elements["torsion_bar"] = ElementPlace(subsystem, element, path)
    _add_rack_mount(c)


def rack_travel(ratio: float, unit: str) -> float:
    """mm per turn of the steering wheel from a reduction ratio of that unit."""
    factor, power = RATIOS[unit]
    return factor * ratio**power


def _rack_travel(c: Conversion) -> tuple[float, str] | None:
    """mm per turn and its source; None where no gear, or no unit of its ratio, is there."""
    rows = c.element("gear", c.names.steering.gear)
    if not rows:
        return None
    subsystem, element = rows[0]
    key = "REDUCTION_RATIO"
    ratio = abs(subsystem.number_of(element, key))
    if ratio == 0.0:
        raise InputError(f"{subsystem.where(element)}: {key} is 0; expected the ratio of pinion and rack.")
    unit = c.names.steering.ratio_unit
    if not unit:
        if "steering.rack_mm_per_rev" not in c.names.values:
            readings = ", ".join(f"{rack_travel(ratio, u):.4g} mm per turn if {u}" for u in RATIOS)
            c.missing.append(
                f"the unit of {key} {ratio:g} of {element.usage} in {subsystem.path.name}, which no file "
                "states "
                f"({readings}): give ratio_unit under [steering]"
            )
        return None
    travel = tidy(rack_travel(ratio, unit), PRODUCT_DIGITS)
    if unit.startswith("mm"):
        entries = element.block.entries
        c.numbers.append(
            NumberPlace(
                "steering.rack_mm_per_rev",
                subsystem.file,
                entries[key],
                element.side,
                entries["SYMMETRY"],
                gain=math.copysign(rack_travel(1.0, unit), subsystem.number_of(element, key)),
                block=element.block,
            )
        )
    c.elements["rack"] = ElementPlace(subsystem, element)
    c.inferred.append(
        f"{key} of {element.usage} is in {unit}, by the name map: {travel:.5g} mm of rack per turn"
    )
    return travel, f"{subsystem.path.name}: {element.usage}, {unit} by the name map"


def _add_rack_mount(c: Conversion) -> None:
    """Two housing bushings, one a side, carry the rack along Y: the effect rack_mount_compliance."""
    rows = c.element("bushing", c.names.steering.rack_mount)
    if not rows:
        return
    subsystem, element = left_and_right(rows)[0]
    if not is_plain_bushing(subsystem, element):
        c.left_out.append(f"{subsystem.where(element)}: its class is not read")
        return
    source = element_axes(subsystem, element, None)
    order: tuple[int, ...] = (0, 1, 2)
    if source is not None:
        order, _, _ = nearest_axes(np.eye(3), c.frame.signs[:, None] * source.axes)
    table, path = bushing_laws(c, ("Fy",), subsystem, element, "rack mount", order)
    count = 2.0 if element.side == "left/right" else 1.0
    rate = tidy(count * centre_slope(c, table, "Fy", path), PRODUCT_DIGITS)
    c.document.setdefault("effects", {})["rack_mount_compliance"] = {"k_N_mm": rate}
    c.comments["effects", "rack_mount_compliance"] = f"{subsystem.path.name}: {element.usage}; {path.name}"
    key = f"{adams_axis('Fy', order).upper()}_SCALING_FACTOR"
    if key in element.block.entries and (scale := subsystem.number_of(element, key)) > 0.0:
        entries = element.block.entries
        c.numbers.append(
            NumberPlace(
                "rack_mount.rate",
                subsystem.file,
                entries[key],
                element.side,
                entries["SYMMETRY"],
                gain=rate / scale,
                block=element.block,
            )
        )
    c.inferred.append(
        f"the rack's mount is {count:g} x FY of {element.usage}; its other directions are left out"
    )
