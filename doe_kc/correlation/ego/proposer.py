"""One round of proposals: surrogates of the archive's outputs, and the candidate that a strategy asks for."""

from __future__ import annotations

from collections.abc import Set
from dataclasses import dataclass, replace

import numpy as np

from doe_kc.correlation.ego.archive import Archive
from doe_kc.correlation.ego.improvement import ExpectedImprovement
from doe_kc.correlation.ego.levels import on_levels
from doe_kc.correlation.ego.proposal import TrustBox, gauss_newton
from doe_kc.correlation.ego.strategy import AVERSION, Kind, Strategy
from doe_kc.correlation.prior import Prior
from doe_kc.correlation.problem import Candidate, RatingForecast
from doe_kc.ground.typing import FloatArray
from doe_kc.surrogates.interface import Fitted
from doe_kc.surrogates.models.gp import FirstOrderTrend, GaussianProcess
from doe_kc.surrogates.training import constant_outputs
from doe_kc.surrogates.varying import fit_varying
from doe_kc.variables import Space

HALF_WIDTH = 0.3
"""Of the box about the best design in which proposals lie."""
AWAY = 2
"""Random starts of the search for the expected improvement, beside the Gauss-Newton proposal."""
IMPROVEMENT_DRAWS = 64
SCATTERED = 256
"""Random points among which a restart finds its place."""


@dataclass(frozen=True)
class Proposer:
    """Surrogates fitted to an archive. k: number of characteristics among the outputs.

    trust: factor of the predicted variances. steps: (d,) level distances, 0 when continuous.
    """

    space: Space
    archive: Archive
    model: Fitted
    k: int
    trust: float
    steps: FloatArray
    prior: Prior

    def candidate(
        self,
        strategy: Strategy,
        kind: Kind,
        taken: Set[bytes],
        rng: np.random.Generator,
        *,
        anywhere: bool,
    ) -> Candidate | None:
        """By `kind`, or the next kind whose design is not known already.

        anywhere: a random design about the best at the last, else None.
        """
        for origin in (kind, *strategy.others()):
            point = self.space.snapped(self._point(origin, strategy, rng))
            if point.tobytes() not in taken:
                return Candidate(point, origin, self.predict(point))
        if not anywhere:
            return None
        box = TrustBox.around(self.archive.best.point, HALF_WIDTH)
        point = self.space.snapped(rng.uniform(box.lower, box.upper))
        return Candidate(point, "random", self.predict(point))

    def believing(self, point: FloatArray) -> Proposer:
        """With a candidate's predicted outputs taken for true (Kriging believer), for the rest of a batch."""
        archive = replace(
            self.archive,
            points=np.vstack([self.archive.points, point]),
            outputs=np.vstack([self.archive.outputs, self.model.predict(point[None])]),
        )
        return replace(self, archive=archive, model=fitted(archive))

    def predict(self, point: FloatArray) -> RatingForecast:
        """Characteristics and expected rating at a point, with their standard deviations."""
        mean, variance = self.model.predict(point[None]), self.trust * self.model.variance(point[None])[0]
        sd = np.sqrt(variance)
        draws = np.random.default_rng(0).standard_normal((IMPROVEMENT_DRAWS, sd.size))
        spread = self.archive.composite.rating(mean + sd * draws).std()
        expected = self.archive.composite.expected(mean, variance)[0]
        return RatingForecast(mean[0, : self.k], sd[: self.k], float(expected), float(spread))

    def _point(self, kind: Kind, strategy: Strategy, rng: np.random.Generator) -> FloatArray:
        best = self.archive.best.point
        if kind == "Gauss-Newton":
            return self._exploited(best, HALF_WIDTH, strategy.aversion)
        if kind == "trust region":
            return self._exploited(best, strategy.reach, AVERSION[0])
        if kind == "restart":
            return self._exploited(self._elsewhere(rng), HALF_WIDTH, AVERSION[1])
        return self._explored(rng)

    def _exploited(self, centre: FloatArray, half_width: float, aversion: float) -> FloatArray:
        doubt = aversion * self.trust
        box = TrustBox.around(centre, half_width)
        return self._levelled(
            gauss_newton(self.model, self.archive.composite, box, centre, self.prior, doubt=doubt), doubt
        )

    def _explored(self, rng: np.random.Generator) -> FloatArray:
        best, composite = self.archive.best, self.archive.composite
        box = TrustBox.around(best.point, HALF_WIDTH)
        search = ExpectedImprovement(
            self.model,
            composite,
            best.merit if best.searched is None else best.searched.total,
            self.archive.failed,
            seed=int(rng.integers(2**31)),
            doubt=self.trust,
        )
        near = gauss_newton(self.model, composite, box, best.point, self.prior, doubt=self.trust)
        away = rng.uniform(box.lower, box.upper, (AWAY, self.space.dimension))
        return self._levelled(search.maximum(box, [near, *away]), self.trust)

    def _elsewhere(self, rng: np.random.Generator) -> FloatArray:
        """Of random points the one farthest from all designs so far."""
        points = rng.uniform(0.0, 1.0, (SCATTERED, self.space.dimension))
        apart = ((points[:, None] - self.archive.points[None]) ** 2).sum(axis=2).min(axis=1)
        return np.asarray(points[int(np.argmax(apart))])

    def _levelled(self, point: FloatArray, doubt: float) -> FloatArray:
        best = self.space.snapped(self.archive.best.point)
        return on_levels(
            self.model, self.archive.composite, point, self.steps, best[None], self.prior, doubt=doubt
        )


def fitted(archive: Archive, seed: int = 0) -> Fitted:
    """Gaussian processes of all outputs that vary, about the exact expansion where the archive has one."""
    trend = None
    if archive.expansion is not None:
        at = int(np.flatnonzero((archive.points == archive.best.point).all(axis=1))[0])
        varies = ~constant_outputs(archive.outputs)
        trend = FirstOrderTrend(archive.best.point, archive.outputs[at][varies], archive.expansion[varies])
    return fit_varying(GaussianProcess(trend=trend), archive.points, archive.outputs, seed=seed)
