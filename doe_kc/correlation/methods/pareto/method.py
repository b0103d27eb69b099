"""`pareto`: the trade-offs between load cases in conflict, as a front of confirmed designs.

Opening sample, then rounds: NSGA-III on surrogates of all outputs inside a trust region, with the objective
terms of equation 2.2 summed by load case and the violation of constraints as a constraint; a few designs
spread over the predicted front, the best predicted rating first, are confirmed by the true solver and
the surrogates fitted anew (thesis, section 2.3, MO-SHERPA; K. Deb, H. Jain, IEEE Trans. Evol. Comput. 18(4),
2014; J. Knowles, ParEGO, IEEE Trans. Evol. Comput. 10(1), 2006, for the confirmed infill).
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar, final

import numpy as np

from doe_kc.correlation.front import Front, front_of, knee, objectives
from doe_kc.correlation.methods._base import MethodSettings, register
from doe_kc.correlation.methods._sampled import SurrogateMethod
from doe_kc.correlation.methods.pareto.infill import ModelledObjectives, predicted_front, spread_out
from doe_kc.correlation.methods.pareto.nsga3 import check_installed
from doe_kc.correlation.modelled.history import SearchHistory
from doe_kc.correlation.modelled.proposal import best_predicted, forecast
from doe_kc.correlation.modelled.trust_region import RadiusRule, TrustBox, TrustRegion
from doe_kc.correlation.problem import Candidate, Evaluated, Problem
from doe_kc.ground.typing import FloatArray

ROUND = 5
"""Designs of a round at least: one search for the front is dearer than a fit."""
PARETO_RADIUS = RadiusRule(first=0.3, smallest=0.02, largest=0.5, shrinkage=0.7, growth=1.6, floor="restart")
PARETO_PROGRESS = 0.01
"""Gain, share of the best rating's or of an objective's range on the front, that counts as progress."""
PARETO_PATIENCE = 6
"""Rounds without progress that end the search."""


@final
@register
class Pareto(SurrogateMethod):
    """State: beside the answers the trust region about the best rating, the front's best values so far.

    `best` is the best rating: with the weights as given, that is the point of the front that they prefer.
    """

    id: ClassVar[str] = "pareto"
    label: ClassVar[str] = "Front of trade-offs by NSGA-III on surrogates"

    def __init__(self, problem: Problem, settings: MethodSettings) -> None:
        """InputError with fewer than two objectives, or without pymoo."""
        check_installed()
        super().__init__(problem, settings)
        self._objectives = objectives(problem.search)
        self._region, self._idle = TrustRegion.first(PARETO_RADIUS), 0
        self._infill = False
        self._stopped = ""

    @property
    def stopped(self) -> str:
        """Neither the best rating nor the best value of an objective improves any more."""
        return self._stopped

    @property
    def front(self) -> Front:
        """Of the designs confirmed so far."""
        return front_of(self._problem.search, self._evaluated, chosen=self._objectives)

    def tell(self, evaluated: Sequence[Evaluated]) -> None:
        """Answers; the region follows the best rating, patience the front."""
        before = self.front if self._evaluated else None
        super().tell(evaluated)
        if before is None or not self._infill:
            return
        after = self.front
        self._region = self._region.after(float(after.ratings[0] > before.ratings[0]))
        self._idle = 0 if _progress(before, after) else self._idle + 1
        if self._idle >= PARETO_PATIENCE:
            self._stopped = (
                f"neither the best rating nor an objective's best value gained "
                f"{100 * PARETO_PROGRESS:g} % in {PARETO_PATIENCE} rounds"
            )

    def _round(self, rng: np.random.Generator) -> list[Candidate]:
        record = self._record
        self._infill = record.can_model
        return self._spread(record, rng) if self._infill else self._random(record, rng)

    def _spread(self, record: SearchHistory, rng: np.random.Generator) -> list[Candidate]:
        """Designs spread over the predicted front, best rating and knee first."""
        modelled = ModelledObjectives(self._problem.search, self._objectives, record.archive, record.model)
        points = predicted_front(record, modelled, self._box(record), len(self._objectives.names), rng)
        values, _ = modelled.values(points)
        chosen = [("best rating", self._best_rating(record)), ("knee", points[knee(values)])]
        confirmed = np.array([self._objectives.values(e.searched) for e in record.ranked[:100] if e.searched])
        number = max(ROUND, self._settings.batch)
        rest = spread_out(values, np.vstack([confirmed, values[[knee(values)]]]), number - len(chosen))
        chosen += [("front", points[i]) for i in rest]
        out: list[Candidate] = []
        for origin, point in chosen[:number]:
            new = record.fresh(point, [c.point for c in out], rng)
            out.append(Candidate(new, origin, forecast(self._problem, record.archive, record.model, new)))
        return out

    def _box(self, record: SearchHistory) -> TrustBox:
        """The box that holds the front of feasible designs, wider by the radius: its ends may lie apart."""
        front = self.front
        known = {e.index: e.point for e in record.evaluated}
        points = (
            np.array([known[int(i)] for i in front.indices]) if front.feasible else record.best.point[None]
        )
        lower, upper = points.min(axis=0) - self._region.radius, points.max(axis=0) + self._region.radius
        return TrustBox(np.maximum(lower, 0.0), np.minimum(upper, 1.0))

    def _best_rating(self, record: SearchHistory) -> FloatArray:
        composite, box = record.archive.composite, self._region.box(record.best.point)
        return best_predicted(self._problem, record.model, composite, box, record.best.point)

    def _random(self, record: SearchHistory, rng: np.random.Generator) -> list[Candidate]:
        """Random designs near the best one while too few have an answer."""
        box = self._region.box(record.best.point)
        drawn = rng.uniform(box.lower, box.upper, (max(ROUND, self._settings.batch), box.lower.size))
        return [Candidate(record.fresh(p, [], rng), "random") for p in drawn]


def _progress(before: Front, after: Front) -> bool:
    """Whether the front has become feasible, or its best rating or an objective's best value better."""
    if before.feasible != after.feasible:
        return True
    worth = PARETO_PROGRESS * abs(before.ratings[0])
    ideal, better = before.values.min(axis=0), after.values.min(axis=0)
    span = np.maximum(np.ptp(before.values, axis=0), 1e-12)
    return bool(
        after.ratings[0] - before.ratings[0] > worth or np.any(ideal - better > PARETO_PROGRESS * span)
    )
