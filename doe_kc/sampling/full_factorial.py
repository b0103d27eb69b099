"""Full factorial: every combination of a few levels of every variable; for few variables."""

from __future__ import annotations

from itertools import product
from typing import ClassVar

import numpy as np

from doe_kc.ground.errors import InputError
from doe_kc.ground.typing import FloatArray
from doe_kc.sampling._base import Request, Sampler, design_of, numbered, sampler
from doe_kc.sampling.design import Design
from doe_kc.variables import Space

DESIGNS_MOST = 20_000
"""Designs; some minutes of the own solver."""


@sampler
class FullFactorial(Sampler):
    """Levels even between the bounds, both bounds among them; the last variable changes fastest.

    A variable that has fewer levels of its own takes those.
    """

    id: ClassVar[str] = "full_factorial"
    sized: ClassVar[bool] = False
    seeded: ClassVar[bool] = False

    def sample(self, space: Space, request: Request) -> Design:
        columns = level_columns(space, request.levels)
        count = np.prod([float(len(c)) for c in columns])
        if count > DESIGNS_MOST:
            raise InputError(
                f"sampling: a full factorial of {space.dimension} variables with {request.levels} levels "
                f"has {count:.6g} designs, more than {DESIGNS_MOST}; take fewer variables or levels, or "
                "another method such as lhs."
            )
        points = np.array(list(product(*columns)))
        return design_of(self.id, space, points, numbered(len(points)))


def level_columns(space: Space, levels: int) -> list[FloatArray]:
    """Levels of each variable in [0, 1], on its own levels, none twice."""
    grid = np.linspace(0.0, 1.0, levels)
    points = space.snapped(np.repeat(grid[:, None], space.dimension, axis=1))
    return [np.unique(points[:, i]) for i in range(space.dimension)]
