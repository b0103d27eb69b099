"""Bushings of the files to those of an axle type: curves, scale factors, preloads, orientation."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from doe_kc.adams.bushing_orientation import LOCAL, along, orientation, restoring_preload
from doe_kc.adams.conversion import (
    FREE_FORCE,
    FREE_TORQUE,
    LOCKED_FORCE,
    LOCKED_TORQUE,
    Conversion,
    ElementPlace,
    NumberPlace,
    left_and_right,
)
from doe_kc.adams.curve_law import CurveLaw, curve_law
from doe_kc.adams.name_map import BushingNames
from doe_kc.adams.points import tidy
from doe_kc.adams.property_files import read_bushing_file
from doe_kc.adams.subsystem import AdamsElement, AdamsSubsystem
from doe_kc.axle.model import BUSHING_AXES
from doe_kc.ground.errors import InputError
from doe_kc.ground.typing import FloatArray

BUSHING_CLASS = ".acar.attachments.ac_bushing"
"""DEFINITION of the bushing whose law is six curves, case apart."""


def add_bushings(conversion: Conversion, fixed_axes: dict[str, FloatArray] | None) -> None:
    """`[bushings]` for every bushing of the name map.

    fixed_axes: (3, 3) axes that the type fixes, as columns, by bushing; None where an axle file may give any.
    """
    for name, names in conversion.names.bushings.items():
        _add_bushing(conversion, name, names, None if fixed_axes is None else fixed_axes.get(name))


def _add_bushing(c: Conversion, name: str, names: BushingNames, fixed: FloatArray | None) -> None:
    rows = c.element("bushing", names.usage)
    if not rows or c.switched_off(names.switch):
        _add_joint(c, name, names, bool(rows))
        return
    (subsystem, element), right = left_and_right(rows)
    if element.side == "single":
        raise InputError(f"{subsystem.where(element)}: is single, but {name} of the type is one a side.")
    if not is_plain_bushing(subsystem, element):
        definition = subsystem.file.cell(element.block, "DEFINITION").text
        c.missing.append(
            f"{subsystem.where(element)}: is of the class {definition}, which is not read; replace it by "
            f"an ac_bushing, or give {name}.stiffness.Fx to {name}.stiffness.Tz under [values]"
        )
        return
    order, signs = orientation(c, name, names, subsystem, element, fixed)
    table, path = bushing_table(c, subsystem, element, name, order, signs)
    c.document.setdefault("bushings", {})[name] = table
    c.comments["bushings", name] = f"{subsystem.path.name}: {element.usage}; {path.name}"
    c.elements[name] = ElementPlace(subsystem, element, path, order, signs)
    _note_factors(c, name, subsystem, element, order, "")
    _note_preloads(c, name, subsystem, element, order, signs, "")
    _note_ignored(c, subsystem, element)
    if right is not None:
        _add_right(c, name, right, table, order, signs)
    if fixed is None and name in c.axes:
        x, y = c.axes[name][:, 0], c.axes[name][:, 1]
        table["x"], table["y"] = [tidy(v) for v in x], [tidy(v) for v in y]


def is_plain_bushing(subsystem: AdamsSubsystem, element: AdamsElement) -> bool:
    """Whether an element's class is the bushing of six curves; one without a class is taken as such."""
    definition = element.block.entries.get("DEFINITION")
    return definition is None or definition.text.lower() == BUSHING_CLASS


def _add_joint(c: Conversion, name: str, names: BushingNames, locked: bool) -> None:
    """Where there is no bushing: a joint that turns, or parts locked together by a parameter."""
    torque = LOCKED_TORQUE if locked else FREE_TORQUE
    stiffness = dict.fromkeys(BUSHING_AXES[:3], LOCKED_FORCE) | dict.fromkeys(BUSHING_AXES[3:], torque)
    words = f"{names.switch} = 0" if locked else f"no bushing {' or '.join(names.usage)}"
    if names.switch and not locked:
        stiffness |= dict.fromkeys(BUSHING_AXES[3:], LOCKED_TORQUE)
    c.document.setdefault("bushings", {})[name] = {"stiffness": stiffness}
    c.comments["bushings", name] = words
    what = "rigid" if stiffness["Tx"] == LOCKED_TORQUE else "a joint that turns freely"
    c.inferred.append(f"bushing {name} is {what}: {words}")


