"""Whether what an answer excludes is not there after all, and larger than it says."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from benchmarks.discovery.truth import TrueEffect
from doe_kc.effects import EFFECTS
from doe_kc.effects.hypothesis import Size


@dataclass(frozen=True)
class Excluded:
    """One statement of an answer. above: name of a size, `LLR[1]` in a list -> its limit, None without."""

    id: str
    location: str | None
    above: Mapping[str, float | None]


def read_excluded(data: Sequence[Mapping[str, Any]]) -> tuple[Excluded, ...]:
    """From the answer's JSON."""
    return tuple(Excluded(e["id"], e.get("location"), dict(_limits(e["above"]))) for e in data)


def said_of(effect: TrueEffect, excluded: Sequence[Excluded]) -> list[Excluded]:
    """The statements about a hidden effect in its place."""
    return [e for e in excluded if e.id == effect.id and (e.location or "") == effect.location]


def contradicted(effect: TrueEffect, statement: Excluded) -> bool:
    """Whether one of the effect's numbers is beyond its limit."""
    sizes = {
        s.name: s
        for h in EFFECTS[effect.id].hypotheses()
        if h.location == statement.location
        for s in h.sizes
    }
    return any(
        limit is not None
        and name in effect.parameters
        and _beyond(sizes[name], effect.parameters[name], limit)
        for name, limit in statement.above.items()
    )


def unshown(effect: TrueEffect, excluded: Sequence[Excluded]) -> bool:
    """Whether the answer says that the records do not show the effect in its place: it is excluded in other
    places only, or its largest number is without a limit."""
    statements = said_of(effect, excluded)
    if not statements:
        return any(e.id == effect.id for e in excluded)
    sizes = {
        s.name: s
        for h in EFFECTS[effect.id].hypotheses()
        if (h.location or "") == effect.location
        for s in h.sizes
    }
    known = {name: abs(v / sizes[name].typical) for name, v in effect.parameters.items() if name in sizes}
    largest = max(known, key=lambda name: known[name], default="")
    return all(s.above.get(largest) is None for s in statements)


def _beyond(size: Size, value: float, limit: float) -> bool:
    if size.growth == "compliance":
        return value < limit
    if size.growth == "factor":
        return not min(limit, 1.0 / limit) <= value <= max(limit, 1.0 / limit)
    return abs(value) > abs(limit)


def _limits(above: Mapping[str, Any]) -> list[tuple[str, float | None]]:
    out: list[tuple[str, float | None]] = []
    for key, entry in above.items():
        value = entry["value"]
        if isinstance(value, list):
            out += [(f"{key}[{i}]", one) for i, one in enumerate(value)]
        else:
            out.append((key, value))
    return out
