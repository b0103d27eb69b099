"""`ego`: composite efficient global optimization inside a trust region.

Every characteristic and curve score has its own surrogate, the rating is computed on them. After an opening
sample, led by a first-order step where slopes are exact, three kinds of proposals take turns, each kept while
it gains: Gauss-Newton on the expected rating, bolder while it succeeds; expected improvement; Gauss-Newton on
the bare predictions in a small trust region. Every candidate is confirmed by the true solver, which also
calibrates the predicted errors. Where an outside solver has a twin, that one leads first: `mapped_search.py`.
References: D. R. Jones, M. Schonlau, W. J. Welch, J. Global Optim. 13, 1998; R. Astudillo, P. Frazier, ICML
2019; D. Eriksson et al., Scalable global optimization via local Bayesian optimization, NeurIPS 2019.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar, final

import numpy as np

from doe_kc.correlation.least_squares import most_probable_step
from doe_kc.correlation.methods._base import MethodSettings, register
from doe_kc.correlation.methods._sampled import SurrogateMethod
from doe_kc.correlation.methods.ego.mapped_search import MAPPED, MappedSearch
from doe_kc.correlation.methods.ego.proposer import Proposer, outputs_model
from doe_kc.correlation.methods.ego.strategy import PATIENCE_WITH_SLOPES, Strategy, VarianceCalibration
from doe_kc.correlation.modelled.archive import Archive, Slopes, build_archive
from doe_kc.correlation.modelled.initial_design import InitialDesign
from doe_kc.correlation.problem import Candidate, Evaluated, Problem
from doe_kc.solver.result import NotConverged

OPENING = InitialDesign(fewest=8, variables_each=9, half_width=0.1, evened=True)
"""The proposals teach more than further samples would; near enough for the first slopes to hold where the
search goes."""
WITH_SLOPES = InitialDesign(fewest=2, variables_each=None, half_width=0.1, evened=True)
"""Slopes are known: a first-order step, and one design that shows how far they bend."""
SETTLED_REASON = "every proposal is a design that is known already"
EGO_DESIGNS = 3
"""Solved designs that the surrogates need."""
FIRST_STEP = "first-order step"
"""Origin of the first proposal where slopes are exact, before any sample."""


@final
@register
class Ego(SurrogateMethod):
    """State: beside the answers strategy, calibration of predicted variances and slopes at the best design.

    Slopes are taken wherever the problem has them, unless the settings forbid it; a search that has
    settled then ends, where others start anew elsewhere: from there slopes at the best design lead nowhere.
    Those of a twin count until its changes turn out not to be those of the outside model.
    """

    id: ClassVar[str] = "ego"
    label: ClassVar[str] = "Composite efficient global optimization"

    def __init__(self, problem: Problem, settings: MethodSettings) -> None:
        self._sloped = problem.has_slopes and settings.gradients is not False
        super().__init__(problem, settings, WITH_SLOPES if self._sloped else OPENING)
        self._strategy = Strategy(restarts=0, patience=PATIENCE_WITH_SLOPES) if self._sloped else Strategy()
        self._mapped = MappedSearch(problem) if self._sloped and problem.twin is not None else None
        self._settled = False
        self._calibration = VarianceCalibration()
        self._expanded: int | None = None
        self._slopes: Slopes | None = None

    @property
    def stopped(self) -> str:
        """No worthwhile gain any more, or nothing left to propose."""
        return self._strategy.stopped or (SETTLED_REASON if self._settled else "")

    def tell(self, evaluated: Sequence[Evaluated]) -> None:
        """Answers; proposals among them teach strategy and calibration."""
        earlier = tuple(self._evaluated)
        before = max((e.merit for e in earlier), default=-np.inf)
        super().tell(evaluated)
        for answer in evaluated:
            if self._mapped is not None and answer.candidate.origin == MAPPED:
                self._mapped = self._mapped.after(earlier, answer)
        if self._mapped is not None and not self._mapped.useful:
            self._without_twin()
        searched = [e for e in evaluated if e.candidate.predicted and e.candidate.origin != MAPPED]
        if not searched:
            return
        self._calibration.learn(searched)
        after = max(e.merit for e in evaluated)
        self._strategy = self._strategy.after(after - before, before)

    def _without_twin(self) -> None:
        """The search that sees values alone, with its opening sample."""
        self._mapped, self._sloped, self._slopes = None, False, None
        self._strategy, self._opening, self._opened = Strategy(), OPENING, False

    def _opening_designs(self, count: int, seed: int) -> Sequence[Candidate]:
        """With exact slopes the first is where they lead from the baseline."""
        step = None
        if self._problem.exact and self._sloped and len(self._evaluated) == 1:
            step = first_order(self._problem, self._evaluated[0])
        if step is None:
            return super()._opening_designs(count, seed)
        return [step, *super()._opening_designs(count - 1, seed)] if count > 1 else [step]

    def _missing(self) -> int:
        """A few designs more at a time while too many fail; none while the twin leads, unless asked for."""
        if self._mapped is not None and self._mapped.active and self._settings.first is None:
            return 0
        solved = sum(e.score is not None for e in self._evaluated)
        return max(EGO_DESIGNS - solved, super()._missing())

    def _round(self, rng: np.random.Generator) -> list[Candidate]:
        """`batch` candidates, one while the twin leads; fewer or none where slopes lead to known designs."""
        if self._mapped is not None and self._mapped.active:
            candidate = self._mapped.candidate(self._evaluated)
            if candidate is not None:
                return [candidate]
            self._mapped = self._mapped.settled(self._evaluated)
            if not self._mapped.useful:
                self._without_twin()
            missing, self._opened = self._missing(), True
            if missing > 0:
                return list(self._opening_designs(missing, int(rng.integers(2**31))))
        proposer = self._proposer()
        taken = {e.point.tobytes() for e in self._evaluated}
        kind, out = self._strategy.kind, list[Candidate]()
        for place in range(self._settings.batch):
            candidate = proposer.candidate(self._strategy, kind, taken, rng, anywhere=not self._sloped)
            if candidate is None:
                self._settled = not out
                break
            out.append(candidate)
            taken.add(candidate.point.tobytes())
            if place + 1 < self._settings.batch:
                proposer = proposer.believing(candidate.point)
                kind = self._strategy.following(kind)
        return out

    def _proposer(self) -> Proposer:
        archive = self._archive()
        model = outputs_model(archive, seed=self._settings.seed)
        return Proposer(self._problem, archive, model, self._calibration.factor)

    def _archive(self) -> Archive:
        if not self._sloped:
            return build_archive(self._problem.search, self._evaluated)
        best = max(self._evaluated, key=lambda e: e.merit)
        if self._expanded != best.index:
            try:
                self._slopes = self._problem.output_slopes(best.point)
            except NotConverged:
                self._slopes = None
            self._expanded = best.index
        return build_archive(self._problem.search, self._evaluated, self._slopes)


def first_order(problem: Problem, answer: Evaluated) -> Candidate | None:
    """A Gauss-Newton step on records and typed targets from a design, within bounds and on the levels.

    None without data, without sensitivities there, or when the step leads nowhere.
    """
    data = problem.likelihood
    if not data.size or answer.outcome.failed:
        return None
    try:
        expansion = problem.linearize(answer.point)
    except NotConverged:
        return None
    jacobian = data.jacobian(expansion.curves, expansion.characteristics)
    residual = data.residual(answer.outcome.curves, answer.outcome.characteristics)
    step = most_probable_step(jacobian, residual, answer.point, problem.space)
    point = problem.space.snapped(answer.point + step)
    return None if np.array_equal(point, answer.point) else Candidate(point, FIRST_STEP)