def bushing_table(
    c: Conversion,
    subsystem: AdamsSubsystem,
    element: AdamsElement,
    name: str,
    order: tuple[int, ...],
    signs: tuple[float, ...],
) -> tuple[dict[str, Any], Path]:
    """The bushing's table of an axle file, and its property file."""
    path = c.database.property_path(
        subsystem.file.cell(element.block, "PROPERTY_FILE").text, subsystem.where(element)
    )
    c.files.append(path)
    curves = read_bushing_file(path)
    table: dict[str, Any] = {"stiffness": {}}
    for i, axis in enumerate(BUSHING_AXES):
        source = adams_axis(axis, order)
        scale = subsystem.number_of(element, f"{source.upper()}_SCALING_FACTOR", 1.0)
        law = curve_law(along(curves[source], signs[i % 3]), turn=axis.startswith("T"))
        if scale < 0.0:
            raise InputError(
                f"{subsystem.where(element)}: {source.upper()}_SCALING_FACTOR is {scale:g}, expected 0 or "
                "more."
            )
        if scale == 0.0 or (law.points is not None and not np.any(law.points[:, 1])):
            _switch_off(c, table, name, axis, by_factor=scale == 0.0)
            continue
        _put_law(c, table, axis, law, path)
        if scale != 1.0:
            table.setdefault("factor", {})[axis] = scale
        if axis.startswith("F"):
            force = restoring_preload(subsystem, element, source, signs[i])
            if force != 0.0:
                table.setdefault("preload", {})[axis] = force
                c.inferred.append(
                    f"bushing {name}: preload {source} of ADAMS taken as the force on its I part, the "
                    f"{c.names.bushings[name].i_part if name in c.names.bushings else 'outer'} one"
                )
    return table, path


def adams_axis(axis: str, order: tuple[int, ...]) -> str:
    """ADAMS axis (`Fz`) of an axis of the type (`Fy`)."""
    return axis[0] + LOCAL[order["xyz".index(axis[1])]]


def _switch_off(c: Conversion, table: dict[str, Any], name: str, axis: str, *, by_factor: bool) -> None:
    """A direction without force: held by a joint where a factor of 0 says so, else free."""
    if axis.startswith("T"):
        table["stiffness"][axis], words = FREE_TORQUE, "free to turn"
    elif by_factor:
        table["stiffness"][axis], words = LOCKED_FORCE, "held by a joint"
    else:
        table["stiffness"][axis], words = FREE_FORCE, "free to move"
    reason = "its factor is 0" if by_factor else "its curve is 0"
    c.inferred.append(f"bushing {name}: {axis} is taken as {words}: {reason}")


def _put_law(c: Conversion, table: dict[str, Any], axis: str, law: CurveLaw, path: Path) -> None:
    if law.points is None:
        table["stiffness"][axis] = law.stiffness
        if law.cubic:
            table.setdefault("cubic", {})[axis] = law.cubic
            c.inferred.append(f"{path.name}: {axis} follows k (d + c d^3), which counts beyond its table too")
        return
    for before, after in zip(law.points, law.points[1:], strict=False):
        if after[1] < before[1]:
            raise InputError(
                f"{path}: {axis.upper()} falls from {before[1]:g} at {before[0]:g} to {after[1]:g} at "
                f"{after[0]:g}; expected a curve that never falls, as such a bushing has no unique "
                "equilibrium. Correct it there."
            )
    if not law.points[0, 0] < 0.0 < law.points[-1, 0]:
        raise InputError(
            f"{path}: {axis.upper()} goes from {law.points[0, 0]:g} to {law.points[-1, 0]:g}; expected a "
            "curve on both sides of zero deflection."
        )
    table.setdefault("table", {})[axis] = [[tidy(x), tidy(y)] for x, y in law.points]
    unit = "N" if axis.startswith("F") else "Nm"
    c.inferred.append(
        f"{path.name}: {axis} goes through its points by a monotone cubic, where ADAMS takes an Akima "
        f"spline; they differ by {law.gap:.3g} {unit} at most"
    )


