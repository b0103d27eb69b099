"""`ego`: composite efficient global optimization inside a trust region.

Every characteristic and curve score has its own surrogate, the rating is computed on them. After an opening
sample three kinds of proposals take turns, each kept while it gains: Gauss-Newton on the expected rating,
bolder while it succeeds; expected improvement; Gauss-Newton on the bare predictions in a small trust region.
Every candidate is confirmed by the true solver, which also calibrates the predicted errors.
References: D. R. Jones, M. Schonlau, W. J. Welch, J. Global Optim. 13, 1998; R. Astudillo, P. Frazier, ICML
2019; D. Eriksson et al., Scalable global optimization via local Bayesian optimization, NeurIPS 2019.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar, final

import numpy as np

from doe_kc.correlation.ego.archive import Archive, build_archive
from doe_kc.correlation.ego.opening import opening_sample, opening_size
from doe_kc.correlation.ego.proposer import Proposer, fitted
from doe_kc.correlation.ego.strategy import CYCLE, Strategy
from doe_kc.correlation.ego.trust import Trust
from doe_kc.correlation.methods._base import Method, Settings, register
from doe_kc.correlation.problem import Candidate, Evaluated, Problem
from doe_kc.solver.result import NotConverged
from doe_kc.typing import FloatArray

FEWEST = 3
"""Solved designs that the surrogates need."""


@final
@register
class Ego(Method):
    """State: all answers, the strategy, and how far predictions are trusted."""

    id: ClassVar[str] = "ego"
    label: ClassVar[str] = "Composite efficient global optimization"

    def __init__(self, problem: Problem, settings: Settings) -> None:
        self._problem, self._settings, self._space = problem, settings, problem.space
        self._evaluated: list[Evaluated] = []
        self._opened = False
        self._strategy = Strategy()
        self._trust = Trust()
        levels = [v.levels for v in self._space.variables]
        self._steps = np.array([0.0 if n is None else 1.0 / (n - 1) for n in levels])

    @property
    def stopped(self) -> str:
        """No worthwhile gain any more, also after restarts."""
        return self._strategy.stopped

    def ask(self) -> Sequence[Candidate]:
        """The opening sample, then `batch` candidates a round."""
        rng = np.random.default_rng([self._settings.seed, len(self._evaluated)])
        solved = sum(e.score is not None for e in self._evaluated)
        if not self._opened or solved < FEWEST:
            opening = self._opening(rng, solved)
            if opening:
                return opening
        return self._round(rng)

    def tell(self, evaluated: Sequence[Evaluated]) -> None:
        """Answers; proposals among them teach strategy and trust."""
        before = max((e.merit for e in self._evaluated), default=-np.inf)
        self._evaluated.extend(evaluated)
        if not any(e.candidate.predicted for e in evaluated):
            return
        self._trust.learn(evaluated)
        after = max(e.merit for e in evaluated)
        self._strategy = self._strategy.after(after - before, before)

    def _opening(self, rng: np.random.Generator, solved: int) -> list[Candidate]:
        """The designs that are missing; a few more at a time while too many fail."""
        wanted = opening_size(self._space, self._settings.first, gradients=self._settings.gradients)
        missing = max(FEWEST - solved, 0 if self._opened else wanted - (len(self._evaluated) - 1))
        seed = self._settings.seed if not self._opened else int(rng.integers(2**31))
        self._opened = True
        if missing <= 0:
            return []
        return [Candidate(p, "opening sample") for p in opening_sample(self._space, missing, seed)]

    def _round(self, rng: np.random.Generator) -> list[Candidate]:
        proposer = self._proposer()
        taken = {e.point.tobytes() for e in self._evaluated}
        kind, out = self._strategy.kind, list[Candidate]()
        for place in range(self._settings.batch):
            candidate = proposer.candidate(self._strategy, kind, taken, rng)
            out.append(candidate)
            taken.add(candidate.point.tobytes())
            if place + 1 < self._settings.batch:
                proposer = proposer.believing(candidate.point)
                kind = CYCLE[(CYCLE.index(kind) + 1) % len(CYCLE)] if kind in CYCLE else CYCLE[0]
        return out

    def _proposer(self) -> Proposer:
        archive = self._archive()
        return Proposer(
            space=self._space,
            archive=archive,
            model=fitted(archive, self._settings.seed),
            k=len(self._problem.targets.characteristics),
            trust=self._trust.factor,
            steps=self._steps,
        )

    def _archive(self) -> Archive:
        if not (self._settings.gradients and self._problem.exact):
            return build_archive(self._problem.targets, self._evaluated)
        best = max(self._evaluated, key=lambda e: e.merit)
        if self._expanded != best.index:
            try:
                self._slopes = self._problem.output_slopes(best.point)
            except NotConverged:
                self._slopes = None
            self._expanded = best.index
        return build_archive(self._problem.targets, self._evaluated, self._slopes)

    _expanded: int | None = None
    _slopes: tuple[FloatArray, FloatArray] | None = None
