"""`smt_ego`: efficient global optimization of the rating as one number, by SMT, offered for comparison.

SMT's own EGO with its KPLS surrogate: expected improvement, SLSQP with finite differences from 20 starts.
It sees the rating alone, not the outputs that it is made of, and constraints only as their penalty. In 60 to
70 variables one proposal takes half a minute to one and a half on one core.
References: M. A. Bouhlel et al., Structural and Multidisciplinary Optimization 53(5), 2016; P. Saves et al.,
SMT 2.0, Advances in Engineering Software 188, 2024; D. R. Jones et al., J. Global Optim. 13, 1998.
"""

from __future__ import annotations

from typing import ClassVar, final

import numpy as np

from doe_kc.correlation.hybrid.record import SearchHistory
from doe_kc.correlation.methods._base import MethodSettings, register
from doe_kc.correlation.methods._sampled import SurrogateMethod
from doe_kc.correlation.methods._smt import Proposal, propose
from doe_kc.correlation.problem import Candidate, Problem, RatingForecast
from doe_kc.ground.errors import RunError

SMT_DESIGNS = 3
"""Designs with an answer that the surrogate needs."""


@final
@register
class SmtEgo(SurrogateMethod):
    """State: beside the answers why SMT gave up."""

    id: ClassVar[str] = "smt_ego"
    label: ClassVar[str] = "Scalar EGO of SMT (KPLS), for comparison"

    def __init__(self, problem: Problem, settings: MethodSettings) -> None:
        super().__init__(problem, settings)
        self._stopped = ""

    @property
    def stopped(self) -> str:
        """SMT could not train its surrogate, or found no expected improvement."""
        return self._stopped

    def _round(self, rng: np.random.Generator) -> list[Candidate]:
        """The designs of SMT's next iteration; failed ones are left out of its surrogate."""
        record = self._record
        if len(record.sound) < SMT_DESIGNS or np.ptp([e.merit for e in record.sound]) == 0.0:
            return self._random(record, rng)
        return self._iteration(record, rng)

    def _iteration(self, record: SearchHistory, rng: np.random.Generator) -> list[Candidate]:
        unique = {e.point.tobytes(): e for e in reversed(record.sound)}
        points = np.array([e.point for e in unique.values()])
        losses = np.array([-e.merit for e in unique.values()])
        try:
            found = propose(points, losses, number=self._settings.batch, seed=int(rng.integers(2**31)))
        except RunError as error:  # ends the search, not the run: what is found so far stays
            self._stopped = str(error)
            return []
        if not found:
            self._stopped = "SMT's search for the largest expected improvement found no design"
        out: list[Candidate] = []
        for proposal in found:
            new = record.fresh(proposal.point, [c.point for c in out], rng)
            out.append(Candidate(new, "expected improvement", self._prediction(proposal)))
        return out

    def _prediction(self, proposal: Proposal) -> RatingForecast:
        unknown = np.full(len(self._problem.targets.characteristics), np.nan)
        return RatingForecast(unknown, unknown, -proposal.loss, proposal.loss_sd)

    def _random(self, record: SearchHistory, rng: np.random.Generator) -> list[Candidate]:
        drawn = self._problem.space.drawn(rng.random((self._settings.batch, self._problem.space.dimension)))
        return [Candidate(record.fresh(p, [], rng), "random") for p in drawn]
