"""ADAMS/Car files to an axle file: conversion, the static load that the spring tells, files."""

from __future__ import annotations

import tomllib
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path

import tomlkit

from doe_kc.adams.axle_text import axle_text
from doe_kc.adams.completeness import IncompleteAxle, refuse_missing
from doe_kc.adams.conversion import Conversion
from doe_kc.adams.import_axle import AdamsSource, convert, inferred_type
from doe_kc.adams.name_map import name_map_path
from doe_kc.adams.points import PRODUCT_DIGITS, tidy
from doe_kc.axle.model import Axle
from doe_kc.axle_file.read import axle_from_document
from doe_kc.ground.errors import InputError, RunError
from doe_kc.ground.files import read_bytes
from doe_kc.ground.output import write_whole
from doe_kc.solver.suite import solve

AXLE_NAME, MAP_NAME = "axle.toml", "name_map.toml"
"""Files that an import writes."""
FIRST_LOADS = (3000.0, 5000.0)
"""N per wheel; the static load is searched from here."""
LOAD_STEPS = 30
LOAD_AGREEMENT = 1e-13
"""Relative difference of the spring's force at which the search ends: rounding."""


@dataclass(frozen=True)
class AdamsImport:
    """axle: as read from `text`, the axle file. conversion: where everything came from."""

    axle: Axle
    text: str
    conversion: Conversion


def import_adams(source: AdamsSource) -> AdamsImport:
    """The axle of ADAMS/Car files.

    InputError for files that are missing, do not read, leave out what an axle needs, or may mean two things.
    """
    c = convert(source)
    refuse_missing(c)
    name = str(c.database.subsystems[0].path)
    if "static_load" not in c.document.get("tyre", {}):
        assert c.spring_force is not None
        c.put("tyre", "static_load", FIRST_LOADS[0], "")
        axle = axle_from_document(_document(c), source=name)
        load = tidy(static_load(axle, c.spring_force, name), PRODUCT_DIGITS)
        c.put("tyre", "static_load", load, f"at which the spring has {c.spring_force:.8g} N at design")
        c.inferred.append(
            f"the static load is that at which the spring has its {c.spring_force:.6g} N at design"
        )
    text = axle_text(c)
    return AdamsImport(axle_from_document(tomllib.loads(text), source=f"import of {name}"), text, c)


def _document(c: Conversion) -> dict[str, object]:
    return dict(tomllib.loads(axle_text(c)))


def design_spring_force(axle: Axle) -> float:
    """N in the first spring at its design length, static; RunError where there is no such state."""
    static = solve(axle, []).static
    assert static is not None
    return static.datum.preload


def static_load(axle: Axle, force: float, source: str) -> float:
    """N per wheel at which the spring has that force at design (secant method).

    InputError where no positive load does.
    """

    def excess(load: float) -> float:
        return design_spring_force(axle.changed({"tyre.static_load": load})) - force

    points = [(load, excess(load)) for load in FIRST_LOADS]
    for _ in range(LOAD_STEPS):
        (l0, f0), (l1, f1) = points[-2:]
        if abs(f1) <= LOAD_AGREEMENT * abs(force) or f1 == f0:
            break
        load = l1 - f1 * (l1 - l0) / (f1 - f0)
        if not 0.0 < load < 1e6:
            raise InputError(
                f"{source}: with {force:.5g} N in the spring at design there is no static load between 0 "
                "and 1e6 N; "
                "correct its preload or installed length, or give tyre.static_load under [values]."
            )
        points.append((load, excess(load)))
    best = min(points, key=lambda p: abs(p[1]))
    if abs(best[1]) > 1e-6 * abs(force):
        raise RunError(f"{source}: the static load was not found; give tyre.static_load under [values].")
    return best[0]


def map_text(source: AdamsSource) -> str:
    """The name map that an import goes by, with the values that were given beside it."""
    path = source.map_path or name_map_path(source.type or inferred_type(source.paths))
    document = tomlkit.parse(read_bytes(path, "name map").decode("utf-8-sig"))
    if source.values:
        table = document.setdefault("values", tomlkit.table())
        for key, value in source.values:
            table[key] = value
    return tomlkit.dumps(document)


def write_import(source: AdamsSource, out: Path) -> tuple[AdamsImport, tuple[Path, ...]]:
    """Write axle file and name map; the map also where the axle is not complete, to be edited.

    A name map that is in `out` already counts where `source` names none. InputError as `import_adams`.
    """
    map_path = out / MAP_NAME
    if source.map_path is None and map_path.exists():
        source = replace(source, map_path=map_path)
    try:
        result = import_adams(source)
    except IncompleteAxle as error:
        _write_map(source, map_path)
        raise IncompleteAxle(f"{error} Say it in {map_path} and repeat the command.") from None
    path = out / AXLE_NAME
    write_whole(path, lambda p: p.write_text(result.text, encoding="utf-8"))
    _write_map(source, map_path)
    return result, (path, map_path)


def _write_map(source: AdamsSource, path: Path) -> None:
    text = map_text(source)
    write_whole(path, lambda p: p.write_text(text, encoding="utf-8"))


def import_lines(result: AdamsImport) -> Iterator[str]:
    """For a terminal: the files read, what was inferred, what was left out."""
    c = result.conversion
    yield f"type: {c.names.type}"
    yield f"files: {', '.join(dict.fromkeys(p.name for p in c.files))}"
    yield from (f"inferred: {remark}" for remark in c.inferred)
    yield from (f"left out: {remark}" for remark in c.left_out)
