"""Searches on models of the outputs: trust regions about the best design, and restarts away from it.

The linear model of every output about one design is a weighted ridge regression through it: near evaluations
count, and few of them suffice (the interpolation of least norm), as in derivative-free Gauss-Newton methods
(C. Cartis, L. Roberts, A derivative-free Gauss-Newton method, Math. Program. Comput. 11, 2019).
"""

from __future__ import annotations

from abc import abstractmethod
from typing import ClassVar, final

import numpy as np

from doe_kc.correlation.methods.hybrid.search import CandidateSearch, SearchTrial
from doe_kc.correlation.modelled.history import SearchHistory
from doe_kc.correlation.modelled.linear_model import LinearModel
from doe_kc.correlation.modelled.proposal import best_predicted, forecast
from doe_kc.correlation.modelled.trust_region import RadiusRule, TrustBox, TrustRegion
from doe_kc.correlation.problem import Candidate
from doe_kc.ground.typing import FloatArray
from doe_kc.surrogate_models.interface import Fitted

STEP_RIDGE = 1e-6
"""Share of the mean square of the steps: below what one level changes."""


def linear_model(centre: FloatArray, x: FloatArray, y: FloatArray) -> LinearModel:
    """centre: (d,), one of the designs x (n, d). y: (n, m) their outputs.

    A design at the distance of the d-th nearest has the weight exp(-1/2); the variance is that of the
    weighted residuals.
    """
    step = x - centre
    apart = np.linalg.norm(step, axis=1)
    value = y[int(np.argmin(apart))]
    width = np.sort(apart)[min(len(x) - 1, x.shape[1])]
    weight = np.exp(-0.5 * (apart / max(float(width), 1e-12)) ** 2)
    slope = weighted_slope(step, y - value, weight)
    residual = y - value - step @ slope.T
    return LinearModel(centre, value, slope, weight @ residual**2 / weight.sum(), residual)


def weighted_slope(step: FloatArray, change: FloatArray, weight: FloatArray) -> FloatArray:
    """(m, d) J of least sum of w |step J' - change|^2 + ridge |J|^2; step (n, d), change (n, m)."""
    normal = step.T @ (weight[:, None] * step)
    ridge = STEP_RIDGE * max(float(np.trace(normal)) / len(normal), 1e-12)
    right = step.T @ (weight[:, None] * change)
    return np.asarray(np.linalg.solve(normal + ridge * np.eye(len(normal)), right).T)


HYBRID_RADIUS = RadiusRule(
    first=0.2, smallest=0.01, largest=0.5, shrinkage=0.5, growth=1.6, poor=0.1, good=0.7, floor="restart"
)
MODEL_DRAWS = 20
"""Random designs, of which the one farthest from all known ones is taken: distances cost no evaluation."""


def proposed(
    record: SearchHistory, model: Fitted, box: TrustBox, first: FloatArray, origin: str
) -> Candidate:
    """The best rating that a model predicts in the box."""
    point = best_predicted(record.problem, model, record.archive.composite, box, first)
    return Candidate(point, origin, forecast(record.problem, record.archive, model, point))


class ModelSearch(CandidateSearch):
    """The best rating that a model predicts within a trust region about the best design."""

    def __init__(self) -> None:
        self._region, self._asked = TrustRegion.first(HYBRID_RADIUS), 0

    def propose(self, record: SearchHistory, rng: np.random.Generator) -> Candidate | None:
        """A second one of the same round stays in half the box."""
        if not record.can_model:
            return None
        centre = record.best.point
        box = self._region.box(centre, shrunk=self._asked)
        self._asked += 1
        return proposed(record, self._model(record), box, centre, self.id)

    def learn(self, trial: SearchTrial) -> None:
        """Shrink after a failure or a broken promise, grow after a kept one, start anew from nothing."""
        self._asked = 0
        predicted = trial.answer.candidate.predicted
        promised = predicted.rating - trial.before if predicted is not None else 0.0
        self._region = self._region.after(trial.gain / promised if promised > 0.0 else 0.0)

    @abstractmethod
    def _model(self, record: SearchHistory) -> Fitted: ...


@final
class LinearSearch(ModelSearch):
    """Derivative-free Gauss-Newton: a linear model of every output about the best design."""

    id: ClassVar[str] = "linear model"

    def _model(self, record: SearchHistory) -> Fitted:
        return linear_model(record.best.point, record.archive.points, record.archive.outputs)


@final
class SurrogateSearch(ModelSearch):
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
        if not record.can_model:
            return Candidate(far, self.id)
        return proposed(record, record.model, TrustRegion.first(HYBRID_RADIUS).box(far), far, self.id)
