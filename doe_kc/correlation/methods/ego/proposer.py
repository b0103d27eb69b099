"""One round of proposals: surrogates of the archive's outputs, and the candidate of largest improvement.

Expected improvement of the rating over the best design, by Monte Carlo with common random numbers:
log EI = log mean_s softplus((R(h_s) - best) / t) with h_s = mean + sd z_s; the samples z are the same at
every point, so it is smooth and its gradient exact.
References: R. Astudillo, P. Frazier, Bayesian optimization of composite functions, ICML 2019; S. Ament et
al., Unexpected improvements to expected improvement, NeurIPS 2023.
"""

from __future__ import annotations

from collections.abc import Sequence, Set
from dataclasses import dataclass, replace

import numpy as np
from scipy.optimize import minimize
from scipy.special import expit, logsumexp, ndtri

from doe_kc.correlation.methods.ego.strategy import AVERSION, ProposalKind, Strategy
from doe_kc.correlation.modelled.archive import Archive
from doe_kc.correlation.modelled.composite import Composite
from doe_kc.correlation.modelled.proposal import best_predicted, fit_outputs, forecast, gauss_newton, levelled
from doe_kc.correlation.modelled.trust_region import TrustBox
from doe_kc.correlation.modelled.unit_samples import scrambled_sobol
from doe_kc.correlation.problem import Candidate, Problem, RatingForecast
from doe_kc.ground.typing import FloatArray
from doe_kc.surrogate_models.interface import Fitted
from doe_kc.surrogate_models.models.gp_ard import RelevanceProcess
from doe_kc.surrogate_models.varying import fit_varying

IMPROVEMENT_LEVELS = 6
"""Binary logarithm of the samples of the predicted errors, which are common to all points: their number
shifts the improvement but hardly its place."""
SHARPNESS = 1e-2
"""Temperature t as a share of the best rating's size: below it an improvement is rounded."""
ACQUISITION_ITERATIONS = 25
"""Enough to rank the starts: the candidate is snapped to levels and evaluated, not converged upon."""


class ExpectedImprovement:
    """log EI at a point and its gradient."""

    def __init__(
        self,
        model: Fitted,
        composite: Composite,
        best: float,
        failed: FloatArray,
        *,
        seed: int,
        doubt: float = 1.0,
    ) -> None:
        """failed: (f, d) points without an answer, whose surroundings count for less.

        doubt: factor of the predicted variances.
        """
        self._doubt = doubt
        self._model, self._composite, self._best = model, composite, best
        self._failed = failed
        samples = scrambled_sobol(IMPROVEMENT_LEVELS, model.outputs, seed)
        self._z = ndtri(np.clip(samples, 1e-6, 1.0 - 1e-6))
        self._temperature = SHARPNESS * max(abs(best), 1e-3)

    def log(self, point: FloatArray) -> tuple[float, FloatArray]:
        """log EI and its gradient (d,)."""
        known = self._model.predict_all(point[None])
        sd = np.sqrt(np.maximum(self._doubt * known.variance[0], 1e-24))
        h = known.mean[0] + self._z * sd
        rating, push = self._composite.rating_and_gradient(h)
        gain = (rating - self._best) / self._temperature
        log_soft = _log_softplus(gain)
        value = float(logsumexp(log_soft) - np.log(len(self._z)))
        share = np.exp(log_soft - logsumexp(log_soft)) * _log_softplus_slope(gain) / self._temperature
        slope = push * share[:, None]
        sd_gradient = self._doubt * known.variance_gradient[0] / (2.0 * sd[:, None])
        gradient = slope.sum(axis=0) @ known.gradient[0] + (slope * self._z).sum(axis=0) @ sd_gradient
        penalty, pull = _nearness(point, self._failed)
        return value + penalty, gradient + pull

    def maximum(self, box: TrustBox, starts: Sequence[FloatArray]) -> FloatArray:
        """(d,) best point found from the starts, by L-BFGS-B inside the box."""
        bounds = list(zip(box.lower, box.upper, strict=True))
        optima = [
            minimize(
                self._negative,
                box.clip(start),
                jac=True,
                method="L-BFGS-B",
                bounds=bounds,
                options={"maxiter": ACQUISITION_ITERATIONS},
            )
            for start in starts
        ]
        best = min(optima, key=lambda r: float(r.fun))
        return np.asarray(box.clip(best.x))

    def _negative(self, point: FloatArray) -> tuple[float, FloatArray]:
        value, gradient = self.log(point)
        return -value, -gradient


def _log_softplus(x: FloatArray) -> FloatArray:
    """log(log(1 + e^x)), exact for very negative x."""
    return np.asarray(np.where(x < -30.0, x, np.log(np.logaddexp(0.0, np.maximum(x, -30.0)))))


def _log_softplus_slope(x: FloatArray) -> FloatArray:
    """Its derivative, 1 for very negative x."""
    kept = np.maximum(x, -30.0)
    return np.asarray(np.where(x < -30.0, 1.0, expit(kept) / np.logaddexp(0.0, kept)))


def _nearness(point: FloatArray, failed: FloatArray) -> tuple[float, FloatArray]:
    """log(1 - exp(-r^2 / 2 l^2)) summed over failures: -inf on one, 0 far away; its gradient."""
    if not len(failed):
        return 0.0, np.zeros_like(point)
    length = 0.02 * np.sqrt(point.size)
    apart = point - failed
    x = np.maximum((apart**2).sum(axis=1) / (2.0 * length**2), 1e-9)
    weight = 1.0 / np.expm1(x)
    return float(np.log(-np.expm1(-x)).sum()), (weight[:, None] * apart / length**2).sum(axis=0)


HALF_WIDTH = 0.3
"""Of the box about the best design in which proposals lie."""
RELEVANCE_FROM, RELEVANCE_TO = 14, 100
"""Designs known by values alone whose outputs have a length-scale of every variable each: fewer do not tell
them, and more take longer than they gain. Of 72 variables, 0.1 % of the deviation came at evaluation 23 in
the median instead of 33; with it from the first proposal on, 10 % came at 13 instead of 10."""
AWAY = 2
"""Random starts of the search for the expected improvement, beside the Gauss-Newton proposal."""
SCATTERED = 256
"""Random points among which a restart finds its place."""


def outputs_model(archive: Archive, *, seed: int = 0) -> Fitted:
    """Surrogates of all outputs of an archive, at their best for so many designs, with slopes or without.

    InputError when no output varies.
    """
    if archive.expansion is None and RELEVANCE_FROM <= len(archive.points) <= RELEVANCE_TO:
        return fit_varying(RelevanceProcess(), archive.points, archive.outputs, seed=seed)
    return fit_outputs(archive, seed=seed)


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
        return replace(self, archive=archive, model=outputs_model(archive))

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
