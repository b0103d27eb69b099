"""Writes a changed axle: the original file's text and comments, only the values that changed replaced."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping, MutableMapping
from copy import deepcopy
from pathlib import Path
from textwrap import wrap
from typing import Any

import numpy as np
import tomlkit
from tomlkit.items import Table

from doe_kc import __version__
from doe_kc.axle.model import Axle
from doe_kc.axle.parameter_kinds import COORDINATES
from doe_kc.axle.parameters import parameter_value
from doe_kc.axle.places import Places, places_of
from doe_kc.axle_file.places import (
    Place,
    entry,
    option_places,
    own_place,
    path_of,
    put_entry,
    restore_entry,
)
from doe_kc.axle_file.read import apply_effects, axle_from_document, plain_axle
from doe_kc.effects import EFFECTS, effect_id
from doe_kc.ground.errors import InputError, RunError
from doe_kc.ground.files import read_bytes, read_toml
from doe_kc.ground.output import write_whole

COMMENT_LENGTH = 100
"""Characters of a line of comment."""
NO_UNIT = ("", "-")


def set_effects(document: tomlkit.TOMLDocument, axle: Axle) -> None:
    """The axle's effects in the document, no others; tables that say the same already stay as they are.

    Faults of the measurement are left out: an axle file does not hold them.
    """
    tables, places = document.get("effects", {}), places_of(axle)
    for key in list(tables):
        if effect_id(key, places) not in axle.effects:
            del tables[key]
    present = {effect_id(key, places): key for key in tables}
    for ident, options in axle.effects.items():
        if ident in present:
            _change(tables[present[ident]], ident, options, places)
        elif not EFFECTS[ident].on_rig:
            if "effects" not in document:
                document["effects"] = tomlkit.table(is_super_table=True)
            document["effects"][ident] = effect_table(ident, options)


def effect_table(ident: str, options: Mapping[str, Any]) -> Table:
    """A table with the effect's name and physics as comments; numbers as short as they read back exactly."""
    effect, table = EFFECTS[ident], tomlkit.table()
    table.comment(effect.label)
    for line in wrap(effect.physics, COMMENT_LENGTH):
        table.add(tomlkit.comment(line))
    for key, value in options.items():
        table[key] = list(value) if isinstance(value, tuple) else value
        if unit := unit_beside(ident, key):
            table[key].comment(unit)
    return table


def unit_beside(ident: str, key: str) -> str:
    """Unit of an option whose name does not say it, such as a bushing's; empty otherwise."""
    units = {s.key: s.unit for h in EFFECTS[ident].hypotheses() for s in h.sizes}
    unit = units.get(key, "")
    said = "_" + unit.replace("/", "_")
    return "" if unit in NO_UNIT or key.endswith(said) else unit


def _change(table: MutableMapping[str, Any], ident: str, options: Mapping[str, Any], places: Places) -> None:
    """Bring a table that the file has to other options, key by key."""
    effect = EFFECTS[ident]
    if effect.read(dict(table), "axle", places) == effect.read(options, "axle", places):
        return
    for key in list(table):
        if key not in options:
            del table[key]
    for key, value in options.items():
        if table.get(key) != value:
            table[key] = value


CONDITIONING = "conditioning"


def set_conditioning(document: tomlkit.TOMLDocument, axle: Axle) -> None:
    """The axle's conditioning loops in the document, where they are not what it says already."""
    tables = document.get("load_cases", {})
    for ident, case in axle.load_cases.items():
        if tables.get(ident, {}).get(CONDITIONING, 0) == case.conditioning:
            continue
        if "load_cases" not in document:
            document["load_cases"] = tomlkit.table(is_super_table=True)
        if ident not in document["load_cases"]:
            document["load_cases"][ident] = tomlkit.table()
        document["load_cases"][ident][CONDITIONING] = case.conditioning


