"""The headings of a rig record's columns."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass

from doe_kc.curves import RIG_RESPONSES
from doe_kc.measurement.units import is_unit

RIG_NAMES: Mapping[str, str] = {r: "caster" if r == "spin" else r for r in RIG_RESPONSES}
"""Response -> channel name in a record; the rig's `caster` is read off the wheel, our `spin`."""

TIME = "time"
TIME_UNIT = "s"

_HEADING = re.compile(r"\s*([^\[\]]*?)\s*(?:\[\s*([^\[\]]*?)\s*\])?\s*")
_ROUND = re.compile(r"(.*\S)\s*\(([^()]*)\)")


@dataclass(frozen=True)
class Heading:
    """A column heading `name [unit]` or `name (unit)`; `unit` is None when there are no brackets."""

    name: str
    unit: str | None

    def __str__(self) -> str:
        return self.name if self.unit is None else f"{self.name} [{self.unit}]"


def parse_heading(text: str) -> Heading:
    """`"toe_L [deg]"` -> Heading("toe_L", "deg"); text of another form is all name."""
    match = _HEADING.fullmatch(text)
    if match is None:
        return Heading(text.strip(), None)
    other = _ROUND.fullmatch(match[1]) if match[2] is None else None
    if other is not None and is_unit(other[2]):
        return Heading(other[1], other[2].strip())
    return Heading(match[1], match[2])
