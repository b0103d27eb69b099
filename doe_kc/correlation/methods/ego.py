"""`ego`: composite efficient global optimization inside a trust region.

Every characteristic and curve score has its own surrogate, the rating is computed on them. Opening sample,
then in turn: Gauss-Newton on the predictions while they keep what they promise, expected improvement when
they do not, always confirmed by the true solver; the region grows and shrinks by actual over predicted gain.
References: D. R. Jones, M. Schonlau, W. J. Welch, J. Global Optim. 13, 1998; R. Astudillo, P. Frazier, ICML
2019; D. Eriksson et al., Scalable global optimization via local Bayesian optimization, NeurIPS 2019.
"""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import ClassVar, final

import numpy as np
from scipy.stats import qmc

from doe_kc.correlation.ego.archive import Archive, build_archive
from doe_kc.correlation.ego.improvement import ExpectedImprovement
from doe_kc.correlation.ego.levels import on_levels
from doe_kc.correlation.ego.proposal import Box, Pull, gauss_newton
from doe_kc.correlation.methods._base import Method, Settings, register
from doe_kc.correlation.problem import Candidate, Evaluated, Prediction, Problem
from doe_kc.surrogates.interface import Fitted
from doe_kc.surrogates.learning import Learning
from doe_kc.surrogates.models.gp import GaussianProcess
from doe_kc.typing import FloatArray

LEARN = Learning(nugget=float(os.environ.get("NUG", "1e-5")))
FEWEST = 20
OPENING = float(os.environ.get("OPEN", "0.25"))
"""Half-width of the opening sample about the start, share of the bounds."""
FIRST_RADIUS, LARGEST, SMALLEST = 0.3, 0.5, 0.01
SHRINK, GROW = 0.7, 1.6
GOOD = 0.7
GAIN = float(os.environ.get("GAIN", "0.002"))
"""Gain, share of the rating, below which a proposal is not worth a run."""
PATIENCE = int(os.environ.get("PAT", "6"))
"""Proposals in a row without a worthwhile gain that end the search."""
RESTARTS = 2
MEMORY = 6
"""Last confirmations that calibrate the predicted variances."""
DOUBTS = (1e-3, 10.0)
KINDS = ("Gauss-Newton", "expected improvement", "trust region")
DARE, FEAR = float(os.environ.get("DARE", "0.3")), float(os.environ.get("FEAR", "3.0"))
RISKS = (1e-3, 1.0)


@dataclass(frozen=True)
class _Region:
    """Trust region: half-width, worthless proposals in a row, restarts made, kind of the next proposal."""

    radius: float = FIRST_RADIUS
    idle: int = 0
    restarts: int = 0
    kind: int = 0
    risk: float = 1.0
    reach: float = 0.1


