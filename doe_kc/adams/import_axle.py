"""An axle file from ADAMS/Car files: everything that was found, with where it came from."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from doe_kc.adams.anti_roll_bar import add_bar
from doe_kc.adams.bushing_orientation import top_mount_direction
from doe_kc.adams.bushings import add_bushings
from doe_kc.adams.completeness import note_missing, note_unknown
from doe_kc.adams.conversion import Conversion
from doe_kc.adams.database import read_database
from doe_kc.adams.name_map import MAPPED_TYPES, NameMap, name_map_path, read_name_map
from doe_kc.adams.orientation import shortest_turn
from doe_kc.adams.points import add_points, derive_mcpherson_points, set_frame
from doe_kc.adams.springs import add_springs, add_stops
from doe_kc.adams.steering import add_steering
from doe_kc.adams.wheel import add_hub, add_static
from doe_kc.axle.model import BUSHING_AXES, EXTRA_HARDPOINTS, HARDPOINTS
from doe_kc.axle_types import read_axle_type
from doe_kc.axle_types.read import DEFAULT_TYPE, AxleType
from doe_kc.ground.errors import InputError, nearest
from doe_kc.ground.typing import FloatArray

UNITS_TABLE = {
    "length": "mm",
    "force": "N",
    "angle": "deg",
    "stiffness": "N/mm",
    "rotational_stiffness": "Nm/deg",
}


@dataclass(frozen=True)
class AdamsSource:
    """What an import is made of. paths: subsystems, an assembly, or a folder. type: of the axle, empty: told
    by the hardpoints. map_path: name map, None: the package's own. values: by parameter path, in place of
    those of the name map."""

    paths: tuple[Path, ...]
    type: str = ""
    map_path: Path | None = None
    values: tuple[tuple[str, float], ...] = ()

    def names(self) -> NameMap:
        """The name map with the values; InputError where the type is open."""
        path = self.map_path or name_map_path(self.type or inferred_type(self.paths))
        names = read_name_map(path)
        if self.type and names.type != self.type:
            raise InputError(
                f"{path}: is for the type {names.type}, but --type is {self.type}; give one of them."
            )
        return names.model_copy(update={"values": names.values | dict(self.values)})


def axle_end(type_name: str) -> str:
    """`front` or `rear`, by the type's name."""
    return "rear" if "rear" in type_name else "front"


def inferred_type(paths: Sequence[Path]) -> str:
    """The only type whose hardpoints the files have; InputError for none or several."""
    fits, lacks = [], {}
    for name in MAPPED_TYPES:
        names = read_name_map(name_map_path(name))
        try:
            database = read_database(paths, axle_end(name))
        except InputError as error:
            lacks[name] = str(error)
            continue
        c = Conversion(database, names, None)
        lacking = [p for p in names.hardpoints if not c.row(names.hardpoints[p]) and p not in DERIVED]
        if lacking:
            lacks[name] = f"it lacks {', '.join(lacking)}"
        else:
            fits.append(name)
    if len(fits) == 1:
        return fits[0]
    if not fits and len(set(lacks.values())) == 1:
        raise InputError(next(iter(lacks.values())))
    if fits:
        raise InputError(
            f"{paths[0]}: could be {' or '.join(fits)} by its hardpoints; say which by --type TYPE."
        )
    reasons = "; ".join(f"{name}: {why}" for name, why in lacks.items())
    raise InputError(
        f"{paths[0]}: is none of the types that have a name map ({reasons}); give --type or --map."
    )


DERIVED = ("UPBBI", "SAH", "CLAMP")
"""Points of the McPherson axle that are made of others where the files do not have them."""


def convert(source: AdamsSource, *, folder: Path = Path()) -> Conversion:
    """All that the files say of the axle. folder: that a type file is seen from.

    `missing` of the result lists what an axle file cannot do without. InputError for files that are missing,
    do not read, or could mean two things.
    """
    names = source.names()
    axle_type = None if names.type == DEFAULT_TYPE else read_axle_type(names.type, folder, source="name map")
    structure = None if axle_type is None else axle_type.structure
    c = Conversion(read_database(source.paths, axle_end(names.type)), names, structure)
    _check_names(c, axle_type)
    _start(c)
    set_frame(c)
    if axle_type is None:
        add_points(c, tuple(HARDPOINTS) + tuple(EXTRA_HARDPOINTS))
        derive_mcpherson_points(c, top_mount_direction(c, "upb"))
        add_bushings(c, _mcpherson_axes(c))
        add_springs(c)
        add_stops(c, ("LWD", "UPB"))
    else:
        s = axle_type.structure
        add_points(c, (*s.points, *s.single_points), s.single_points)
        add_bushings(c, None)
        for name in [b.name for b in s.bushings if b.line is not None]:
            c.document["bushings"].get(name, {}).pop("x", None)
            c.document["bushings"].get(name, {}).pop("y", None)
        add_springs(c)
        if s.damper is not None:
            add_stops(c, (s.damper.at_a, s.damper.at_b))
    add_static(c)
    if structure is None or structure.rack is not None:
        add_steering(c)
    if structure is None or structure.bar is not None:
        add_bar(c)
    add_hub(c)
    _apply_values(c)
    note_unknown(c)
    note_missing(c, axle_type)
    return c


