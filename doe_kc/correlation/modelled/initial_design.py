"""The opening sample: a Latin hypercube about the first design, where a search learns before it begins."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from doe_kc.correlation.modelled.proposal import level_steps
from doe_kc.correlation.problem import Candidate
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
        from scipy.stats import qmc  # half a second that searches without a sample need not wait for

        sampler = qmc.LatinHypercube(
            space.dimension,
            rng=np.random.default_rng(seed),
            optimization="random-cd" if self.evened else None,
        )
        drawn = space.drawn(sampler.random(n))
        half_width = np.clip(level_steps(space), self.half_width, 0.5)
        points = space.snapped(space.start + 2.0 * half_width * (drawn - space.start))
        return [Candidate(p, "opening sample") for p in points]