@final
@register
class Ego(Method):
    """State: all answers, the region, and what the last candidates promised."""

    id: ClassVar[str] = "ego"
    label: ClassVar[str] = "Composite efficient global optimization"

    def __init__(self, problem: Problem, settings: Settings) -> None:
        self._problem, self._settings = problem, settings
        self._space = problem.space
        self._evaluated: list[Evaluated] = []
        self._region = _Region()
        self._opened = False
        self._ratios: list[float] = [1.0]
        self._promised: tuple[float, float] | None = None
        self._stopped = ""
        levels = [v.levels for v in self._space.variables]
        self._steps = np.array([0.0 if n is None else 1.0 / (n - 1) for n in levels])

    @property
    def stopped(self) -> str:
        """No worthwhile gain left, or restarts used up."""
        return self._stopped

    def ask(self) -> Sequence[Candidate]:
        """The opening sample, then `batch` candidates a round."""
        if not self._opened:
            self._opened = True
            opening = self._opening()
            if opening:
                return opening
        archive = build_archive(self._problem.targets, self._evaluated)
        return self._proposals(archive)

    def tell(self, evaluated: Sequence[Evaluated]) -> None:
        """Answers; the region learns from those that a proposal promised something of."""
        self._ratios.extend(squared_error(e, self._doubt) for e in evaluated if e.candidate.predicted)
        before = max((e.merit for e in self._evaluated), default=-np.inf)
        self._evaluated.extend(evaluated)
        if self._promised is None:
            return
        expected, best = self._promised
        after = max(e.merit for e in evaluated)
        self._region = self._updated(after - before, expected - best, best)
        self._promised = None

    @property
    def _doubt(self) -> float:
        """Factor of the predicted variances that the last confirmations ask for."""
        return float(np.clip(np.exp(np.mean(np.log(self._ratios[-MEMORY:]))), *DOUBTS))

    def _opening(self) -> list[Candidate]:
        wanted = self._settings.first or max(FEWEST, self._space.dimension // 3)
        missing = wanted - (len(self._evaluated) - 1)
        if missing <= 0:
            return []
        sampler = qmc.LatinHypercube(
            self._space.dimension, rng=np.random.default_rng(self._settings.seed), optimization="random-cd"
        )
        drawn = self._space.drawn(sampler.random(missing))
        start = self._space.start
        near = start + 2.0 * OPENING * (drawn - start)
        return [Candidate(p, "opening sample") for p in self._space.snapped(near)]

    def _proposals(self, archive: Archive) -> list[Candidate]:
        model = self._fitted(archive)
        best = archive.best
        box = Box.around(best.point, self._region.radius)
        out: list[Candidate] = []
        for place in range(self._settings.batch):
            candidate = self._proposal(model, archive, box, (self._region.kind + place) % len(KINDS), out)
            out.append(candidate)
            if place + 1 < self._settings.batch:
                archive = _believed(archive, model, candidate.point)
                model = self._fitted(archive)
        promised = max(c.predicted.rating for c in out if c.predicted is not None)
        self._promised = (promised, best.merit)
        return out

    def _proposal(
        self, model: Fitted, archive: Archive, box: Box, kind: int, others: Sequence[Candidate]
    ) -> Candidate:
        """By `kind`, or the next kind that gives a design not evaluated yet."""
        taken = {e.point.tobytes() for e in self._evaluated} | {c.point.tobytes() for c in others}
        for turn in range(len(KINDS)):
            origin = KINDS[(kind + turn) % len(KINDS)]
            point = self._point(origin, model, archive, box)
            if point.tobytes() not in taken:
                return Candidate(point, origin, self._predict(model, archive, point))
        point = self._perturbed(box, len(others))
        return Candidate(point, "random", self._predict(model, archive, point))

    def _point(self, origin: str, model: Fitted, archive: Archive, box: Box) -> FloatArray:
        doubt = self._doubt * {KINDS[0]: self._region.risk, KINDS[1]: 1.0, KINDS[2]: RISKS[0]}[origin]
        if origin == KINDS[2]:
            box = Box.around(archive.best.point, self._region.reach)
        pull = Pull.towards(self._space.start, self._space.prior_sd)
        near = gauss_newton(model, archive.composite, box, archive.best.point, pull, doubt=doubt)
        if origin == KINDS[1]:
            near = self._explored(model, archive, box, near)
        return self._space.snapped(
            on_levels(
                model,
                archive.composite,
                near,
                self._steps,
                self._space.snapped(archive.best.point[None]),
                doubt=doubt,
            )
        )

    def _fitted(self, archive: Archive) -> Fitted:
        return GaussianProcess(learning=LEARN).fit(archive.points, archive.outputs, seed=self._settings.seed)

    def _explored(self, model: Fitted, archive: Archive, box: Box, near: FloatArray) -> FloatArray:
        rng = np.random.default_rng([self._settings.seed, len(self._evaluated)])
        search = ExpectedImprovement(
            model,
            archive.composite,
            archive.best.merit,
            archive.failed,
            seed=int(rng.integers(2**31)),
            doubt=self._doubt,
        )
        away = rng.uniform(box.lower, box.upper, (2, self._space.dimension))
        return search.maximum(box, [near, *away])

    def _perturbed(self, box: Box, place: int) -> FloatArray:
        rng = np.random.default_rng([self._settings.seed, len(self._evaluated), place])
        return self._space.snapped(rng.uniform(box.lower, box.upper))

    def _predict(self, model: Fitted, archive: Archive, point: FloatArray) -> Prediction:
        known = model.predict_all(point[None])
        variance = self._doubt * known.variance[0]
        sd = np.sqrt(variance)
        rng = np.random.default_rng(0)
        ratings = archive.composite.rating(known.mean[0] + sd * rng.standard_normal((64, sd.size)))
        k = len(self._problem.targets.characteristics)
        rating = float(archive.composite.expected(known.mean, variance)[0])
        return Prediction(known.mean[0, :k], sd[:k], rating, float(ratings.std()))

    def _updated(self, gain: float, promised: float, best: float) -> _Region:
        """Region after a round that promised a gain on `best` and gave one."""
        region = self._region
        worth = GAIN * abs(best)
        idle = 0 if gain > worth else region.idle + 1
        won = gain > worth
        kind = region.kind if won else (region.kind + 1) % len(KINDS)
        risk, reach = region.risk, region.reach
        if region.kind == 0:
            risk = float(np.clip(risk * (DARE if won else FEAR), *RISKS))
        if region.kind == 2:
            reach = float(np.clip(reach * (GROW if won else SHRINK), 0.02, 0.3))
        new = replace(region, idle=idle, kind=kind, risk=risk, reach=reach)
        if idle >= PATIENCE:
            self._stopped = f"{PATIENCE} proposals in a row gained less than {100 * GAIN:g} % of the rating"
        return new

    def _restarted(self, region: _Region) -> _Region:
        if region.restarts >= RESTARTS:
            self._stopped = "the trust region shrank to nothing, also after restarts"
        return _Region(restarts=region.restarts + 1, kind=1)


def squared_error(answer: Evaluated, doubt: float) -> float:
    """Mean squared error of a prediction over its variance before `doubt` was applied; 1 after a failure."""
    predicted = answer.candidate.predicted
    if answer.score is None or predicted is None:
        return 1.0
    z = (answer.score.values - predicted.values) / np.maximum(predicted.sd, 1e-300)
    return max(doubt * float(np.mean(z**2)), 1e-6)


def _believed(archive: Archive, model: Fitted, point: FloatArray) -> Archive:
    """The archive with a candidate's predicted outputs taken for true (Kriging believer)."""
    return replace(
        archive,
        points=np.vstack([archive.points, point]),
        outputs=np.vstack([archive.outputs, model.predict(point[None])]),
    )
