"""Rack, column, rack mount and anti-roll bar of the files; static angles, tyre and hub."""

from __future__ import annotations

import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from doe_kc.adams.bushing_orientation import nearest_axes
from doe_kc.adams.bushings import adams_axis, bushing_table, is_plain_bushing
from doe_kc.adams.conversion import Conversion, ElementPlace, NumberPlace, left_and_right
from doe_kc.adams.orientation import element_axes
from doe_kc.adams.points import PRODUCT_DIGITS, tidy
from doe_kc.adams.subsystem import AdamsElement, AdamsSubsystem
from doe_kc.adams.teim_orbit import read_teim_orbit
from doe_kc.adams.units import file_units
from doe_kc.axle.model import NM_PER_DEG
from doe_kc.ground.errors import InputError

TORSION_FACTORS = {
    "Nmm/deg": 180.0 / math.pi,
    "Nm/deg": 1000.0 * 180.0 / math.pi,
    "Nmm/rad": 1.0,
    "Nm/rad": 1000.0,
}
"""To N mm/rad."""
RATIOS: dict[str, tuple[float, int]] = {
    "mm/deg": (360.0, 1),
    "mm/rad": (2.0 * math.pi, 1),
    "mm/rev": (1.0, 1),
    "rad/mm": (2.0 * math.pi, -1),
    "deg/mm": (360.0, -1),
}
"""Rack travel in mm per turn from a ratio of that unit: factor, and power of the ratio."""
TYRE_KEY = "VERTICAL_STIFFNESS"
"""Of a tyre's own file."""
LINK_TILT = 15.0
"""deg of a drop link from the vertical, from which its pull along itself is told."""


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
        table, path = _laws(c, ("Tz",), subsystem, element, "torsion bar", (0, 1, 2))
        twist = _centre_slope(c, table, "Tz", path)
        column = tidy(twist * NM_PER_DEG * (2.0 * math.pi / own) ** 2, PRODUCT_DIGITS)
        c.put(
            "steering",
            "column",
            column,
            f"{subsystem.path.name}: {element.usage}; {path.name}, at the rack",
        )
        c.elements["torsion_bar"] = ElementPlace(subsystem, element, path)
    _add_rack_mount(c)


def _laws(
    c: Conversion,
    axes: tuple[str, ...],
    subsystem: AdamsSubsystem,
    element: AdamsElement,
    name: str,
    order: tuple[int, ...],
) -> tuple[dict[str, Any], Path]:
    """A bushing's table of which some axes count; what is remarked on others is not told."""
    before = list(c.inferred)
    table, path = bushing_table(c, subsystem, element, name, order, (1.0, 1.0, 1.0))
    remarks = c.inferred[len(before) :]
    c.inferred[:] = before + [r for r in remarks if any(f" {axis} " in r for axis in axes)]
    return table, path


def _centre_slope(c: Conversion, table: Mapping[str, Any], axis: str, path: Path) -> float:
    """Stiffness at zero deflection with its factor, N/mm or Nm/deg; of a curve between its nearest points."""
    factor = float(table.get("factor", {}).get(axis, 1.0))
    if axis not in table.get("table", {}):
        return factor * float(table["stiffness"][axis])
    x, y = np.array(table["table"][axis]).T
    reach = float(np.abs(x[x != 0.0]).min())
    c.inferred.append(f"{path.name}: {axis} is not straight; its slope at zero counts")
    return factor * float(np.interp(reach, x, y) - np.interp(-reach, x, y)) / (2.0 * reach)


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
    table, path = _laws(c, ("Fy",), subsystem, element, "rack mount", order)
    count = 2.0 if element.side == "left/right" else 1.0
    rate = tidy(count * _centre_slope(c, table, "Fy", path), PRODUCT_DIGITS)
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


