"""What a search of the hybrid is, and how the budget is shared between searches by what they gained of late.

Probability matching with a least probability (D. Thierens, An adaptive pursuit strategy for allocating
operator probabilities, GECCO 2005): each search has a quality, the running mean of its rewards.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from doe_kc.correlation.modelled.history import SearchHistory
from doe_kc.correlation.problem import Candidate, Evaluated
from doe_kc.ground.typing import FloatArray

LEAST_CREDIT = 0.05
"""Probability that every search keeps."""
CREDIT_RATE = 0.4
"""Weight of the last reward in the running mean."""
FULL = 0.03
"""Gain, share of the best rating's size, that earns the full reward."""
HOPE = 0.01
"""Quality of a search that gains nothing: when none does, all are tried alike."""


@dataclass(frozen=True)
class SearchTrial:
    """A proposal with its answer. before: the best rating when it was proposed."""

    answer: Evaluated
    before: float

    @property
    def gain(self) -> float:
        """By how much it beats the best rating, negative when it does not, -inf after a failure."""
        return self.answer.merit - self.before


class CandidateSearch(ABC):
    """One way of looking for better designs. id: origin of its candidates."""

    id: ClassVar[str]

    @abstractmethod
    def propose(self, record: SearchHistory, rng: np.random.Generator) -> Candidate | None:
        """A design, not yet on levels; None while the record holds too little for this search."""

    def learn(self, trial: SearchTrial) -> None:  # noqa: B027 - most searches keep no state
        """Adapt to the answer of an own proposal."""


class Credit:
    """Qualities of n searches, all 1 at first."""

    def __init__(self, searches: int) -> None:
        self._quality = np.ones(searches)

    @property
    def probability(self) -> FloatArray:
        """(n,) of being asked next."""
        quality = self._quality + HOPE
        count = quality.size
        return np.asarray(LEAST_CREDIT + (1.0 - count * LEAST_CREDIT) * quality / quality.sum())

    def reward(self, search: int, trial: SearchTrial) -> None:
        """Move a search's quality towards the reward of a trial."""
        self._quality[search] += CREDIT_RATE * (reward(trial) - self._quality[search])


def reward(trial: SearchTrial) -> float:
    """0 without a gain, 1 from 3 % of the best rating on."""
    size = FULL * max(abs(trial.before), 1e-12)
    return float(np.clip(trial.gain / size, 0.0, 1.0)) if np.isfinite(trial.gain) else 0.0
