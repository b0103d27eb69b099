"""The contract of a sampler: a space and a number in, a design out."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import ClassVar

import numpy as np

from doe_kc.ground.errors import InputError, nearest
from doe_kc.ground.typing import FloatArray
from doe_kc.sampling.design import Design
from doe_kc.variables import Space


@dataclass(frozen=True, kw_only=True)
class Request:
    """n: designs wanted; levels: of each variable in a full factorial; table: file of designs.

    existing: (k, d) designs in the unit cube that the n new ones shall complete.
    """

    n: int
    seed: int
    levels: int = 3
    table: Path | None = None
    existing: FloatArray | None = None


class Sampler(ABC):
    """Every variable stays inside its bounds and, where the method chooses the values, on its levels.

    sized: whether n decides the number of designs. seeded: whether the seed decides the values. extends:
    whether it completes existing designs.
    """

    id: ClassVar[str]
    sized: ClassVar[bool] = True
    seeded: ClassVar[bool] = True
    extends: ClassVar[bool] = False

    @abstractmethod
    def sample(self, space: Space, request: Request) -> Design:
        """The designs; InputError when the space or the request does not suit the method."""


SAMPLERS: dict[str, Sampler] = {}


def sampler(cls: type[Sampler]) -> type[Sampler]:
    """Class decorator: register a sampler; ValueError when the id is taken."""
    if cls.id in SAMPLERS:
        raise ValueError(f"sampler {cls.id} is registered twice")
    SAMPLERS[cls.id] = cls()
    return cls


def find_sampler(method: str, source: str) -> Sampler:
    """The sampler of an id; InputError naming `source` for an unknown one."""
    if method not in SAMPLERS:
        raise InputError(
            f"{source}: {method!r} is no sampling method; known are {', '.join(SAMPLERS)}."
            f"{nearest(method, SAMPLERS)}"
        )
    return SAMPLERS[method]


def design_of(
    method: str, space: Space, points: FloatArray, labels: Sequence[str], seed: int | None = None
) -> Design:
    """Design of points (n, d) in the unit cube: variables, tied and fixed parameters, absolute."""
    rows = [space.values(point) for point in points]
    return Design(method, tuple(rows[0]), np.array([list(row.values()) for row in rows]), tuple(labels), seed)


def numbered(n: int, before: int = 0) -> list[str]:
    """Labels of designs that have no meaning of their own, counted on from `before`."""
    return [f"sample {before + i + 1}" for i in range(n)]
