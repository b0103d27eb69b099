"""The registry of surrogates."""

from __future__ import annotations

from typing import TypeVar

from doe_kc.ground.errors import InputError, nearest
from doe_kc.surrogate_models.interface import SurrogateModel

SURROGATES: dict[str, type[SurrogateModel]] = {}
Kind = TypeVar("Kind", bound=type[SurrogateModel])


def register(kind: Kind) -> Kind:
    """Register a surrogate; ValueError when the id is taken."""
    if kind.id in SURROGATES:
        raise ValueError(f"surrogate {kind.id} is registered twice")
    SURROGATES[kind.id] = kind
    return kind


def make(name: str, source: str = "surrogates") -> SurrogateModel:
    """The surrogate of that id with default options; InputError naming `source` when there is none."""
    if name not in SURROGATES:
        raise InputError(
            f"{source}: models: {name!r} is no surrogate; known are {', '.join(SURROGATES)}."
            f"{nearest(name, SURROGATES)}"
        )
    return SURROGATES[name]()
