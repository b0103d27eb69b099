"""Where an axle file holds each internal value, and how to change one entry without touching the rest."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, MutableMapping
from typing import Any, get_args

import tomlkit

from doe_kc.axle.model import BUSHING_AXES
from doe_kc.axle.parameter_kinds import COORDINATES
from doe_kc.axle.places import Places
from doe_kc.axle.structure import Structure
from doe_kc.axle_file.schema import AxleFile
from doe_kc.effects import EFFECTS, effect_id

OF_BUSHINGS = ("stiffness", "cubic", "preload")
"""Tables that a bushing has in the file."""
Place = tuple[str | int, ...]
"""Keys and indices from the top of the file to one number."""


def own_place(name: str, structure: Structure) -> Place:
    """Where the file of such an axle holds an internal value; empty when only an effect can give it."""
    path = name.split("@")[0]
    head, _, rest = path.partition(".")
    if name.endswith("@R"):
        return ("right", path)
    if rest in COORDINATES:
        return ("hardpoints", head, COORDINATES.index(rest))
    if rest in BUSHING_AXES and head != "scb":
        return ("bushings", head, "factor", rest)
    if rest.split(".")[0] in OF_BUSHINGS:
        return ("bushings", head, *rest.split("."))
    if rest in _keys(head) or (rest == "rate" and head in [spring.name for spring in structure.springs]):
        return (head, rest)
    return (head,) if path in AxleFile.model_fields else ()


def _keys(table: str) -> set[str]:
    """Keys that the file may have in a table."""
    field = AxleFile.model_fields.get(table)
    if field is None:
        return set()
    kinds = get_args(field.annotation) or (field.annotation,)  # a table that not every type has: T | None
    return {key for kind in kinds for key in getattr(kind, "model_fields", {})}


def path_of(name: str) -> str:
    """Parameter path of an internal value, its side named when it is the right one."""
    return f"right.{name[:-2]}" if name.endswith("@R") else name.removesuffix("@L")


def option_places(effects: Mapping[str, Mapping[str, Any]], places: Places) -> Iterator[tuple[Place, float]]:
    """Every number among the effects' options, defaults included. places: of the axle."""
    for key, given in effects.items():
        ident = effect_id(key, places)
        defaults = {k: o.default for k, o in EFFECTS[ident].options.items()}
        yield from _numbers(("effects", key), defaults | dict(given))


def _numbers(place: Place, value: Any) -> Iterator[tuple[Place, float]]:
    if isinstance(value, Mapping):
        for key, inner in value.items():
            yield from _numbers((*place, key), inner)
    elif isinstance(value, list | tuple):
        for i, inner in enumerate(value):
            yield from _numbers((*place, i), inner)
    elif isinstance(value, int | float) and not isinstance(value, bool):
        yield place, float(value)


def entry(document: Any, place: Place) -> Any:
    """The entry at a place, None when there is none."""
    for key in place:
        if not isinstance(key, int) and key not in document:
            return None
        document = document[key]
    return document


def put_entry(document: MutableMapping[str, Any], place: Place, value: Any) -> None:
    """Set one entry, making the tables on the way; comments beside it stay."""
    *way, last = place
    table: Any = document
    for depth, key in enumerate(way):
        if not isinstance(key, int) and key not in table:
            table[key] = _new(place, depth)
        table = table[key]
    table[last] = value


def _new(place: Place, depth: int) -> Any:
    """An empty table as its place is written by hand: inline for what a bushing has per axis."""
    if place[0] == "bushings" and depth == 2:
        return tomlkit.inline_table()
    return tomlkit.table(is_super_table=place[0] == "effects" and depth == 0)


def restore_entry(document: MutableMapping[str, Any], place: Place, before: Any) -> None:
    """Put an entry back, or take it out when there was none."""
    if before is not None:
        put_entry(document, place, before)
        return
    table = entry(document, place[:-1])
    del table[place[-1]]
    if not table and place[0] == "right":
        del document["right"]
