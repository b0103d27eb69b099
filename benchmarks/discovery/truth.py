"""The unsealed key of a case, as far as it is scored."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass

DELETED = "library_deleted"
"""The suite whose hidden effect the analyser's library does not have."""


@dataclass(frozen=True)
class TrueEffect:
    """See `hidden.Hidden`. location: "" where there is no choice."""

    id: str
    size: float
    location: str
    parameters: Mapping[str, float]
    approximate: bool


@dataclass(frozen=True)
class Truth:
    """small: what is there in traces. shows: where what no library has can be seen."""

    name: str
    suite: str
    effects: tuple[TrueEffect, ...]
    small: tuple[TrueEffect, ...]
    outside: str
    shows: frozenset[tuple[str, str]]

    @property
    def ids(self) -> frozenset[str]:
        """Hidden effects."""
        return frozenset(e.id for e in self.effects)

    @property
    def clutter(self) -> Mapping[str, Mapping[str, float]]:
        """Id -> parameters of what is there in traces."""
        return {e.id: e.parameters for e in self.small}

    @property
    def label(self) -> str:
        """Row of the confusion matrix; of two effects, both."""
        if self.outside:
            return f"outside: {self.outside}"
        return " + ".join(e.id for e in self.effects) or "none"


def read_truth(key: str) -> Truth:
    """From the key's TOML."""
    data = tomllib.loads(key)
    effects, small = (
        tuple(
            TrueEffect(e["id"], e["size"], e["location"], e["parameters"], e["approximate"]) for e in data[of]
        )
        for of in ("effects", "clutter")
    )
    outside = data.get("outside", {})
    return Truth(
        name=data["name"],
        suite=data["suite"],
        effects=effects,
        small=small,
        outside=outside.get("kind", ""),
        shows=frozenset((case, response) for case, response in outside.get("shows", [])),
    )