def add_bar(conversion: Conversion) -> None:
    """`[arb]`: rate = torsional stiffness over the square of the lever; 0 where there is no bar."""
    c, names = conversion, conversion.names.arb
    row = c.parameter(names.torsion)
    if row is None:
        if "arb.rate" not in c.names.values:
            c.put("arb", "rate", 0.0, "no anti-roll bar among the files")
            c.inferred.append(f"there is no anti-roll bar: none of {', '.join(names.torsion)} is there")
        return
    file, parameter = row
    torsion = file.number(parameter.cell) * TORSION_FACTORS[names.torsion_unit]
    lever = _lever(c)
    if lever is None:
        if "arb.rate" not in c.names.values:
            c.missing.append(
                f"the lever of the anti-roll bar: hardpoints {' or '.join(names.axis)} and "
                f"{' or '.join(names.arm_end)}; correct axis and arm_end under [arb], or give arb.rate"
            )
        return
    c.put(
        "arb",
        "rate",
        tidy(torsion / lever**2, PRODUCT_DIGITS),
        f"{file.path.name}: {parameter.name}, lever {lever:.6g} mm",
    )
    c.numbers.append(
        NumberPlace(
            "arb.rate",
            file,
            parameter.cell,
            parameter.side,
            parameter.side_cell,
            gain=TORSION_FACTORS[names.torsion_unit] / lever**2,
        )
    )
    c.inferred.append(
        f"{parameter.name} is in {names.torsion_unit}, by the name map, on a lever of {lever:.5g} mm along X"
    )


def _lever(c: Conversion) -> float | None:
    """mm along X from the bar's axis to the drop link's end on it."""
    axis, end = (
        next((r.place for _, r in c.row(names) if r.side != "right"), None)
        for names in (c.names.arb.axis, c.names.arb.arm_end)
    )
    if axis is None or end is None:
        return None
    lever = abs(float(end[0] - axis[0]))
    if lever < 1.0:
        raise InputError(
            f"{c.database.subsystems[0].path}: the anti-roll bar's arm has {lever:.3g} mm along X; expected "
            "more. "
            "Correct axis and arm_end under [arb] of the name map."
        )
    points = c.document.get("hardpoints", {})
    if "ARB" in points:
        link = np.array(points["ARB"]) - c.frame.place(end)
        length = float(np.linalg.norm(link))
        tilt = float(np.degrees(np.arccos(min(1.0, abs(link[2]) / length)))) if length > 0.0 else 0.0
        if tilt > LINK_TILT:
            c.inferred.append(
                f"the drop link stands {tilt:.0f} deg from the vertical; its force is taken as vertical"
            )
    return lever


def add_static(conversion: Conversion) -> None:
    """`[static]` and `[tyre]` from parameters; what is missing is noted where all is put together."""
    c = conversion
    for key, names in (("toe", c.names.parameters.toe), ("camber", c.names.parameters.camber)):
        row = c.parameter(names)
        if row is None:
            continue
        file, parameter = row
        c.put("static", key, file.number(parameter.cell), f"{file.path.name}: {parameter.name}")
        c.numbers.append(
            NumberPlace(f"static.{key}", file, parameter.cell, parameter.side, parameter.side_cell)
        )
        words = "toe-in" if key == "toe" else "top outwards"
        c.inferred.append(f"{parameter.name} is taken as {words} positive, in deg")
        _add_right_angle(c, key, parameter.name)
    _add_tyre(c)
    kinematic = c.parameter(c.names.parameters.kinematic)
    if kinematic is not None and kinematic[0].number(kinematic[1].cell) == 1.0:
        c.inferred.append(
            f"{kinematic[1].name} = 1: that analysis had joints in place of the bushings; the bushings are "
            "taken"
        )


