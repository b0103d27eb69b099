"""The opening sample: where the surrogates learn before the search begins."""

from __future__ import annotations

import numpy as np
from scipy.stats import qmc

from doe_kc.typing import FloatArray
from doe_kc.variables import Space

FEWEST = 8
WITH_GRADIENTS = 4
SHARE = 9
"""Variables per design of the opening sample: the proposals teach more than further samples would."""
HALF_WIDTH = 0.1
"""About the start, share of the bounds: near enough for the first slopes to hold where the search goes."""


def opening_size(space: Space, first: int | None, *, gradients: bool) -> int:
    """Designs of the opening sample: `first`, or a ninth of the variables, at least 8; 4 with gradients."""
    if first is not None:
        return first
    return WITH_GRADIENTS if gradients else max(FEWEST, space.dimension // SHARE)


def opening_sample(space: Space, n: int, seed: int) -> FloatArray:
    """(n, d) Latin hypercube about the start on the levels, every variable by its distribution."""
    sampler = qmc.LatinHypercube(space.dimension, rng=np.random.default_rng(seed), optimization="random-cd")
    drawn = space.drawn(sampler.random(n))
    return space.snapped(space.start + 2.0 * HALF_WIDTH * (drawn - 0.5))