def _check_names(c: Conversion, axle_type: AxleType | None) -> None:
    """InputError for a point or bushing of the name map that the type does not have, or lacks."""
    points = (*HARDPOINTS, *EXTRA_HARDPOINTS)
    bushings: tuple[str, ...] = ("llf", "llr", "sff", "sfr", "upb")
    springs: tuple[str, ...] = ("spring",)
    if axle_type is not None:
        s = axle_type.structure
        points = (*s.points, *s.single_points)
        bushings, springs = tuple(b.name for b in s.bushings), tuple(b.name for b in s.springs)
    for table, named, known in (
        ("hardpoints", [*c.names.hardpoints, c.names.lower, c.names.upper], points),
        ("bushings", [*c.names.bushings], bushings),
        ("springs", [*c.names.springs], springs),
    ):
        for name in named:
            if name not in known:
                raise InputError(
                    f"name map: {table}.{name} is unknown to the type {c.names.type}; it has "
                    f"{', '.join(known)}."
                    f"{nearest(name, known)}"
                )
    for name in ("WLC", c.names.lower, c.names.upper):
        if name not in c.names.hardpoints:
            raise InputError(f"name map: hardpoints.{name} is missing; name the hardpoint that it is.")


def _start(c: Conversion) -> None:
    suspension = c.database.subsystems[0]
    c.document |= {"schema": "doe_kc.axle/1"}
    if c.structure is not None:
        c.document["type"] = c.names.type
    c.document |= {"name": suspension.path.stem.replace("_", " "), "units": dict(UNITS_TABLE)}
    c.left_out += c.database.left_out
    for subsystem in c.database.subsystems:
        c.files.append(subsystem.path)
        stem = subsystem.template.replace("\\", "/").rpartition("/")[2].rpartition(".")[0]
        if c.names.templates and stem not in c.names.templates:
            c.inferred.append(
                f"{subsystem.path.name}: its template {stem} is not one that the name map names"
            )
    if c.database.assembly is not None:
        c.files.append(c.database.assembly.path)


def _mcpherson_axes(c: Conversion) -> dict[str, FloatArray]:
    """(3, 3) local axes as columns that the McPherson axle fixes; the top mount's along its own z."""
    arm = np.array([[0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    axes = {"llf": arm, "llr": arm, "sff": np.eye(3), "sfr": np.eye(3)}
    points = c.document.get("hardpoints", {})
    if {"UPB", "UPBBI"} <= points.keys():
        along = np.subtract(points["UPBBI"], points["UPB"])
        axes["upb"] = shortest_turn(along / np.linalg.norm(along))
    return axes


def _apply_values(c: Conversion) -> None:
    """What the user says, in place of what the files say."""
    for path, value in c.names.values.items():
        head, _, rest = path.partition(".")
        keys = rest.split(".")
        source = "value of the name map"
        if head == "right":
            c.put_right(rest, value, source)
        elif rest in ("x", "y", "z"):
            _apply_coordinate(c, head, rest, value)
        elif head in c.names.bushings:
            _apply_bushing(c, head, keys, value, path)
        elif rest:
            c.put(head, rest, value, source)
        else:
            c.document[head] = value
        c.numbers = [n for n in c.numbers if n.path != path]


def _apply_coordinate(c: Conversion, point: str, axis: str, value: float) -> None:
    place = c.document.setdefault("hardpoints", {}).setdefault(point, [None, None, None])
    place["xyz".index(axis)] = value
    c.comments.setdefault(("hardpoints", point), "value of the name map")


def _apply_bushing(c: Conversion, name: str, keys: list[str], value: float, path: str) -> None:
    table = c.document.setdefault("bushings", {}).setdefault(name, {})
    if keys[0] in BUSHING_AXES and len(keys) == 1:
        keys = ["factor", *keys]
    if len(keys) != 2 or keys[1] not in BUSHING_AXES:
        raise InputError(
            f"name map: values.{path} is no parameter; expected one such as {name}.stiffness.Fx."
        )
    table.setdefault(keys[0], {})[keys[1]] = value
    if keys[0] == "stiffness":
        table.get("table", {}).pop(keys[1], None)
    c.comments["bushings", name] = "value of the name map"
