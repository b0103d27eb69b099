"""The `[effects.ID]` tables of an axle file: added, changed and taken out, with words on what they are."""

from __future__ import annotations

from collections.abc import Mapping, MutableMapping
from textwrap import wrap
from typing import Any

import tomlkit
from tomlkit.items import Table

from doe_kc.axle.model import Axle
from doe_kc.axle.places import Places, places_of
from doe_kc.axle_file.places import effect_id
from doe_kc.effects import EFFECTS

COMMENT_LENGTH = 100
"""Characters of a line of comment."""
NO_UNIT = ("", "-")


def set_effects(document: tomlkit.TOMLDocument, axle: Axle) -> None:
    """The axle's effects in the document, no others; tables that say the same already stay as they are.

    Faults of the measurement are left out: an axle file does not hold them.
    """
    tables = document.get("effects", {})
    for key in list(tables):
        if effect_id(key) not in axle.effects:
            del tables[key]
    present = {effect_id(key): key for key in tables}
    for ident, options in axle.effects.items():
        if ident in present:
            _change(tables[present[ident]], ident, options, places_of(axle))
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
