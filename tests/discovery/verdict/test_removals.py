"""Effects taken out of the last set: what each is worth, a few of them in memory at a time."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
import pytest

from doe_kc.correlation.likelihood import Likelihood
from doe_kc.discovery.fit import Fit, cost_of
from doe_kc.discovery.gauss_newton import FitStart, refit_to_errors
from doe_kc.discovery.search import convergence
from doe_kc.discovery.verdict import removals as removals_module
from doe_kc.discovery.verdict.alternatives import alternatives
from doe_kc.discovery.verdict.removals import in_groups, removals
from doe_kc.discovery.workers import DiscoveryWorkers
from tests.discovery.cases import discovery


class Counted(DiscoveryWorkers):
    """Notes how many fits were asked for at once, and whether those kept their derivatives."""

    def __init__(self) -> None:
        super().__init__()
        self.asked: list[tuple[int, bool]] = []

    def fits(
        self,
        starts: Sequence[FitStart],
        what: str,
        *,
        derivatives: Callable[[Fit], bool] = lambda _: True,
        enough: Callable[[Fit | None], bool] | None = None,
    ) -> list[Fit | None]:
        found = super().fits(starts, what, derivatives=derivatives, enough=enough)
        if what == "taking effects out":
            self.asked.append((len(starts), any(f is not None and derivatives(f) for f in found)))
        return found


def test_members_are_taken_a_few_at_a_time() -> None:
    assert in_groups([1, 2, 3, 4, 5, 6, 7]) == [[1, 2, 3], [4, 5, 6], [7]]
    assert in_groups([]) == []


def test_each_loses_what_its_comparison_says(monkeypatch: pytest.MonkeyPatch) -> None:
    search, workers = discovery("pair").search, Counted()
    monkeypatch.setattr(removals_module, "AT_ONCE", 1)
    found = removals(search, workers)
    assert [r.base.model.members[-1] for r in found] == list(search.with_law_discrepancy.model.members)
    assert workers.asked == [(1, False)] * 2
    compared = alternatives(search, 1.0, workers)
    assert [one.loss for one in compared] == pytest.approx([r.loss for r in found])
    assert workers.asked[4:] == [(1, True)] * 2, "one after the other, from the cache of results"
    at_once = alternatives(search, 1.0, DiscoveryWorkers())
    assert [one.loss for one in at_once] == pytest.approx([r.loss for r in found], rel=1e-12)


def test_what_a_member_is_worth_is_taken_at_the_optimum_with_it(monkeypatch: pytest.MonkeyPatch) -> None:
    """A bushing's progression worth 73 of ln evidence was told as a trace, its loss -94: derivatives of a fit
    nearby had left the one with it short."""
    search = discovery("pair").search
    expected = removals(search, DiscoveryWorkers())

    def short(fit: Fit, errors: Likelihood) -> Fit:
        known = refit_to_errors(fit, errors)
        z = known.z + 0.05 * (np.arange(known.z.size) >= known.model.dimension)
        residual = known.model.residual(z)
        return replace(known, z=z, residual=residual, cost=cost_of(known.model, z, residual), converged=False)

    monkeypatch.setattr(convergence, "refit_to_errors", short)
    found = removals(search, DiscoveryWorkers())
    for ours, theirs in zip(found, expected, strict=True):  # a free shape's cost is rough, and may end lower
        assert -0.5 < ours.base.evidence - theirs.base.evidence < 2.0
    # without one of both the cost is a hundred thousand, and rough
    assert [r.loss for r in found] == pytest.approx([r.loss for r in expected], rel=1e-3)
