"""The unsealed key of a case, as far as it is scored."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, field
from statistics import geometric_mean

from doe_kc.effects.rubber_hysteresis import REAR, REST

DELETED = "library_deleted"
"""The suite whose hidden effect the analyser's library does not have."""


@dataclass(frozen=True)
class TrueEffect:
    """See `hidden.Hidden`. location: "" where there is no choice. of_bushings: parameter -> bushing -> its
    own, where they differ."""

    id: str
    size: float
    location: str
    parameters: Mapping[str, float]
    approximate: bool
    of_bushings: Mapping[str, Mapping[str, float]] = field(default_factory=dict)

    def parameters_at(self, location: str) -> dict[str, float]:
        """Its parameters as they are where an answer says: of the bushings there, where they differ, the
        geometric mean, since an analyser's number is the middle of factors."""
        own = {
            name: geometric_mean(value for bushing, value in each.items() if _is_at(bushing, location))
            for name, each in self.of_bushings.items()
        }
        return {**self.parameters, **own}


def _is_at(bushing: str, location: str) -> bool:
    return location in ("", bushing) or (location == REST and bushing not in REAR)


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
            TrueEffect(
                e["id"],
                e["size"],
                e["location"],
                e["parameters"],
                e["approximate"],
                {n: e["options"][n] for n in e["parameters"] if isinstance(e["options"].get(n), Mapping)},
            )
            for e in data[of]
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
