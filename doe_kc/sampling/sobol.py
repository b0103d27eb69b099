"""Scrambled Sobol sequence: low discrepancy for any number of designs.

References: I. M. Sobol, USSR Comput. Math. Math. Phys. 7(4), 1967; scrambling: A. B. Owen, J. Complexity
14(4), 1998; direction numbers: S. Joe, F. Y. Kuo, SIAM J. Sci. Comput. 30(5), 2008.
"""

from __future__ import annotations

from typing import ClassVar

import numpy as np

from doe_kc.sampling._base import Request, Sampler, design_of, numbered, sampler
from doe_kc.sampling.design import Design
from doe_kc.variables import Space


@sampler
class Sobol(Sampler):
    """The first n points of the sequence; best balanced when n is a power of two. The first 100 of 200
    designs with the same seed are those of 100."""

    id: ClassVar[str] = "sobol"

    def sample(self, space: Space, request: Request) -> Design:
        from scipy.stats import qmc  # half a second that other commands need not wait for

        engine = qmc.Sobol(d=space.dimension, scramble=True, rng=np.random.default_rng(request.seed))
        sequence = engine.random_base2(max(0, request.n - 1).bit_length())[: request.n]
        points = space.snapped(space.drawn(sequence))
        return design_of(self.id, space, points, numbered(request.n), request.seed)
