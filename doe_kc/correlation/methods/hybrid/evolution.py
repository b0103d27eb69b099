"""Searches that look at ratings alone and so survive jumps: differential evolution and mutation."""

from __future__ import annotations

from typing import ClassVar, final

import numpy as np

from doe_kc.correlation.methods.hybrid.search import CandidateSearch, SearchTrial
from doe_kc.correlation.modelled.history import SearchHistory
from doe_kc.correlation.problem import Candidate
from doe_kc.ground.typing import FloatArray

POPULATION = 30
"""Best designs known, from which differential evolution begins: enough for differences in every direction
that the best ones span, few enough that poor ones do not lead."""
TOP_SHARE = 0.2
"""Share of the population that differential evolution moves towards."""
PROPOSAL_DRAWS = 5
"""Proposals among which the first is taken whose nearest evaluation did not fail."""
FIRST_SIGMA, SMALLEST_SIGMA, LARGEST_SIGMA = 0.05, 0.005, 0.3
SIGMA_GROWTH, SIGMA_SHRINKAGE = 1.5, 1.5**-0.25
"""Of the mutation's size after success and failure: constant at one success in five."""


@final
class DifferentialEvolution(CandidateSearch):
    """current-to-pbest/1/bin on the best designs of the record.

    Reference: J. Zhang, A. C. Sanderson, JADE, IEEE Trans. Evol. Comput. 13(5), 2009.
    """

    id: ClassVar[str] = "differential evolution"

    def propose(self, record: SearchHistory, rng: np.random.Generator) -> Candidate | None:
        """A trial vector; None with fewer than five sound designs."""
        if len(record.sound) < 5:
            return None
        population = np.array([e.point for e in record.ranked[:POPULATION]])
        point = self._trial(population, rng)
        for _ in range(PROPOSAL_DRAWS - 1):
            if not record.doubtful(point):
                break
            point = self._trial(population, rng)
        return Candidate(point, self.id)

    def _trial(self, population: FloatArray, rng: np.random.Generator) -> FloatArray:
        own, one, other = rng.choice(len(population), 3, replace=False)
        top = rng.integers(max(2, int(np.ceil(TOP_SHARE * len(population)))))
        scale = float(np.clip(0.5 + 0.1 * rng.standard_cauchy(), 0.1, 1.0))
        parent = population[own]
        mutant = parent + scale * (population[top] - parent + population[one] - population[other])
        mutant = np.where(mutant < 0.0, 0.5 * parent, mutant)
        mutant = np.where(mutant > 1.0, 0.5 * (parent + 1.0), mutant)
        crossed = rng.random(parent.size) < np.clip(rng.normal(0.5, 0.1), 0.0, 1.0)
        crossed[rng.integers(parent.size)] = True
        return np.asarray(np.where(crossed, mutant, parent))


@final
class Mutation(CandidateSearch):
    """The best design with some variables moved, by the one-fifth success rule.

    Reference: I. Rechenberg, Evolutionsstrategie, 1973.
    """

    id: ClassVar[str] = "mutation"

    def __init__(self) -> None:
        self._sigma = FIRST_SIGMA

    def propose(self, record: SearchHistory, rng: np.random.Generator) -> Candidate | None:
        """One to all variables of the best design moved, their number evenly drawn in its logarithm."""
        best = record.best.point
        count = int(np.ceil(best.size ** rng.random()))
        chosen = rng.choice(best.size, count, replace=False)
        point = best.copy()
        point[chosen] += self._sigma * rng.standard_normal(count)
        return Candidate(np.clip(point, 0.0, 1.0), self.id)

    def learn(self, trial: SearchTrial) -> None:
        """Larger moves after a success."""
        factor = SIGMA_GROWTH if trial.gain > 0.0 else SIGMA_SHRINKAGE
        self._sigma = float(np.clip(self._sigma * factor, SMALLEST_SIGMA, LARGEST_SIGMA))
