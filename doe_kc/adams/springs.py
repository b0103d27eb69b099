"""Springs and stops of the files: rate, force at design, curve and clearance."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from doe_kc.adams.conversion import Conversion, ElementPlace, NumberPlace, left_and_right
from doe_kc.adams.curve_law import curve_law
from doe_kc.adams.points import PRODUCT_DIGITS, tidy
from doe_kc.adams.property_files import (
    ForceTable,
    SpringProperty,
    read_damper_file,
    read_spring_file,
    read_stop_file,
)
from doe_kc.adams.subsystem import AdamsElement, AdamsSubsystem
from doe_kc.ground.errors import InputError
from doe_kc.ground.typing import FloatArray

FAR_STOP = 500.0
"""mm of clearance of a stop that the files do not have."""
SAME_FORCE = 1e-6
"""Relative difference of the two springs' forces from which they are told apart."""
RATE_WINDOW = 10.0
"""mm to either side of the deflection at design over which the rate of a curved spring is taken."""


def add_springs(conversion: Conversion) -> None:
    """A table a spring; the first one's force at design tells the static load."""
    c = conversion
    for number, (name, usages) in enumerate(c.names.springs.items()):
        rows = c.element("spring", usages)
        if not rows:
            c.missing.append(f"the spring {name} ({' or '.join(usages)}): correct the name map")
            continue
        (subsystem, element), right = left_and_right(rows)
        force, rate, spring = _spring(c, name, subsystem, element)
        c.put(name, "rate", rate, f"{subsystem.path.name}: {element.usage}; {spring.curve.path.name}")
        c.elements[name] = ElementPlace(subsystem, element, spring.curve.path)
        if number == 0:
            c.spring_force = force
        if right is not None:
            other, own_rate, _ = _spring(c, name, *right)
            if own_rate != rate:
                c.put_right(f"{name}.rate", own_rate, f"{right[0].path.name}: {right[1].usage}, right")
            if abs(other - force) > SAME_FORCE * abs(force):
                c.left_out.append(
                    f"{right[0].where(right[1])}: its force at design is {other:.6g} N, the left one's "
                    f"{force:.6g}: an "
                    "axle file has one static load"
                )
    _add_dampers(c)


def _spring(
    c: Conversion, name: str, subsystem: AdamsSubsystem, element: AdamsElement
) -> tuple[float, float, SpringProperty]:
    """Force at design in N, rate there in N/mm, property file."""
    path = c.database.property_path(
        subsystem.file.cell(element.block, "PROPERTY_FILE").text, subsystem.where(element)
    )
    c.files.append(path)
    spring = read_spring_file(path)
    if spring.remark:
        c.inferred.append(f"{path.name}: {spring.remark}")
    law = curve_law(spring.curve, turn=False)
    force = design_force(subsystem, element, spring)
    if law.points is None and not law.cubic:
        return force, law.stiffness, spring
    at = deflection_at(spring.curve, force)
    rate = _local_rate(spring.curve, at)
    if not rate > 0.0:
        raise InputError(
            f"{path}: has the rate {rate:.4g} N/mm at {force:.4g} N; expected more than 0. Correct it."
        )
    c.inferred.append(
        f"{name}: the curve of {path.name} is not straight; its rate over {RATE_WINDOW:g} mm to either side "
        "of "
        f"{force:.5g} N counts everywhere"
    )
    return force, tidy(rate), spring


def design_force(subsystem: AdamsSubsystem, element: AdamsElement, spring: SpringProperty) -> float:
    """N in the spring at design: its preload, or its curve at free less installed length."""
    kind = subsystem.file.cell(element.block, "VALUE_TYPE")
    number = subsystem.number_of(element, "USER_VALUE")
    if kind.text.lower() == "preload":
        return number * subsystem.units.force
    if kind.text.lower() != "installed_length":
        raise InputError(
            f"{subsystem.path}: line {kind.line}: VALUE_TYPE is {kind.text!r}, expected preload or "
            "installed_length."
        )
    if spring.free_length is None:
        raise InputError(
            f"{spring.curve.path}: has no FREE_LENGTH, but {subsystem.where(element)} gives an installed "
            "length; "
            "add it there."
        )
    return force_at(spring.curve, spring.free_length - number * subsystem.units.length)


def force_at(curve: ForceTable, x: float) -> float:
    """N at a deflection, straight between the points and beyond the ends."""
    if x < curve.x[0] or x > curve.x[-1]:
        i, j = (0, 1) if x < curve.x[0] else (-1, -2)
        slope = (curve.y[j] - curve.y[i]) / (curve.x[j] - curve.x[i])
        return float(curve.y[i] + slope * (x - curve.x[i]))
    return float(np.interp(x, curve.x, curve.y))


def deflection_at(curve: ForceTable, force: float) -> float:
    """mm at which `force_at` gives the force; InputError for a curve that is not rising."""
    if np.any(np.diff(curve.y) <= 0.0):
        raise InputError(
            f"{curve.path}: its force does not rise with deflection; expected a spring's. Correct it."
        )
    return force_at(ForceTable(curve.y, curve.x, curve.path), force)


def _local_rate(curve: ForceTable, at: float) -> float:
    return (force_at(curve, at + RATE_WINDOW) - force_at(curve, at - RATE_WINDOW)) / (2.0 * RATE_WINDOW)


