"""Reads an axle file."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from doe_kc.axle.freedoms import check_freedoms
from doe_kc.axle.geometry import check_geometry
from doe_kc.axle.model import Axle
from doe_kc.axle.parameters import with_values
from doe_kc.axle.structure import Structure
from doe_kc.axle_file.names import check_names
from doe_kc.axle_file.schema import AxleFile
from doe_kc.axle_file.tables import chosen_load_cases
from doe_kc.axle_file.values import file_topology, file_values, oriented
from doe_kc.axle_types import DEFAULT_TYPE, read_axle_type
from doe_kc.effects import apply_effect, refuse_on_rig
from doe_kc.ground.files import read_toml, validate

STEER_RACK_TRAVEL = 60.0
"""mm to either side that a steering input drives by default."""


def read_axle(path: Path) -> Axle:
    """Axle from its TOML file; InputError naming file and key for anything wrong."""
    return axle_from_document(read_toml(path), source=str(path), folder=Path(path).parent)


def axle_from_document(document: Mapping[str, Any], *, source: str, folder: Path | None = None) -> Axle:
    """Axle from the parsed file; `source` names it in messages. folder: that a type file is seen from."""
    file, axle = _plain_axle(document, folder or Path(), source)
    if file.right:
        axle = with_values(axle, {f"right.{path}": v for path, v in file.right.items()}, source=source)
    for ident, options in file.effects.items():
        refuse_on_rig(ident, source)
        axle = apply_effect(axle, ident, options, source=source)
    check_geometry(axle, source)
    check_freedoms(axle, axle.topology.structure, source)
    return axle


def _plain_axle(document: Mapping[str, Any], folder: Path, source: str) -> tuple[AxleFile, Axle]:
    """The checked file, and its axle without the right side's own values and effects."""
    axle_type = read_axle_type(str(document.get("type", DEFAULT_TYPE)), folder, source=source)
    file = validate(AxleFile, _with_springs(document, axle_type.structure), source)
    follow = axle_type.follow if file.follow is None else file.follow
    check_names(file, follow, axle_type.structure, source)
    structure = oriented(file, axle_type.structure, source)
    cases = chosen_load_cases(file.load_cases, source)
    if file.steering is None:
        cases.pop("steer")
    elif "steer" not in file.load_cases or file.load_cases["steer"].amplitude is None:
        angle = STEER_RACK_TRAVEL * 360.0 / file.steering.rack_mm_per_rev
        cases["steer"] = replace(cases["steer"], amplitude=angle)
    return file, Axle(
        name=file.name,
        topology=file_topology(file, structure),
        values=file_values(file, structure),
        follow=dict(follow),
        load_cases=cases,
        labels=axle_type.labels,
        lines=axle_type.lines,
    )


def _with_springs(document: Mapping[str, Any], structure: Structure) -> dict[str, Any]:
    """The document with its springs' tables in one."""
    names = {spring.name for spring in structure.springs}
    out = {key: value for key, value in document.items() if key not in names}
    return out | {"springs": {key: document[key] for key in names if key in document}}
