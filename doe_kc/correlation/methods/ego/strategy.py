"""What to propose next: how far to trust the surrogates, calibrated by confirmed candidates; when to stop."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from doe_kc.correlation.modelled.trust_region import RadiusRule, TrustRegion
from doe_kc.correlation.problem import Evaluated

MEMORY = 6
"""Last confirmations that count."""
LIMITS = (1e-3, 10.0)
"""Of the factor: a run of luck must not make predictions certain, nor bad luck drown what the model knows."""


class VarianceCalibration:
    """`factor`: of the predicted variances that the last confirmations ask for."""

    def __init__(self) -> None:
        self._ratios = [1.0]

    @property
    def factor(self) -> float:
        """Geometric mean of the squared errors over the predicted variances."""
        return float(np.clip(np.exp(np.mean(np.log(self._ratios[-MEMORY:]))), *LIMITS))

    def learn(self, answers: Iterable[Evaluated]) -> None:
        """From answers to candidates whose standard deviations carried the present factor."""
        factor = self.factor
        self._ratios.extend(r for a in answers if (r := _squared_error(a, factor)) is not None)


def _squared_error(answer: Evaluated, factor: float) -> float | None:
    predicted = answer.candidate.predicted
    if answer.score is None or predicted is None:
        return None
    doubted = predicted.sd > 0.0  # the others never change, or are predicted to round-off
    if not doubted.any():
        return None
    z = (answer.score.values - predicted.values)[doubted] / predicted.sd[doubted]
    return max(factor * float(np.mean(z**2)), 1e-6)


ProposalKind = Literal["Gauss-Newton", "expected improvement", "trust region", "restart"]
PROPOSAL_CYCLE: tuple[ProposalKind, ...] = ("Gauss-Newton", "expected improvement", "trust region")
GAIN = 0.002
"""Gain, share of the rating, below which a proposal was not worth its run."""
EGO_PATIENCE = 15
"""Where surrogates learn from values alone; three in a row of every kind of proposal, five times."""
PATIENCE_WITH_SLOPES = 5
"""Where slopes at the best design are exact: what they miss is found by the next proposals or not at all."""
RESTARTS = 3
"""Starts elsewhere of a search that has settled."""
DARE, FEAR = 0.3, 3.0
"""Factors of the risk aversion after a worthwhile Gauss-Newton proposal and after another."""
AVERSION = (1e-3, 1.0)
"""From the mean taken at its word to the expected rating, in which a variance counts in full."""
EGO_RADIUS = RadiusRule(first=0.1, smallest=0.02, largest=0.3, shrinkage=0.7, growth=1.6, floor="stay")
"""Of the trust region in which predictions are taken at their word."""
FIRST_REGION = TrustRegion.first(EGO_RADIUS)


@dataclass(frozen=True)
class Strategy:
    """aversion: factor of the predicted variances in Gauss-Newton proposals, 1 = the expected rating.

    region: in which predictions are taken at their word. idle: proposals in a row without a worthwhile gain.
    restarts: starts elsewhere that are left. kind: of the next proposal. patience: proposals in a row without
    a worthwhile gain that end the search, or start it anew elsewhere.
    """

    kind: ProposalKind = PROPOSAL_CYCLE[0]
    aversion: float = 0.1
    region: TrustRegion = FIRST_REGION
    idle: int = 0
    restarts: int = RESTARTS
    patience: int = EGO_PATIENCE

    def after(self, gain: float, best: float) -> Strategy:
        """After a round that raised the best rating from `best` by `gain`."""
        won = gain > GAIN * max(abs(best), 1e-3)
        aversion, region = self.aversion, self.region
        if self.kind == "Gauss-Newton":
            aversion = float(np.clip(aversion * (DARE if won else FEAR), *AVERSION))
        if self.kind == "trust region":
            region = region.after(float(won))
        new = replace(self, aversion=aversion, region=region, idle=0 if won else self.idle + 1)
        if new.idle >= self.patience and self.restarts:
            return Strategy(kind="restart", restarts=self.restarts - 1, patience=self.patience)
        return replace(new, kind=self.kind if won and self.kind != "restart" else self.following(self.kind))

    @property
    def stopped(self) -> str:
        """Why the search is over; empty while it goes on."""
        if self.idle < self.patience:
            return ""
        return f"{self.patience} proposals in a row gained less than {100.0 * GAIN:g} % of the rating"

    @staticmethod
    def following(kind: ProposalKind) -> ProposalKind:
        """The kind after another in the cycle; after a restart the first."""
        place = PROPOSAL_CYCLE.index(kind) + 1 if kind in PROPOSAL_CYCLE else 0
        return PROPOSAL_CYCLE[place % len(PROPOSAL_CYCLE)]

    def others(self) -> tuple[ProposalKind, ...]:
        """Kinds to turn to, in order, when this one proposes a design that is known already."""
        start = PROPOSAL_CYCLE.index(self.kind) if self.kind in PROPOSAL_CYCLE else -1
        return tuple(
            PROPOSAL_CYCLE[(start + 1 + i) % len(PROPOSAL_CYCLE)] for i in range(len(PROPOSAL_CYCLE))
        )
