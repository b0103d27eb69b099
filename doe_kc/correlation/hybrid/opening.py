"""The sample that a search starts from: a Latin hypercube about the first design."""

from __future__ import annotations

import numpy as np
from scipy.stats import qmc

from doe_kc.correlation.methods._base import Settings
from doe_kc.correlation.problem import Candidate
from doe_kc.variables import Space

FEWEST = 20
HALF_WIDTH = 0.25
"""Share of the bounds either way: most designs of the whole cube are far worse than the start."""


def opening_sample(space: Space, settings: Settings, known: int) -> list[Candidate]:
    """`first` designs less those known (by default a third of the variables, at least 20), on levels."""
    wanted = settings.first or max(FEWEST, space.dimension // 3)
    if wanted <= known:
        return []
    sampler = qmc.LatinHypercube(space.dimension, rng=np.random.default_rng(settings.seed))
    drawn = space.drawn(sampler.random(wanted - known))
    points = space.snapped(space.start + 2.0 * HALF_WIDTH * (drawn - space.start))
    return [Candidate(p, "opening sample") for p in points]
