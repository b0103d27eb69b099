"""ADAMS/Car files in and out, and K&C tables for vehicle models."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from os import PathLike
from pathlib import Path

from doe_kc.adams.import_axle import AdamsSource
from doe_kc.api.axle import as_axle
from doe_kc.axle.model import Axle
from doe_kc.workflow.export_adams import AdamsExport
from doe_kc.workflow.export_adams import export_adams as write_back
from doe_kc.workflow.export_kc import export_kc as write_tables
from doe_kc.workflow.import_adams import import_adams as imported
from doe_kc.workflow.import_adams import write_import

Paths = str | PathLike[str] | Sequence[str | PathLike[str]]
"""A path, or several."""


@dataclass(frozen=True)
class AdamsAxle:
    """What ADAMS/Car files say of an axle.

    axle: of the type `type`. inferred, left_out: sentences. files: that were read. text: the axle file.
    """

    axle: Axle
    type: str
    inferred: tuple[str, ...]
    left_out: tuple[str, ...]
    files: tuple[Path, ...]
    text: str


def import_adams(
    paths: Paths,
    *,
    type: str = "",
    name_map: str | PathLike[str] | None = None,
    values: Mapping[str, float] | None = None,
    out: str | PathLike[str] | None = None,
) -> AdamsAxle:
    """The axle of ADAMS/Car subsystems or an assembly, with their property files; see docs/adams.md.

    paths: of subsystems (.sub), one assembly (.asy), or a database's folder. type: of the axle, told by the
    hardpoints where empty. name_map: which hardpoint and element is what, in place of the package's own.
    values: by parameter path, what no file says; they win over what a file says. out: folder for axle.toml
    and name_map.toml, by default nothing is written.

    Raises InputError for files that are missing, do not read, leave out what an axle needs, or could mean
    two things.

    >>> source = kc.import_adams("examples/adams/mcpherson.cdb", values={"steering.rack_mm_per_rev": 52.0})
    >>> source.type, source.axle.values["llr.cubic.Fx@L"]
    ('mcpherson_front', 0.01)
    """
    source = _source(paths, type, name_map, values)
    result = imported(source) if out is None else write_import(source, Path(out))[0]
    c = result.conversion
    return AdamsAxle(
        result.axle,
        c.names.type,
        tuple(c.inferred),
        tuple(c.left_out),
        tuple(dict.fromkeys(c.files)),
        result.text,
    )


def export_adams(
    axle: Axle | str | PathLike[str],
    original: Paths,
    out: str | PathLike[str],
    *,
    name_map: str | PathLike[str] | None = None,
    values: Mapping[str, float] | None = None,
) -> AdamsExport:
    """Copies in `out` of the ADAMS/Car files that an axle was imported from, with its changes and no others.

    original, name_map, values: as they were at the import. Result: files, changed (path -> lines), added,
    unwritten (sentences on what has no place), axle (the import of the copies).

    Raises InputError as `import_adams`, for an axle of another type, and for an `out` that is not empty.

    >>> rack = {"steering.rack_mm_per_rev": 54.0}
    >>> axle = kc.import_adams("examples/adams/double_wishbone.cdb", values=rack).axle
    >>> softer = kc.with_values(axle, {"llr.Fx": 0.8})
    >>> result = kc.export_adams(softer, "examples/adams/double_wishbone.cdb", "wishbone", values=rack)
    >>> [(path.name, lines) for path, lines in result.changed.items()]  # the factor and the spring's length
    [('front.sub', 2)]
    """
    model = as_axle(axle)
    kind = model.topology.structure.type
    return write_back(model, _source(original, kind, name_map, values), Path(out))


def export_kc(axle: Axle | str | PathLike[str], out: str | PathLike[str]) -> list[Path]:
    """Kinematic tables and compliance coefficients in the quantities of CarSim and CarMaker, as CSV and JSON
    in `out`; returns the paths. Units and signs are in the files.

    Raises InputError as `read_axle`, RunError where the axle has no equilibrium.

    >>> [path.name for path in kc.export_kc("examples/front_axle/axle.toml", "tables")]
    ['kinematics.csv', 'steer.csv', 'compliance.csv', 'vehicle_tables.json']
    """
    return write_tables(as_axle(axle), Path(out))


def _source(
    paths: Paths,
    type: str,
    name_map: str | PathLike[str] | None,
    values: Mapping[str, float] | None,
) -> AdamsSource:
    several = [paths] if isinstance(paths, str | PathLike) else list(paths)
    return AdamsSource(
        tuple(Path(p) for p in several),
        type,
        None if name_map is None else Path(name_map),
        tuple((values or {}).items()),
    )
