"""What the methods share that open with a sample and go on from all answers so far."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Sequence

import numpy as np

from doe_kc.correlation.methods._base import Method, MethodSettings
from doe_kc.correlation.modelled.history import SearchHistory
from doe_kc.correlation.modelled.initial_design import InitialDesign
from doe_kc.correlation.problem import Candidate, Evaluated, Problem

BROAD = InitialDesign(fewest=20, variables_each=3, half_width=0.25)
"""For methods whose searches or models need designs on all sides; in the whole cube nearly all are far worse
than the start."""


class SurrogateMethod(Method):
    """State: all answers, the baseline first, and whether the opening sample was asked for.

    Randomness depends on seed and number of answers alone, so a resumed run goes on alike.
    """

    def __init__(self, problem: Problem, settings: MethodSettings, opening: InitialDesign = BROAD) -> None:
        self._problem, self._settings, self._opening = problem, settings, opening
        self._evaluated: list[Evaluated] = []
        self._opened = False

    def ask(self) -> Sequence[Candidate]:
        """The opening sample, less the designs known before, then rounds."""
        rng = np.random.default_rng([self._settings.seed, len(self._evaluated)])
        missing = self._missing()
        if missing > 0:
            seed = int(rng.integers(2**31)) if self._opened else self._settings.seed
            self._opened = True
            return self._opening_designs(missing, seed)
        self._opened = True
        return self._round(rng)

    def _opening_designs(self, count: int, seed: int) -> Sequence[Candidate]:
        """The designs that a search learns from before it proposes."""
        return self._opening.sample(self._problem.space, count, seed)

    def tell(self, evaluated: Sequence[Evaluated]) -> None:
        """Answers, failures among them."""
        self._evaluated.extend(evaluated)

    def _missing(self) -> int:
        """Designs that the opening sample still lacks."""
        if self._opened:
            return 0
        return self._opening.size(self._problem.space, self._settings.first) - (len(self._evaluated) - 1)

    @property
    def _record(self) -> SearchHistory:
        """The answers as searches and models see them."""
        return SearchHistory(self._problem, self._evaluated, seed=self._settings.seed)

    @abstractmethod
    def _round(self, rng: np.random.Generator) -> Sequence[Candidate]:
        """The candidates after the opening sample."""
