"""The correlation problem: variables, targets, and how a design's answers are judged."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from doe_kc.axle.model import Axle
from doe_kc.correlation.likelihood import Likelihood
from doe_kc.correlation.linearization import Linearization, linearize, scaled_slopes
from doe_kc.errors import RunError
from doe_kc.targets import Rating, Score, Targets, rate, score
from doe_kc.true_solver.outcome import Outcome
from doe_kc.typing import FloatArray
from doe_kc.variables import Space


@dataclass(frozen=True)
class Prediction:
    """What a method expected of a candidate. values, sd: (k,) of the targets' characteristics."""

    values: FloatArray
    sd: FloatArray
    rating: float
    rating_sd: float


@dataclass(frozen=True)
class Candidate:
    """A design to confirm by the true solver. point: (d,). origin: what proposed it."""

    point: FloatArray
    origin: str
    predicted: Prediction | None = None


@dataclass(frozen=True)
class Evaluated:
    """A design with the true solver's answer. score, rating: None after a failure.

    scaled: (N,) curves as `Targets.scaled_curves`, empty without curve targets.
    """

    index: int
    candidate: Candidate
    outcome: Outcome
    score: Score | None
    rating: Rating | None
    scaled: FloatArray

    @property
    def merit(self) -> float:
        """The rating, -inf after a failure."""
        return self.rating.total if self.rating is not None else -np.inf

    @property
    def point(self) -> FloatArray:
        """(d,) where it lies."""
        return self.candidate.point


@dataclass(frozen=True)
class Problem:
    """axle: the model that points are applied to. exact: whether its sensitivities can be had.

    likelihood: records and typed targets as data with errors.
    """

    axle: Axle
    space: Space
    targets: Targets
    likelihood: Likelihood
    windows: Mapping[str, float]
    exact: bool

    def linearize(self, point: FloatArray) -> Linearization:
        """Exact first-order expansion at a point (d,); RunError for a solver that gives none."""
        if not self.exact:
            raise RunError("the study's solver gives no sensitivities; choose a method that needs none.")
        return linearize(self.axle, self.space, point, self.windows)

    def output_slopes(self, point: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Exact slopes of the targets' characteristics (k, d) and of the scaled curves (N, d)."""
        expansion = self.linearize(point)
        rows = [scaled_slopes(t, expansion.curves) for t in self.targets.curves]
        empty = np.zeros((0, self.space.dimension))
        return expansion.characteristics[self.targets.rows], np.vstack([empty, *rows])

    def judged(self, index: int, candidate: Candidate, outcome: Outcome) -> Evaluated:
        """The candidate with its answer scored and rated; a response that is not finite is a failure."""
        if outcome.failed:
            return Evaluated(index, candidate, outcome, None, None, np.zeros(0))
        found = score(self.targets, outcome.characteristics, outcome.curves)
        scaled = np.zeros(0) if outcome.curves is None else self.targets.scaled_curves(outcome.curves)
        return Evaluated(index, candidate, outcome, found, rate(self.targets, found), scaled)
