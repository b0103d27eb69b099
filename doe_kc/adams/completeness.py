"""Completeness of an import: what of the files has no place in an axle file, what an axle file lacks."""

from __future__ import annotations

from typing import Any

from doe_kc.adams.conversion import Conversion
from doe_kc.adams.subsystem import AdamsElement, AdamsSubsystem
from doe_kc.axle.model import BUSHING_AXES, HARDPOINTS
from doe_kc.axle_types.read import AxleType
from doe_kc.ground.errors import InputError

REQUIRED = {
    "static": ("toe", "camber"),
    "tyre": ("rate",),
    "arb": ("rate",),
    "steering": ("column", "rack_mm_per_rev"),
}
"""Keys without which there is no axle, by table; a table counts where the type has the part."""


class IncompleteAxle(InputError):
    """The files leave out what an axle needs; the name map is where to say it."""


def note_unknown(c: Conversion) -> None:
    """Say in `left_out` which blocks are of no known kind and which elements no name of the map stands for.

    Property files of all elements join `files`, so that an export copies them. The McPherson axle's damper
    has no gas force, as no file says one.
    """
    hub = [] if c.names.hub is None else [c.names.hub]
    mapped = {n.lower() for names in (*c.names.bushings.values(), *hub) for n in names.usage}
    mapped |= {n.lower() for n in (*c.names.steering.torsion_bar, *c.names.steering.rack_mount)}
    for subsystem in c.database.subsystems:
        for block in subsystem.unknown:
            c.left_out.append(f"{subsystem.path.name}: block [{block}] is not known")
        taken = {p.element.block.line for p in c.elements.values() if p.subsystem is subsystem}
        for element in subsystem.elements:
            _note_file(c, subsystem, element)
            if element.kind in ("bushing", "spring") and element.block.line not in taken:
                if element.usage.lower() in mapped:
                    continue
                c.left_out.append(
                    f"{subsystem.path.name}: {element.kind} {element.usage}: the type has no such"
                )
    if "damper" not in c.document and c.structure is None:
        c.document["damper"] = {"gas_force": 0.0}
        c.comments["damper", "gas_force"] = "no file says it"


def _note_file(c: Conversion, subsystem: AdamsSubsystem, element: AdamsElement) -> None:
    """The property file of an element that nothing was made of, so that an export copies it."""
    cell = element.block.entries.get("PROPERTY_FILE")
    if cell is None or not cell.text:
        return
    try:
        path = c.database.property_path(cell.text, subsystem.where(element))
    except InputError:
        c.left_out.append(f"{subsystem.path.name}: {element.usage}: its file {cell.text} is not there")
        return
    if path not in c.files:
        c.files.append(path)


def note_missing(c: Conversion, axle_type: AxleType | None) -> None:
    """Say in `missing` what an axle file cannot do without and neither file nor name map gives.

    axle_type: None for the McPherson axle. Remarks that were made twice are said once.
    """
    c.left_out[:] = dict.fromkeys(c.left_out)
    c.inferred[:] = dict.fromkeys(c.inferred)
    points = c.document.get("hardpoints", {})
    wanted: tuple[str, ...] = tuple(p for p in (*HARDPOINTS, "ARB"))
    if axle_type is not None:
        wanted = (*axle_type.structure.points, *axle_type.structure.single_points)
    for point in wanted:
        if point not in points or None in points[point]:
            named = " or ".join(c.names.hardpoints.get(point, [])) or "no name in the map"
            c.missing.append(
                f"hardpoint {point} ({named}): name it in the name map, or give {point}.x, .y, .z"
            )
    for name in c.names.bushings:
        table = c.document.get("bushings", {}).get(name)
        axes = set() if table is None else {*table.get("stiffness", {}), *table.get("table", {})}
        if table is not None and len(axes) < len(BUSHING_AXES):
            c.missing.append(
                f"bushing {name}: stiffness of {', '.join(a for a in BUSHING_AXES if a not in axes)}"
            )
    c.missing[:] = [m for m in c.missing if not _given_meanwhile(c, m)]
    for table_name, keys in REQUIRED.items():
        for key in keys:
            path = f"{table_name}.{key}"
            needed = _has_part(table_name, axle_type) and key not in c.document.get(table_name, {})
            asked = any(path in m or (table_name == "steering" and "ratio_unit" in m) for m in c.missing)
            if needed and not asked:
                c.missing.append(f"{path}: no file says it; give it under [values]")
    if c.spring_force is None and "static_load" not in c.document.get("tyre", {}):
        c.missing.append("tyre.static_load: no spring tells it; give it under [values]")


def _given_meanwhile(c: Conversion, sentence: str) -> bool:
    """Whether a bushing of an unread class has all of its stiffnesses among the values."""
    return any(
        f"{name}.stiffness.Fx to" in sentence
        and len(c.document.get("bushings", {}).get(name, {}).get("stiffness", {})) == len(BUSHING_AXES)
        for name in c.names.bushings
    )


def _has_part(table: str, axle_type: AxleType | None) -> bool:
    if axle_type is None:
        return True
    parts: dict[str, Any] = {"arb": axle_type.structure.bar, "steering": axle_type.structure.rack}
    return parts.get(table, True) is not None


def refuse_missing(c: Conversion) -> None:
    """IncompleteAxle that lists what an axle file cannot do without."""
    if c.missing:
        head = f"{c.database.subsystems[0].path}: the axle is not complete"
        raise IncompleteAxle(f"{head}; missing is " + "; ".join(c.missing) + ".")
