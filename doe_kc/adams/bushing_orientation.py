"""How a bushing of the files lies on an axle type: its own axes, and which stands for which of the type."""

from __future__ import annotations

import numpy as np

from doe_kc.adams.conversion import (
    Conversion,
    left_and_right,
)
from doe_kc.adams.name_map import BushingNames
from doe_kc.adams.orientation import STALE, element_axes, shortest_turn
from doe_kc.adams.points import tidy
from doe_kc.adams.property_files import ForceTable, read_bushing_file
from doe_kc.adams.subsystem import AdamsElement, AdamsSubsystem
from doe_kc.ground.errors import InputError
from doe_kc.ground.typing import FloatArray

NEAR_AXES = 20.0
"""deg by which axes of the files may lie beside those that a type fixes."""


TOLD_ANGLE = 0.05
"""deg from which turned axes are told."""


LOCAL = ("x", "y", "z")


def orientation(
    c: Conversion,
    name: str,
    names: BushingNames,
    subsystem: AdamsSubsystem,
    element: AdamsElement,
    fixed: FloatArray | None,
) -> tuple[tuple[int, ...], tuple[float, ...]]:
    """ADAMS axis and sign of each local axis of the type."""
    part = 1.0 if names.i_part == "outer" else -1.0
    axes = c.axes[name] = _own_axes(c, name, names, subsystem, element)
    if fixed is None:
        return (0, 1, 2), (part, part, part)
    round_axis = _round_axis(c, subsystem, element)
    if round_axis is not None:
        axes = turned_about(fixed, axes, round_axis)
    order, signs, angle = nearest_axes(fixed, axes)
    if angle > NEAR_AXES:
        raise InputError(
            f"{subsystem.where(element)}: its axes lie {angle:.0f} deg beside those of {name} of the type; "
            "expected "
            f"less than {NEAR_AXES:g}. Correct its orientation, or write a type of your own with `line`."
        )
    if angle > TOLD_ANGLE:
        c.inferred.append(
            f"bushing {name}: its curves are taken along the axes of the type, {angle:.1f} deg from its own"
        )
    return order, tuple(part * s for s in signs)


def _own_axes(
    c: Conversion, name: str, names: BushingNames, subsystem: AdamsSubsystem, element: AdamsElement
) -> FloatArray:
    """(3, 3) local axes as columns, chassis frame, as the file has them; what told them is noted."""
    rule = direction_rule(c, names)
    source = element_axes(subsystem, element, rule)
    if source is None:
        c.inferred.append(f"bushing {name}: nothing tells its orientation; taken along the axes of the file")
        return np.diag(c.frame.signs)
    if source.where != "its keys ORIENTATION":
        c.inferred.append(f"bushing {name}: orientation from {source.where}")
    axes = np.asarray(c.frame.signs[:, None] * source.axes)
    if source.z_only:
        axes = shortest_turn(axes[:, 2])
        c.inferred.append(f"bushing {name}: nothing tells its local x; turned from the chassis axes")
    if rule is not None and source.where == "its comment":
        _check_stale(c, name, subsystem, element, axes[:, 2], c.frame.direction(rule))
    return axes


def top_mount_direction(c: Conversion, name: str) -> FloatArray | None:
    """(3,) direction of a bushing's local z, chassis frame; None where nothing tells it."""
    names = c.names.bushings.get(name)
    rows = c.element("bushing", names.usage) if names is not None else []
    if names is None or not rows:
        return None
    (subsystem, element), _ = left_and_right(rows)
    source = element_axes(subsystem, element, direction_rule(c, names))
    return None if source is None else c.frame.direction(source.axes[:, 2])


def _round_axis(c: Conversion, subsystem: AdamsSubsystem, element: AdamsElement) -> int | None:
    """ADAMS axis about which a bushing is the same all around: equal odd curves and factors across, no
    preload."""
    path = c.database.property_path(
        subsystem.file.cell(element.block, "PROPERTY_FILE").text, subsystem.where(element)
    )
    curves = read_bushing_file(path)
    for axis in (2, 0, 1):
        across = [LOCAL[i] for i in range(3) if i != axis]
        pairs = [(kind + across[0], kind + across[1]) for kind in "FT"]
        preload = any(restoring_preload(subsystem, element, f"F{a}", 1.0) for a in across)
        if not preload and all(_alike(subsystem, element, curves, *pair) for pair in pairs):
            return axis
    return None


