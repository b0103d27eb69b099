"""`hybrid`: several searches at once on one archive, for solvers that fail or jump.

Differential evolution and mutation look at ratings alone; trust regions on a linear model and on Gaussian
processes, and restarts, look at every output. Who gained of late is asked more often (`search.py`). The idea
of simultaneous hybrid search is the thesis's, section 2.3; nothing here is taken from that product.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar, final

import numpy as np

from doe_kc.correlation.methods._base import MethodSettings, register
from doe_kc.correlation.methods._sampled import SurrogateMethod
from doe_kc.correlation.methods.hybrid.evolution import DifferentialEvolution, Mutation
from doe_kc.correlation.methods.hybrid.model_searches import LinearSearch, Restart, SurrogateSearch
from doe_kc.correlation.methods.hybrid.search import CandidateSearch, Credit, SearchTrial
from doe_kc.correlation.modelled.history import SearchHistory
from doe_kc.correlation.problem import Candidate, Evaluated, Problem

HYBRID_PROGRESS = 0.001
"""Gain, share of the rating's size, that counts as progress."""
HYBRID_PATIENCE = 60
"""Designs without progress, or as many as there are variables, that end the search."""


@final
@register
class Hybrid(SurrogateMethod):
    """State: beside the answers the searches with their credit, and who proposed the last candidates."""

    id: ClassVar[str] = "hybrid"
    label: ClassVar[str] = "Simultaneous global and local searches"

    def __init__(self, problem: Problem, settings: MethodSettings) -> None:
        super().__init__(problem, settings)
        self._searches: tuple[CandidateSearch, ...] = (
            SurrogateSearch(),
            LinearSearch(),
            DifferentialEvolution(),
            Mutation(),
            Restart(),
        )
        self._credit = Credit(len(self._searches))
        self._asked: list[int] = []
        self._idle = 0

    @property
    def stopped(self) -> str:
        """No search has gained for long."""
        if self._idle < max(HYBRID_PATIENCE, self._problem.space.dimension):
            return ""
        return f"no search gained {100 * HYBRID_PROGRESS:g} % of the rating in the last {self._idle} designs"

    def tell(self, evaluated: Sequence[Evaluated]) -> None:
        """Answers; searches and their credit learn from their own."""
        before = max((e.merit for e in self._evaluated if np.isfinite(e.merit)), default=-np.inf)
        super().tell(evaluated)
        for place, answer in zip(self._asked, evaluated, strict=False):
            trial = SearchTrial(answer, before)
            self._credit.reward(place, trial)
            self._searches[place].learn(trial)
        gain = max((e.merit for e in evaluated if np.isfinite(e.merit)), default=-np.inf) - before
        progress = not self._asked or gain > HYBRID_PROGRESS * abs(before)
        self._idle = 0 if progress else self._idle + len(evaluated)

    def _round(self, rng: np.random.Generator) -> list[Candidate]:
        """`batch` candidates, each from a search drawn by credit."""
        self._asked = []
        record, out = self._record, list[Candidate]()
        for _ in range(self._settings.batch):
            place = int(rng.choice(len(self._searches), p=self._credit.probability))
            out.append(self._proposed(place, record, out, rng))
        return out

    def _proposed(
        self, place: int, record: SearchHistory, out: Sequence[Candidate], rng: np.random.Generator
    ) -> Candidate:
        """The search's candidate, or a mutation when it has none, moved off designs that are known."""
        proposal = self._searches[place].propose(record, rng)
        if proposal is None:
            place = next(i for i, s in enumerate(self._searches) if isinstance(s, Mutation))
            proposal = self._searches[place].propose(record, rng)
        if proposal is None:
            raise ValueError("mutation needs no more than the baseline")
        self._asked.append(place)
        point = record.fresh(proposal.point, [c.point for c in out], rng)
        predicted = proposal.predicted if np.array_equal(point, proposal.point) else None
        return Candidate(point, proposal.origin, predicted)