def _add_dampers(c: Conversion) -> None:
    """Dampers are read to be checked; a quasi-static axle has no force of theirs."""
    for subsystem, element in c.element("damper", c.names.dampers):
        name = subsystem.file.cell(element.block, "PROPERTY_FILE").text
        try:
            path = c.database.property_path(name, subsystem.where(element))
        except InputError:
            c.left_out.append(f"{subsystem.path.name}: {element.usage}: its file {name} is not there")
            continue
        c.files.append(path)
        read_damper_file(path)
        c.left_out.append(f"{path.name}: the curve of damper {element.usage}: no force at rest")


def add_stops(conversion: Conversion, line: tuple[str, str]) -> None:
    """`[bump_stop]` and `[rebound_stop]`. line: points at the ends of the damper, of the type."""
    for name, kind, usages, sign in (
        ("bump_stop", "bump stop", conversion.names.bump_stop, 1.0),
        ("rebound_stop", "rebound stop", conversion.names.rebound_stop, -1.0),
    ):
        _add_stop(conversion, name, kind, usages, sign, line)


def _add_stop(
    c: Conversion, name: str, kind: str, usages: list[str], sign: float, line: tuple[str, str]
) -> None:
    rows = c.element(kind, usages)
    if not rows:
        c.put(name, "clearance", FAR_STOP, f"no {kind} among the files")
        c.document[name]["curve"] = [[0.0, 0.0], [1.0, 0.0]]
        c.inferred.append(f"there is no {kind}: {name} is {FAR_STOP:g} mm away and has no force")
        return
    (subsystem, element), right = left_and_right(rows)
    clearance, gain, shift = _clearance(c, subsystem, element, sign, line)
    points, path = _stop_curve(c, subsystem, element)
    c.put(name, "clearance", clearance, f"{subsystem.path.name}: {element.usage}; {path.name}")
    c.document[name]["curve"] = [[tidy(x), tidy(y)] for x, y in points]
    c.elements[name] = ElementPlace(subsystem, element, path)
    _note(c, f"{name}.clearance", subsystem, element, gain, shift)
    if right is not None:
        own, gain, shift = _clearance(c, *right, sign, line)
        if own != clearance:
            c.put_right(f"{name}.clearance", own, f"{right[0].path.name}: {right[1].usage}, right")
        _note(c, f"right.{name}.clearance", *right, gain, shift)
        if not np.array_equal(_stop_curve(c, *right)[0], points):
            c.left_out.append(f"{right[0].where(right[1])}: its own curve; the left one counts on both sides")


def _note(
    c: Conversion, path: str, subsystem: AdamsSubsystem, element: AdamsElement, gain: float, shift: float
) -> None:
    entries = element.block.entries
    c.numbers.append(
        NumberPlace(
            path,
            subsystem.file,
            entries["USER_DISTANCE"],
            element.side,
            entries["SYMMETRY"],
            gain=gain,
            shift=shift,
            block=element.block,
        )
    )


def _clearance(
    c: Conversion, subsystem: AdamsSubsystem, element: AdamsElement, sign: float, line: tuple[str, str]
) -> tuple[float, float, float]:
    """Travel of the damper from design to contact, mm; how it follows from USER_DISTANCE: gain, shift."""
    kind = subsystem.file.cell(element.block, "DISTANCE_TYPE")
    number = subsystem.number_of(element, "USER_DISTANCE") * subsystem.units.length
    if kind.text.lower() == "clearance":
        return tidy(number), subsystem.units.length, 0.0
    if kind.text.lower().replace(" ", "_") != "impact_length":
        raise InputError(
            f"{subsystem.path}: line {kind.line}: DISTANCE_TYPE is {kind.text!r}, expected clearance or "
            "impact_length."
        )
    points = c.document.get("hardpoints", {})
    if not set(line) <= points.keys():
        return 0.0, 1.0, 0.0  # the missing point is told by itself
    length = float(np.linalg.norm(np.subtract(points[line[0]], points[line[1]])))
    c.inferred.append(
        f"{element.usage}: its impact length is taken of the line {line[0]}-{line[1]}, {length:.5g} mm at "
        "design"
    )
    return tidy(sign * (length - number), PRODUCT_DIGITS), -sign * subsystem.units.length, sign * length


def _stop_curve(c: Conversion, subsystem: AdamsSubsystem, element: AdamsElement) -> tuple[FloatArray, Path]:
    """(n, 2) deflection after contact and force, from [0, 0], and the property file."""
    path = c.database.property_path(
        subsystem.file.cell(element.block, "PROPERTY_FILE").text, subsystem.where(element)
    )
    c.files.append(path)
    curve = read_stop_file(path)
    after = curve.x > 0.0
    if not after.any():
        raise InputError(f"{path}: has no point beyond contact; expected deflections above 0. Correct it.")
    at_contact = float(np.interp(0.0, curve.x, curve.y)) if curve.x[0] <= 0.0 else 0.0
    if at_contact != 0.0:
        raise InputError(f"{path}: has {at_contact:g} N at contact, expected 0. Correct it.")
    points = np.column_stack([np.r_[0.0, curve.x[after]], np.r_[0.0, curve.y[after]]])
    if np.any(np.diff(points[:, 1]) < 0.0):
        raise InputError(
            f"{path}: its force falls with deflection; expected one that never falls. Correct it."
        )
    return points, path
