"""The text of an imported axle file: its tables in order, with where each number came from as comments."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from textwrap import wrap
from typing import Any

from doe_kc.adams.conversion import Conversion

TABLE_ORDER = (
    *("units", "hardpoints", "follow", "static", "tyre", "spring", "damper", "bump_stop", "rebound_stop"),
    *("arb", "steering", "scb"),
)
COMMENT_COLUMN = 46
REMARK_WIDTH = 100


def axle_text(c: Conversion) -> str:
    """TOML of `c.document`; `read_axle` reads it."""
    document = c.document
    lines = [
        *_remarks("imported from ADAMS/Car", [", ".join(dict.fromkeys(p.name for p in c.files))]),
        "# Chassis frame: X rearwards, Y to the right, Z up, ground at z = 0; left side, the right one "
        "mirrored.",
        *_remarks("inferred", c.inferred),
        *_remarks("left out", c.left_out),
        *(f"{key} = {_value(document[key])}" for key in ("schema", "type", "name") if key in document),
        *(f"{key} = {_value(document[key])}" for key in ("ride_height",) if key in document),
    ]
    rest = [k for k, v in document.items() if isinstance(v, dict) and k not in TABLE_ORDER]
    special = ("bushings", "effects", "right")
    for table in (*TABLE_ORDER, *(k for k in rest if k not in special)):
        if document.get(table):
            lines += ["", f"[{table}]", *_entries(c, table, document[table])]
    for name, bushing in document.get("bushings", {}).items():
        lines += [
            "",
            f"[bushings.{name}]  # {_plain(c.comments.get(('bushings', name), ''))}",
            *_bushing(bushing),
        ]
    if document.get("right"):
        lines += ["", "[right]", *_entries(c, "right", document["right"])]
    for name, options in document.get("effects", {}).items():
        lines += ["", f"[effects.{name}]  # {_plain(c.comments.get(('effects', name), ''))}"]
        lines += [f"{key} = {_value(value)}" for key, value in options.items()]
    return "\n".join(line.rstrip() for line in lines) + "\n"


def _remarks(word: str, remarks: list[str]) -> Iterator[str]:
    for remark in remarks:
        yield from (f"# {line}" for line in wrap(_plain(f"{word}: {remark}"), REMARK_WIDTH))


def _entries(c: Conversion, table: str, entries: Mapping[str, Any]) -> Iterator[str]:
    for key, value in entries.items():
        word = key if table not in ("right",) else json.dumps(key)
        text = f"{word} = {_value(value)}"
        comment = c.comments.get((table, key))
        yield f"{text:<{COMMENT_COLUMN}}# {_plain(comment)}" if comment else text


def _bushing(bushing: Mapping[str, Any]) -> Iterator[str]:
    for key in ("stiffness", "factor", "cubic", "preload"):
        if bushing.get(key):
            inner = ", ".join(f"{axis} = {_value(v)}" for axis, v in bushing[key].items())
            yield f"{key} = {{ {inner} }}"
    for axis, points in bushing.get("table", {}).items():
        yield f"table.{axis} = {_value(points)}"
    for key in ("x", "y"):
        if key in bushing:
            yield f"{key} = {_value(bushing[key])}"


def _plain(comment: str) -> str:
    return "".join(ch if ch.isprintable() else " " for ch in comment)


def _value(value: Any) -> str:
    if isinstance(value, str):
        return json.dumps(_plain(value), ensure_ascii=False)
    if isinstance(value, list | tuple):
        return "[" + ", ".join(_value(v) for v in value) + "]"
    return repr(float(value))