def _note_factors(
    c: Conversion,
    name: str,
    subsystem: AdamsSubsystem,
    element: AdamsElement,
    order: tuple[int, ...],
    side: str,
) -> None:
    for axis in BUSHING_AXES:
        key = f"{adams_axis(axis, order).upper()}_SCALING_FACTOR"
        cell = element.block.entries.get(key)
        if cell is not None and subsystem.file.number(cell) > 0.0:
            c.numbers.append(_number(f"{side}{name}.{axis}", subsystem, element, key, 1.0))


def _note_preloads(
    c: Conversion,
    name: str,
    subsystem: AdamsSubsystem,
    element: AdamsElement,
    order: tuple[int, ...],
    signs: tuple[float, ...],
    side: str,
) -> None:
    for i, axis in enumerate(BUSHING_AXES[:3]):
        key = f"T_PRELOAD_{LOCAL[order[i]].upper()}"
        if key in element.block.entries:
            gain = -signs[i] * subsystem.units.force
            c.numbers.append(_number(f"{side}{name}.preload.{axis}", subsystem, element, key, gain))


def _number(
    path: str, subsystem: AdamsSubsystem, element: AdamsElement, key: str, gain: float
) -> NumberPlace:
    entries = element.block.entries
    return NumberPlace(
        path, subsystem.file, entries[key], element.side, entries["SYMMETRY"], gain=gain, block=element.block
    )


def _note_ignored(c: Conversion, subsystem: AdamsSubsystem, element: AdamsElement) -> None:
    """What a bushing has and the axle file has no key for."""
    for key in element.block.entries:
        told = key.startswith(("R_PRELOAD_", "T_OFFSET_", "R_OFFSET_"))
        if told and subsystem.number_of(element, key) != 0.0:
            c.left_out.append(
                f"{subsystem.path.name}: {element.usage}: {key} = {subsystem.number_of(element, key):g}"
            )


def _add_right(
    c: Conversion,
    name: str,
    right: tuple[AdamsSubsystem, AdamsElement],
    left: dict[str, Any],
    order: tuple[int, ...],
    signs: tuple[float, ...],
) -> None:
    """A right block of its own: what it has else than the left one."""
    subsystem, element = right
    table, path = bushing_table(c, subsystem, element, name, order, signs)
    comment = f"{subsystem.path.name}: {element.usage}, right"
    if table.get("table") != left.get("table"):
        c.left_out.append(
            f"{subsystem.where(element)}: its curve {path.name} is another than the left one's, which the "
            "axle "
            "file cannot say of a table; the left one counts on both sides"
        )
        return
    for axis in BUSHING_AXES:
        for key, path_of, default in (
            ("factor", f"{name}.{axis}", 1.0),
            ("stiffness", f"{name}.stiffness.{axis}", 0.0),
            ("cubic", f"{name}.cubic.{axis}", 0.0),
            ("preload", f"{name}.preload.{axis}", 0.0),
        ):
            value = table.get(key, {}).get(axis, default)
            if value != left.get(key, {}).get(axis, default):
                c.put_right(path_of, value, comment)
    c.elements[f"right.{name}"] = ElementPlace(subsystem, element, path, order, signs)
    _note_factors(c, name, subsystem, element, order, "right.")
    _note_preloads(c, name, subsystem, element, order, signs, "right.")