def _alike(
    subsystem: AdamsSubsystem, element: AdamsElement, curves: dict[str, ForceTable], one: str, other: str
) -> bool:
    scales = [subsystem.number_of(element, f"{axis.upper()}_SCALING_FACTOR", 1.0) for axis in (one, other)]
    first, second = curves[one], curves[other]
    turned = along(first, -1.0)
    return scales[0] == scales[1] and all(
        curve.x.size == second.x.size
        and np.allclose(curve.x, second.x, rtol=1e-9)
        and np.allclose(curve.y, second.y, rtol=1e-9)
        for curve in (first, turned)
    )


def turned_about(fixed: FloatArray, axes: FloatArray, axis: int) -> FloatArray:
    """(3, 3) `axes` turned about one of them until the others lie as near as can be to those of `fixed`."""
    cosines = fixed.T @ axes[:, axis]
    near = int(np.argmax(np.abs(cosines)))
    sign = 1.0 if cosines[near] > 0 else -1.0
    turned = _turn_onto(fixed[:, near], sign * axes[:, axis]) @ fixed
    first, second = (1, 2) if sign > 0 else (2, 1)
    out = np.empty((3, 3))
    out[:, axis] = axes[:, axis]
    out[:, (axis + 1) % 3] = turned[:, (near + first) % 3]
    out[:, (axis + 2) % 3] = turned[:, (near + second) % 3]
    return out


def _turn_onto(start: FloatArray, end: FloatArray) -> FloatArray:
    """(3, 3) shortest turn of one unit vector onto another that is less than 180 deg away."""
    v = np.cross(start, end)
    cross = np.array([[0.0, -v[2], v[1]], [v[2], 0.0, -v[0]], [-v[1], v[0], 0.0]])
    return np.asarray(np.eye(3) + cross + cross @ cross / (1.0 + float(start @ end)))


def direction_rule(c: Conversion, names: BushingNames) -> FloatArray | None:
    """(3,) unit vector of z between two hardpoints, file's frame; None where there is no such rule."""
    ends = [next((r.place for _, r in c.row([n]) if r.side != "right"), None) for n in names.z]
    if len(ends) < 2 or ends[0] is None or ends[1] is None:
        return None
    along = ends[1] - ends[0]
    length = float(np.linalg.norm(along))
    return along / length if length > 1.0 else None


def _check_stale(
    c: Conversion,
    name: str,
    subsystem: AdamsSubsystem,
    element: AdamsElement,
    z: FloatArray,
    rule: FloatArray,
) -> None:
    angle = float(np.degrees(np.arccos(min(1.0, abs(float(z @ rule))))))
    if angle > STALE:
        c.inferred.append(
            f"bushing {name}: the orientation in the comment of {subsystem.path.name}, line "
            f"{element.block.line}, "
            f"lies {angle:.1f} deg beside the points it depends on; the comment counts"
        )


def nearest_axes(fixed: FloatArray, axes: FloatArray) -> tuple[tuple[int, ...], tuple[float, ...], float]:
    """Axis of `axes` and its sign for each of `fixed` (both (3, 3) as columns), and the largest angle in deg
    that is left between them."""
    cosines = fixed.T @ axes
    order = [int(i) for i in np.argmax(np.abs(cosines), axis=1)]
    if len(set(order)) < 3:
        return (0, 1, 2), (1.0, 1.0, 1.0), 90.0
    along = [float(cosines[i, j]) for i, j in enumerate(order)]
    angle = float(np.degrees(np.arccos(min(1.0, min(map(abs, along))))))
    return tuple(order), tuple(float(np.sign(v)) for v in along), angle


def along(curve: ForceTable, sign: float) -> ForceTable:
    """The curve seen along its axis, or against it."""
    if sign > 0:
        return curve
    return ForceTable(-curve.x[::-1], -curve.y[::-1], curve.path)


def restoring_preload(subsystem: AdamsSubsystem, element: AdamsElement, source: str, sign: float) -> float:
    """Restoring force at rest in N: the BUSHING statement adds its preload to the force on I."""
    number = subsystem.number_of(element, f"T_PRELOAD_{source[1].upper()}", 0.0)
    return tidy(-sign * number * subsystem.units.force)
