"""What a search of the hybrid is: it proposes one design from the shared record and learns from trials."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from doe_kc.correlation.hybrid.record import SearchHistory
from doe_kc.correlation.problem import Candidate, Evaluated


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
