"""Searches on models of the outputs: trust regions about the best design, and restarts away from it."""

from __future__ import annotations

from abc import abstractmethod
from typing import ClassVar, final

import numpy as np

from doe_kc.correlation.ego.proposal import TrustBox
from doe_kc.correlation.hybrid.linear_model import linear_model
from doe_kc.correlation.hybrid.output_model import best_predicted, prediction
from doe_kc.correlation.hybrid.record import SearchHistory
from doe_kc.correlation.hybrid.search import CandidateSearch, SearchTrial
from doe_kc.correlation.problem import Candidate
from doe_kc.ground.typing import FloatArray
from doe_kc.surrogates.interface import Fitted
from doe_kc.surrogates.training import constant_outputs

HYBRID_FIRST_RADIUS, HYBRID_LARGEST_RADIUS, HYBRID_SMALLEST_RADIUS = 0.2, 0.5, 0.01
HYBRID_SHRINKAGE, HYBRID_GROWTH = 0.5, 1.6
HYBRID_POOR_RATIO, HYBRID_GOOD_RATIO = 0.1, 0.7
"""Actual over predicted gain below which the region shrinks, above which it grows."""
MODEL_DESIGNS = 5
"""Sound designs below which nothing is modelled."""
MODEL_DRAWS = 20


def can_model(record: SearchHistory) -> bool:
    """Whether there are enough designs, and outputs that change between them."""
    return len(record.sound) >= MODEL_DESIGNS and not constant_outputs(record.archive.outputs).all()


def proposed(
    record: SearchHistory, model: Fitted, box: TrustBox, first: FloatArray, origin: str
) -> Candidate:
    """The best rating that a model predicts in the box."""
    point = best_predicted(record.problem, model, record.archive.composite, box, first)
    return Candidate(point, origin, prediction(record.problem, record.archive, model, point))


class TrustRegion(CandidateSearch):
    """The best rating that a model predicts within a box about the best design."""

    def __init__(self) -> None:
        self._radius, self._asked = HYBRID_FIRST_RADIUS, 0

    def propose(self, record: SearchHistory, rng: np.random.Generator) -> Candidate | None:
        """A second one of the same round stays in half the box."""
        if not can_model(record):
            return None
        centre = record.best.point
        box = TrustBox.around(
            centre, max(self._radius * HYBRID_SHRINKAGE**self._asked, HYBRID_SMALLEST_RADIUS)
        )
        self._asked += 1
        return proposed(record, self._model(record), box, centre, self.id)

    def learn(self, trial: SearchTrial) -> None:
        """Shrink after a failure or a broken promise, grow after a kept one, start anew from nothing."""
        self._asked = 0
        predicted = trial.answer.candidate.predicted
        promised = predicted.rating - trial.before if predicted is not None else 0.0
        ratio = trial.gain / promised if promised > 0.0 else 0.0
        if ratio < HYBRID_POOR_RATIO:
            self._radius *= HYBRID_SHRINKAGE
        elif ratio > HYBRID_GOOD_RATIO:
            self._radius = min(HYBRID_LARGEST_RADIUS, self._radius * HYBRID_GROWTH)
        if self._radius < HYBRID_SMALLEST_RADIUS:
            self._radius = HYBRID_FIRST_RADIUS

    @abstractmethod
    def _model(self, record: SearchHistory) -> Fitted: ...


@final
class LinearSearch(TrustRegion):
    """Derivative-free Gauss-Newton: a linear model of every output about the best design."""

    id: ClassVar[str] = "linear model"

    def _model(self, record: SearchHistory) -> Fitted:
        return linear_model(record.best.point, record.archive.points, record.archive.outputs)


@final
class SurrogateSearch(TrustRegion):
    """Gaussian processes of every output."""

    id: ClassVar[str] = "surrogate"

    def _model(self, record: SearchHistory) -> Fitted:
        return record.model


@final
class Restart(CandidateSearch):
    """A random design far from all known ones, improved on the surrogates in its surroundings."""

    id: ClassVar[str] = "restart"

    def propose(self, record: SearchHistory, rng: np.random.Generator) -> Candidate | None:
        """The farthest of twenty draws; as drawn while nothing can be modelled."""
        space = record.problem.space
        drawn = space.drawn(rng.random((MODEL_DRAWS, space.dimension)))
        known = np.array([e.point for e in record.evaluated])
        apart = np.linalg.norm(drawn[:, None] - known[None], axis=2).min(axis=1)
        far = drawn[int(np.argmax(apart))]
        if not can_model(record):
            return Candidate(far, self.id)
        return proposed(record, record.model, TrustBox.around(far, HYBRID_FIRST_RADIUS), far, self.id)
