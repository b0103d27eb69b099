"""The opening sample: a Latin hypercube about the first design, where a search learns before it begins."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from doe_kc.correlation.modelled.proposal import level_steps
from doe_kc.correlation.modelled.unit_samples import latin_hypercube
from doe_kc.correlation.problem import Candidate
from doe_kc.ground.typing import FloatArray
from doe_kc.variables import Space


@dataclass(frozen=True, kw_only=True)
class InitialDesign:
    """How a method opens.

    variables_each: one design for so many variables, `fewest` at least; None: `fewest` always. half_width:
    share of the bounds either way. evened: columns are permuted for the least centred discrepancy, so that
    also few designs fill the box.
    """

    fewest: int
    variables_each: int | None
    half_width: float
    evened: bool = False

    def size(self, space: Space, first: int | None = None) -> int:
        """Number of designs; first: the user's own."""
        if first is not None:
            return first
        return max(self.fewest, space.dimension // self.variables_each if self.variables_each else 0)

    def sample(self, space: Space, n: int, seed: int) -> list[Candidate]:
        """n designs on the levels, every variable by its distribution.

        The bounds are drawn in towards the start, but to a level beside it at least: none of them is passed,
        and a start beside its bound has as many designs as another.
        """
        drawn = space.drawn((_evened if self.evened else latin_hypercube)(n, space.dimension, seed))
        half_width = np.clip(level_steps(space), self.half_width, 0.5)
        points = space.snapped(space.start + 2.0 * half_width * (drawn - space.start))
        return [Candidate(p, "opening sample") for p in points]


def _evened(n: int, dimension: int, seed: int) -> FloatArray:
    if n == 1:  # nothing to even out
        return latin_hypercube(n, dimension, seed)
    from scipy.stats import qmc  # takes half a second

    engine = qmc.LatinHypercube(dimension, rng=np.random.default_rng(seed), optimization="random-cd")
    return np.asarray(engine.random(n))
