"""Latin hypercube: every variable's range in n equally probable slices, each hit once, the points kept apart.

Reference: M. D. McKay, R. J. Beckman, W. J. Conover, Technometrics 21(2), 1979; criterion: `maximin.py`.
"""

from __future__ import annotations

from typing import ClassVar

import numpy as np

from doe_kc.ground.typing import FloatArray
from doe_kc.sampling._base import Request, Sampler, design_of, numbered, sampler
from doe_kc.sampling.design import Design
from doe_kc.sampling.maximin import more_slices, spread_hypercube
from doe_kc.variables import Space

SPREAD_UP_TO = 1000
"""Designs up to which their smallest distance is maximised: 5 s at 400 designs of 72 variables, less
below."""
PROBABILITIES = np.linspace(0.0, 1.0, 4001)
"""Between which a distribution is inverted: a slice of 1000 is four of them wide."""


@sampler
class LatinHypercube(Sampler):
    """One value in each slice; exact before the values are moved to their levels.

    Existing designs keep their places: new ones go where slices of the grown hypercube are empty, far from
    all.
    """

    id: ClassVar[str] = "lhs"
    extends: ClassVar[bool] = True

    def sample(self, space: Space, request: Request) -> Design:
        rng = np.random.default_rng(request.seed)
        known = np.zeros((0, space.dimension))
        if request.existing is not None:
            known = probabilities(space, request.existing)
        places = np.vstack([known, more_slices(known, request.n, rng)])
        if len(places) <= SPREAD_UP_TO:
            places = spread_hypercube(places, rng, fixed=len(known))
        points = space.snapped(space.drawn(places[len(known) :]))
        return design_of(self.id, space, points, numbered(request.n, len(known)), request.seed)


def probabilities(space: Space, points: FloatArray) -> FloatArray:
    """(n, d) cumulative probabilities of points of the unit cube, inverse of `Space.drawn`."""
    inside = np.clip(PROBABILITIES, 1e-9, 1.0 - 1e-9)
    drawn = space.drawn(np.repeat(inside[:, None], space.dimension, axis=1))
    columns = [np.interp(u, at, PROBABILITIES) for u, at in zip(points.T, drawn.T, strict=True)]
    return np.stack(columns, axis=1)
