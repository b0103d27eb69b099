"""Wheel of the files: static angles, stiffness of the tyre, compliance of the hub."""

from __future__ import annotations

import numpy as np

from doe_kc.adams.bushing_orientation import nearest_axes
from doe_kc.adams.bushings import adams_axis, is_plain_bushing
from doe_kc.adams.centre_stiffness import bushing_laws, centre_slope
from doe_kc.adams.conversion import Conversion, ElementPlace, NumberPlace, left_and_right
from doe_kc.adams.orientation import element_axes
from doe_kc.adams.points import PRODUCT_DIGITS, tidy
from doe_kc.adams.teim_orbit import read_teim_orbit
from doe_kc.adams.units import file_units
from doe_kc.ground.errors import InputError

TYRE_KEY = "VERTICAL_STIFFNESS"
"""Of a tyre's own file."""


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
    table, path = bushing_laws(c, ("Tx", "Tz"), subsystem, element, "hub", order)
    options = {}
    for key, path_of, axis in (("camber_Nm_deg", "hub.camber", "Tx"), ("toe_Nm_deg", "hub.toe", "Tz")):
        stiffness = centre_slope(c, table, axis, path)
        options[key] = tidy(stiffness, PRODUCT_DIGITS)
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
                    gain=stiffness / table.get("factor", {}).get(axis, 1.0),
                    block=element.block,
                )
            )
    c.document.setdefault("effects", {})["hub_compliance"] = options
    c.comments["effects", "hub_compliance"] = f"{subsystem.path.name}: {element.usage}; {path.name}"
    c.elements["hub"] = ElementPlace(subsystem, element, path, order)
