"""One round of proposals: surrogates of the archive's outputs, and the candidate that a strategy asks for."""

from __future__ import annotations

from collections.abc import Set
from dataclasses import dataclass, replace

import numpy as np

from doe_kc.correlation.methods.ego.improvement import ExpectedImprovement
from doe_kc.correlation.methods.ego.strategy import AVERSION, ProposalKind, Strategy
from doe_kc.correlation.modelled.archive import Archive
from doe_kc.correlation.modelled.maximizer import gauss_newton
from doe_kc.correlation.modelled.output_model import best_predicted, fit_outputs, forecast, levelled
from doe_kc.correlation.modelled.trust_region import TrustBox
from doe_kc.correlation.problem import Candidate, Problem, RatingForecast
from doe_kc.ground.typing import FloatArray
from doe_kc.surrogates.interface import Fitted

HALF_WIDTH = 0.3
"""Of the box about the best design in which proposals lie."""
AWAY = 2
"""Random starts of the search for the expected improvement, beside the Gauss-Newton proposal."""
SCATTERED = 256
"""Random points among which a restart finds its place."""


@dataclass(frozen=True)
class Proposer:
    """model: of the archive's outputs. doubt: factor of its predicted variances."""

    problem: Problem
    archive: Archive
    model: Fitted
    doubt: float

    def candidate(
        self,
        strategy: Strategy,
        kind: ProposalKind,
        taken: Set[bytes],
        rng: np.random.Generator,
        *,
        anywhere: bool,
    ) -> Candidate | None:
        """By `kind`, or the next kind whose design is not known already.

        anywhere: a random design about the best at the last, else None.
        """
        snapped = self.problem.space.snapped
        for origin in (kind, *strategy.others()):
            point = snapped(self._point(origin, strategy, rng))
            if point.tobytes() not in taken:
                return Candidate(point, origin, self.predict(point))
        if not anywhere:
            return None
        box = TrustBox.around(self.archive.best.point, HALF_WIDTH)
        point = snapped(rng.uniform(box.lower, box.upper))
        return Candidate(point, "random", self.predict(point))

    def believing(self, point: FloatArray) -> Proposer:
        """With a candidate's predicted outputs taken for true (Kriging believer), for the rest of a batch."""
        archive = replace(
            self.archive,
            points=np.vstack([self.archive.points, point]),
            outputs=np.vstack([self.archive.outputs, self.model.predict(point[None])]),
        )
        return replace(self, archive=archive, model=fit_outputs(archive))

    def predict(self, point: FloatArray) -> RatingForecast:
        """Characteristics and expected rating at a point, with their standard deviations."""
        return forecast(self.problem, self.archive, self.model, point, doubt=self.doubt)

    def _point(self, kind: ProposalKind, strategy: Strategy, rng: np.random.Generator) -> FloatArray:
        best = self.archive.best.point
        if kind == "Gauss-Newton":
            return self._exploited(best, TrustBox.around(best, HALF_WIDTH), strategy.aversion)
        if kind == "trust region":
            return self._exploited(best, strategy.region.box(best), AVERSION[0])
        if kind == "restart":
            away = self._elsewhere(rng)
            return self._exploited(away, TrustBox.around(away, HALF_WIDTH), AVERSION[1])
        return self._explored(rng)

    def _exploited(self, first: FloatArray, box: TrustBox, aversion: float) -> FloatArray:
        composite, best = self.archive.composite, self.archive.best.point
        doubt = aversion * self.doubt
        return best_predicted(self.problem, self.model, composite, box, first, start=best, doubt=doubt)

    def _explored(self, rng: np.random.Generator) -> FloatArray:
        best, composite = self.archive.best, self.archive.composite
        box = TrustBox.around(best.point, HALF_WIDTH)
        search = ExpectedImprovement(
            self.model,
            composite,
            best.merit if best.searched is None else best.searched.total,
            self.archive.failed,
            seed=int(rng.integers(2**31)),
            doubt=self.doubt,
        )
        near = gauss_newton(self.model, composite, box, best.point, self.problem.prior, doubt=self.doubt)
        away = rng.uniform(box.lower, box.upper, (AWAY, self.problem.space.dimension))
        point = search.maximum(box, [near, *away])
        return levelled(self.problem, self.model, composite, point, best.point, doubt=self.doubt)

    def _elsewhere(self, rng: np.random.Generator) -> FloatArray:
        """Of random points the one farthest from all designs so far."""
        points = rng.uniform(0.0, 1.0, (SCATTERED, self.problem.space.dimension))
        apart = ((points[:, None] - self.archive.points[None]) ** 2).sum(axis=2).min(axis=1)
        return np.asarray(points[int(np.argmax(apart))])
