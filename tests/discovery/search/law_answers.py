"""Fits of laws without fitting: what the tests of laws ask."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from doe_kc.correlation.likelihood import Likelihood
from doe_kc.discovery.fit import Fit
from doe_kc.discovery.gauss_newton import FitStart
from doe_kc.discovery.model import EffectModel
from doe_kc.discovery.workers import DiscoveryWorkers
from doe_kc.effects import EFFECTS
from doe_kc.effects.hypothesis import Hypothesis
from doe_kc.ground.typing import FloatArray
from tests.discovery.cases import discovery, library

CLOSED = ["iwan", "duhem", "lognormal"]
"""Closed laws of a friction beside its default one."""


class Answers(DiscoveryWorkers):
    """Gives the fit of the start itself, better or worse by some cost, and notes the laws asked for."""

    def __init__(self, cost: float, best: str = "") -> None:
        """best: a law whose cost is 100 less than that of another."""
        super().__init__()
        self.cost, self.best, self.laws = cost, best, [""] * 0

    def fits(
        self,
        starts: Sequence[FitStart],
        what: str,
        *,
        derivatives: Callable[[Fit], bool] = lambda _: True,
        enough: Callable[[Fit | None], bool] | None = None,
    ) -> list[Fit | None]:
        first = self._answers(starts[:1])
        return (
            first
            if not first or (enough is not None and enough(first[0]))
            else [*first, *self._answers(starts[1:])]
        )

    def _answers(self, starts: Sequence[FitStart]) -> list[Fit | None]:
        laws = [self._law(s.model) for s in starts]
        self.laws += laws
        exchanged = [law == self.best != self._law(s.near.model) for s, law in zip(starts, laws, strict=True)]
        return [
            self._fit(s.model, s.z, s.near, self.cost - 100.0 * better)
            for s, better in zip(starts, exchanged, strict=True)
        ]

    @staticmethod
    def _law(model: EffectModel) -> str:
        return next(h.law for h in model.members if len(EFFECTS[h.effect].variants(h)) > 1)

    def _fit(self, model: EffectModel, z: FloatArray, found: Fit, cost: float) -> Fit:
        more, known = z.size - found.z.size, found.jacobian.own
        none = np.zeros((found.residual.size, max(more, 0)))  # that are the last where a law has fewer
        jacobian = model.jacobian(np.hstack([known[:, : known.shape[1] + min(more, 0)], none]))
        return replace(found, model=model, z=z, jacobian=jacobian, cost=found.cost + cost)


def agreeing() -> Fit:
    return discovery("friction").search.with_law_discrepancy


def records() -> Likelihood:
    """The records' own errors."""
    return discovery("friction").search.tuned.model.likelihood


def disagreeing() -> Fit:
    residual = agreeing().residual.copy()
    residual[:60] += 5.0
    return replace(agreeing(), residual=residual)


def beside_a_hub() -> Fit:
    """The friction by its default law, and a hub of no size, which moves nothing."""
    (hub,) = library("hub_compliance")
    return with_member(agreeing(), hub)


def with_rubber(found: Fit) -> Fit:
    """A fit and rubber of no size in all bushings, which moves nothing."""
    return with_member(found, EFFECTS["rubber_hysteresis"].hypotheses()[0])


def with_member(found: Fit, further: Hypothesis) -> Fit:
    """A fit and a further effect of no size."""
    none = np.zeros(len(further.sizes))
    model, z = found.model.extended(further), np.append(found.z, none)
    own = np.hstack([found.jacobian.own, np.zeros((found.residual.size, none.size))])
    return replace(found, model=model, z=z, jacobian=model.jacobian(own))


def rubber_alone() -> Fit:
    """Rubber of no size, which moves nothing."""
    rubber = EFFECTS["rubber_hysteresis"].hypotheses()[0]
    found, count = agreeing(), len(rubber.sizes)
    (friction,) = found.model.members
    model = found.model.with_member(friction, rubber)
    rest = found.z.size - len(friction.sizes)
    own = np.hstack([found.jacobian.own[:, : -len(friction.sizes)], np.zeros((found.residual.size, count))])
    z = np.append(found.z[:rest], np.zeros(count))
    return replace(found, model=model, z=z, jacobian=model.jacobian(own))
