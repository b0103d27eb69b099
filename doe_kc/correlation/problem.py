"""The correlation problem: variables, targets, and how a design's answers are judged."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from doe_kc.axle.model import Axle
from doe_kc.correlation.least_squares import PRIOR_RIDGE, Prior
from doe_kc.correlation.likelihood import Likelihood
from doe_kc.correlation.linearization import Linearization, linearize, scaled_slopes
from doe_kc.correlation.twin import Twin
from doe_kc.ground.errors import RunError
from doe_kc.ground.typing import FloatArray
from doe_kc.targets import Rating, Score, Targets, rate, score
from doe_kc.true_solver.outcome import Outcome
from doe_kc.variables import Space

EXPANSION_CACHE = 4
"""Expansions that are kept, some 10 MB each."""


@dataclass(frozen=True)
class RatingForecast:
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
    predicted: RatingForecast | None = None


@dataclass(frozen=True)
class Evaluated:
    """A design with the true solver's answer. score, rating, searched: None after a failure.

    rating: of equation 2.2, by the problem's targets. searched: the same sum over the targets of the search.
    merit: what the search maximizes, -inf after a failure. scaled: (N,) curves of the search's targets as
    `Targets.scaled_curves`, empty without curve targets.
    """

    index: int
    candidate: Candidate
    outcome: Outcome
    score: Score | None
    rating: Rating | None
    searched: Rating | None
    merit: float
    scaled: FloatArray

    @property
    def feasible(self) -> bool:
        """Whether every constraint and limit of the search is met."""
        return self.searched is not None and self.searched.feasible

    @property
    def harmless(self) -> bool:
        """Whether every limit of the search is met: nothing that was measured is harmed."""
        return self.searched is not None and self.searched.harmless

    @property
    def point(self) -> FloatArray:
        """(d,) where it lies."""
        return self.candidate.point


@dataclass(frozen=True)
class Problem:
    """axle: the model that points are applied to. exact: whether its sensitivities can be had. twin: the
    package's own model beside that of an outside solver; None without one.

    targets: of the rating that is reported. sought: of the search; None where it works on the rating alone.
    ridge: of its prior.
    likelihood: records and typed targets as data with errors.
    """

    axle: Axle
    space: Space
    targets: Targets
    likelihood: Likelihood
    windows: Mapping[str, float]
    exact: bool
    sought: Targets | None = None
    ridge: float = PRIOR_RIDGE
    twin: Twin | None = None

    @property
    def has_slopes(self) -> bool:
        """Whether there are sensitivities: exact ones of the solver, or those of the twin."""
        return self.exact or self.twin is not None

    @property
    def search(self) -> Targets:
        """The targets that the search works on: same characteristics, the rating's curves first."""
        return self.targets if self.sought is None else self.sought

    @cached_property
    def prior(self) -> Prior:
        """What it costs to move variables away from where they start."""
        return Prior.of(self.space.start, self.space.prior_sd, self.ridge)

    def linearize(self, point: FloatArray) -> Linearization:
        """Exact first-order expansion at a point (d,), of the twin where the solver gives none.

        RunError without either, NotConverged where the model has no equilibrium.
        """
        if not self.has_slopes:
            raise RunError("the study's solver gives no sensitivities; choose a method that needs none.")
        key = point.tobytes()
        if key not in self._expansions:
            if self.twin is not None:
                self._expansions[key] = self.twin.linearize(self.space, point)
            else:
                self._expansions[key] = linearize(self.axle, self.space, point, self.windows)
            while len(self._expansions) > EXPANSION_CACHE:
                self._expansions.pop(next(iter(self._expansions)))
        return self._expansions[key]

    @cached_property
    def _expansions(self) -> dict[bytes, Linearization]:
        """The last ones: start and best design are asked for again and again."""
        return {}

    def output_slopes(self, point: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Slopes of the targets' characteristics (k, d) and of the scaled curves (N, d), see `linearize`."""
        expansion = self.linearize(point)
        rows = [scaled_slopes(t, expansion.curves) for t in self.search.curves]
        if self.search.misfit is not None:
            jacobian = self.likelihood.jacobian(expansion.curves, expansion.characteristics)
            rows.append(jacobian / np.sqrt(self.search.misfit.size))
        empty = np.zeros((0, self.space.dimension))
        return expansion.characteristics[self.search.rows], np.vstack([empty, *rows])

    def twin_answer(self, point: FloatArray) -> Evaluated:
        """What the twin says of a point (d,), judged as an answer of the solver; RunError without a twin."""
        if self.twin is None:
            raise RunError("the problem has no twin; ask the study's solver.")
        return self.judged(-1, Candidate(point, "twin"), self.twin.answer(self.space, point))

    def judged(self, index: int, candidate: Candidate, outcome: Outcome) -> Evaluated:
        """The candidate with its answer scored and rated; a response that is not finite is a failure."""
        if outcome.failed:
            return Evaluated(index, candidate, outcome, None, None, None, -np.inf, np.zeros(0))
        wide = score(self.search, outcome.characteristics, outcome.curves)
        own = replace(wide, rms=wide.rms[: len(self.targets.curves)])
        scaled = np.zeros(0) if outcome.curves is None else self.search.scaled_curves(outcome.curves)
        if self.search.misfit is not None:
            residual = self.likelihood.residual(outcome.curves, outcome.characteristics)
            scaled = np.concatenate([scaled, residual / np.sqrt(self.search.misfit.size)])
            wide = replace(wide, misfit=float(np.mean(residual**2)))
        rating = rate(self.targets, own)
        if self.sought is None:
            return Evaluated(index, candidate, outcome, own, rating, rating, rating.total, scaled)
        searched = rate(self.search, wide)
        merit = searched.total - float(self.prior.cost(candidate.point))
        return Evaluated(index, candidate, outcome, own, rating, searched, merit, scaled)