AXLE_HEADER = "# Written by doe_kc"
WRITE_CORRECTIONS = 4
"""Corrections of a place until the axle reads as wanted: what moves with a value follows in the next."""
NUDGES = 8
"""Neighbouring floating-point numbers tried where right = left + difference is rounded."""
TOLERANCE = 1e-12
"""Relative; a right-side value of the opposite sign can miss by the last digit."""


def write_axle(axle: Axle, original: Path, path: Path, *, note: str = "") -> Path:
    """TOML of `axle`, made from the file that it came from; `read_axle(path)` gives the same values.

    Comments, order and unchanged numbers stay; missing keys and tables are added where they belong. A first
    line says what wrote it. note: goes into that line. RunError when a value has no place in the file beside
    one of its effects, or the file cannot be written.
    """
    read_toml(original)  # its messages name line and remedy
    text = read_bytes(original, "TOML file").decode("utf-8")
    document = tomlkit.parse(text)
    own_type = str(document.get("type", "")).endswith(".toml")
    if own_type:
        document["type"] = str((original.parent / str(document["type"])).resolve())
    set_effects(document, axle)
    set_conditioning(document, axle)
    if not _fit(document, axle):
        _fit_without_an_effect(document, axle, str(path))
    if own_type:
        document["type"] = os.path.relpath(str(document["type"]), path.parent.resolve())
    content = _with_header(tomlkit.dumps(document), original, note)
    return write_whole(path, lambda p: p.write_bytes(content.encode("utf-8")))


def _with_header(text: str, original: Path, note: str) -> str:
    line = f"{AXLE_HEADER} {__version__} from {original.name}" + (f": {note}" if note else "")
    line = "".join(c if c.isprintable() else " " for c in line)
    end = "\r\n" if "\r\n" in text else "\n"
    if text.startswith(AXLE_HEADER):
        text = text.partition("\n")[2]
    # Tables that were added end their lines with \n in a file of any kind.
    return f"{line}\n{text}".replace("\r\n", "\n").replace("\n", end)


def _read(document: tomlkit.TOMLDocument) -> Axle:
    return axle_from_document(document.unwrap(), source="axle")


def _read_unchecked(document: tomlkit.TOMLDocument) -> Axle:
    """As it is on the way to another axle: its geometry and freedoms do not matter yet."""
    file, plain = plain_axle(document.unwrap(), source="axle")
    return apply_effects(plain, file.effects, source="axle")


def _wrong(document: tomlkit.TOMLDocument, axle: Axle) -> list[str]:
    """Internal values that do not read as wanted, the left side's first."""
    now = _read_unchecked(document).values
    return sorted((n for n, v in axle.values.items() if now.get(n) != v), key=lambda n: n.endswith("@R"))


def _fit(document: tomlkit.TOMLDocument, axle: Axle) -> bool:
    """Change the document until it reads as the axle; False when that cannot be."""
    drivers = _drivers(document)
    own = {name: own_place(name, axle.topology.structure) for name in axle.values}
    for _ in range(WRITE_CORRECTIONS):
        wrong = [n for n in _wrong(document, axle) if n not in drivers and own[n]]
        if not wrong:
            break
        left = [n for n in wrong if not n.endswith("@R")]
        for name in left or wrong:
            _add_point(document, own[name])
            put_entry(document, own[name], parameter_value(axle, path_of(name)))
    for name in _wrong(document, axle):
        _add_point(document, own[name])
        places = [own[name], *drivers.get(name, [])]
        any(_solve(document, axle, name, place) for place in places if place)
    return _agrees(document, axle)


def _add_point(document: tomlkit.TOMLDocument, place: Place) -> None:
    """A hardpoint that the file leaves to be derived, as it is read without it."""
    if place[:1] == ("hardpoints",) and place[1] not in document["hardpoints"]:
        now = _read_unchecked(document)
        document["hardpoints"][place[1]] = [
            parameter_value(now, f"{place[1]}.{axis}") for axis in COORDINATES
        ]


