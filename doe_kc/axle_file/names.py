"""Whether an axle file has a number for all that its type names, and nothing else."""

from __future__ import annotations

from collections.abc import Collection, Mapping

from doe_kc.axle.structure import Structure
from doe_kc.axle_file.schema import AxleFile
from doe_kc.axle_types.read import check_follow
from doe_kc.ground.errors import InputError, nearest


def check_names(file: AxleFile, follow: Mapping[str, str], structure: Structure, source: str) -> None:
    """InputError unless the file has a number for all that the type names, and nothing else.

    follow: of the file, or of the type. A strut's clamp may be left out.
    """
    points = (*structure.points, *structure.single_points)
    bushings = [bush.name for bush in structure.bushings]
    springs = [spring.name for spring in structure.springs]
    derived = () if structure.strut is None else (structure.strut.at,)
    for table, names, wanted in (
        ("hardpoints", [*file.hardpoints, *derived], points),
        ("bushings", file.bushings, bushings),
        ("springs", file.springs, springs),
    ):
        _same_names(table, names, wanted, structure.type, source)
    for table, needed in (
        ("bump_stop", structure.damper),
        ("rebound_stop", structure.damper),
        ("arb", structure.bar),
        ("steering", structure.rack),
    ):
        present = getattr(file, table) is not None
        if needed is not None and not present:
            raise InputError(f"{source}: table [{table}] is missing; the type {structure.type} needs it.")
        if needed is None and present:
            raise InputError(f"{source}: [{table}] is for nothing that a {structure.type} has; remove it.")
    for table, part in (("strut", structure.strut), ("steer_arm", structure.steer_arm)):
        if part is None and getattr(file, table) is not None:
            raise InputError(f"{source}: [{table}] is for nothing that a {structure.type} has; remove it.")
    check_follow(follow, structure.points, source)


def _same_names(
    table: str, present: Collection[str], wanted: Collection[str], type_name: str, source: str
) -> None:
    for name in present:
        if name not in wanted:
            raise InputError(
                f"{source}: {table}.{name} is unknown to the type {type_name}; "
                f"it has {', '.join(wanted)}.{nearest(name, wanted)}"
            )
    for name in wanted:
        if name not in present:
            raise InputError(f"{source}: {table}.{name} is missing; the type {type_name} needs it.")