def _add_tyre(c: Conversion) -> None:
    """The tyre's radial stiffness: a parameter of the test rig, else of the tyre's own file."""
    rate = c.parameter(c.names.parameters.tyre_rate)
    if rate is not None:
        file, parameter = rate
        value = file.number(parameter.cell)
        c.put("tyre", "rate", value, f"{file.path.name}: {parameter.name}, taken as N/mm")
        c.inferred.append(f"{parameter.name} is taken as N/mm: no file states its unit")
        c.numbers.append(NumberPlace("tyre.rate", file, parameter.cell, parameter.side, parameter.side_cell))
        return
    rows = [(s, e) for s in c.database.subsystems for e in s.elements if e.kind == "wheel"]
    for subsystem, element in rows[:1]:
        name = subsystem.file.cell(element.block, "PROPERTY_FILE").text
        try:
            path = c.database.property_path(name, subsystem.where(element))
        except InputError:
            continue  # told where all files of elements are looked for
        tyre = read_teim_orbit(path, "tyre file (.tir)")
        if not tyre.has("VERTICAL") or TYRE_KEY not in tyre.one("VERTICAL").entries:
            c.left_out.append(f"{path.name}: has no {TYRE_KEY} under [VERTICAL]")
            continue
        units = file_units(tyre)
        stiffness = tyre.number(tyre.one("VERTICAL").entries[TYRE_KEY]) * units.force / units.length
        c.files.append(path)
        c.put("tyre", "rate", tidy(stiffness), f"{path.name}: {TYRE_KEY}")


def _add_right_angle(c: Conversion, key: str, name: str) -> None:
    for subsystem in c.database.subsystems:
        for row in subsystem.parameters:
            if row.name == name and row.side == "right":
                value = subsystem.file.number(row.cell)
                if value != c.document["static"][key]:
                    c.put_right(f"static.{key}", value, f"{subsystem.path.name}: {name}, right")
                c.numbers.append(
                    NumberPlace(f"right.static.{key}", subsystem.file, row.cell, row.side, row.side_cell)
                )


def add_hub(conversion: Conversion) -> None:
    """A bushing between knuckle and wheel, where it is switched on: the effect hub_compliance."""
    c, names = conversion, conversion.names.hub
    rows = [] if names is None else c.element("bushing", names.usage)
    if names is None or not rows:
        return
    subsystem, element = left_and_right(rows)[0]
    if c.switched_off(names.switch):
        c.left_out.append(f"{subsystem.path.name}: {element.usage}: {names.switch} = 0")
        return
    if not is_plain_bushing(subsystem, element):
        c.left_out.append(f"{subsystem.where(element)}: its class is not read")
        return
    source = element_axes(subsystem, element, None)
    order: tuple[int, ...] = (0, 1, 2)
    if source is None:
        c.inferred.append("hub: nothing tells its orientation; taken along the axes of the file")
    else:
        order, _, _ = nearest_axes(np.eye(3), c.frame.signs[:, None] * source.axes)
    table, path = _laws(c, ("Tx", "Tz"), subsystem, element, "hub", order)
    options = {}
    for key, path_of, axis in (("camber_Nm_deg", "hub.camber", "Tx"), ("toe_Nm_deg", "hub.toe", "Tz")):
        slope = _centre_slope(c, table, axis, path) / table.get("factor", {}).get(axis, 1.0)
        options[key] = tidy(slope * table.get("factor", {}).get(axis, 1.0), PRODUCT_DIGITS)
        number = f"{adams_axis(axis, order).upper()}_SCALING_FACTOR"
        if number in element.block.entries:
            entries = element.block.entries
            c.numbers.append(
                NumberPlace(
                    path_of,
                    subsystem.file,
                    entries[number],
                    element.side,
                    entries["SYMMETRY"],
                    gain=slope,
                    block=element.block,
                )
            )
    c.document.setdefault("effects", {})["hub_compliance"] = options
    c.comments["effects", "hub_compliance"] = f"{subsystem.path.name}: {element.usage}; {path.name}"
    c.elements["hub"] = ElementPlace(subsystem, element, path, order)