def _agrees(document: tomlkit.TOMLDocument, axle: Axle) -> bool:
    now = _read(document)
    return now.topology == axle.topology and all(
        abs(now.values.get(n, np.nan) - v) <= TOLERANCE * abs(v) for n, v in axle.values.items()
    )


def _fit_without_an_effect(document: tomlkit.TOMLDocument, axle: Axle, source: str) -> None:
    """An effect may hold a value that the file's own keys can say: leave such a one out."""
    for ident in list(document.get("effects", {})):
        trial = tomlkit.parse(tomlkit.dumps(document))
        del trial["effects"][ident]
        if _fit(trial, axle):
            del document["effects"][ident]
            _fit(document, axle)
            return
    names = ", ".join(dict.fromkeys(path_of(n) for n in _wrong(document, axle))) or "its topology"
    effects = ", ".join(axle.effects) or "none"
    raise RunError(
        f"{source}: {names} cannot be written beside the axle's effects ({effects}); "
        "leave them out of the variables."
    )


def _drivers(document: tomlkit.TOMLDocument) -> dict[str, list[Place]]:
    """Internal value -> options of effects that it moves with, found by changing each a little; first the one
    that moves the fewest others."""
    file, plain = plain_axle(document.unwrap(), source="axle")
    axle = apply_effects(plain, file.effects, source="axle")
    moving: list[tuple[Place, list[str]]] = []
    for place, value in option_places(file.effects, places_of(axle)):
        trial = {"effects": deepcopy(file.effects)}
        put_entry(trial, place, value * 1.0001 if value else 1e-4)
        now = apply_effects(plain, trial["effects"], source="axle").values
        moving.append((place, [name for name, moved in now.items() if moved != axle.values[name]]))
    out: dict[str, list[Place]] = {}
    for place, names in sorted(moving, key=lambda item: len(item[1])):
        for name in names:
            out.setdefault(name, []).append(place)
    return out


def _solve(document: tomlkit.TOMLDocument, axle: Axle, name: str, place: Place) -> bool:
    """Change one number until the internal value reads as wanted; undone when it does not answer."""
    path = path_of(name)
    want, before = parameter_value(axle, path), entry(document, place)
    readings: dict[float, float] = {}
    for trial in _secant(readings, want, before):
        readings[trial] = _reading(document, place, trial, path)
    best = min(readings, key=lambda t: abs(readings[t] - want))
    if len(set(readings.values())) < 2 or not np.isfinite(readings[best]):
        restore_entry(document, place, before)
        return False
    for trial in _neighbours(best):
        if readings[best] == want:
            break
        readings[trial] = _reading(document, place, trial, path)
        best = min((best, trial), key=lambda t: abs(readings[t] - want))
    put_entry(document, place, best)
    return readings[best] == want


def _secant(readings: Mapping[float, float], want: float, before: Any) -> Iterator[float]:
    """Numbers to try: a neighbour to compare with, the wanted one, then where the line through two leads."""
    yield float(before) if isinstance(before, int | float) and before != want else want * 1.001 + 1e-6
    yield want
    for _ in range(WRITE_CORRECTIONS):
        (t0, g0), (t1, g1) = list(readings.items())[-2:]
        if g1 in (want, g0) or not np.isfinite([g0, g1]).all():
            return
        yield t1 + (want - g1) * (t1 - t0) / (g1 - g0)


def _neighbours(value: float) -> Iterator[float]:
    below = above = value
    for _ in range(NUDGES):
        below, above = float(np.nextafter(below, -np.inf)), float(np.nextafter(above, np.inf))
        yield below
        yield above


def _reading(document: tomlkit.TOMLDocument, place: Place, value: float, path: str) -> float:
    """The chassis value of a path with one number of the document changed; nan when no axle has it."""
    put_entry(document, place, value)
    try:
        return parameter_value(_read(document), path)
    except InputError:
        return np.nan
