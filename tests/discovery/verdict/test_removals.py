"""Effects taken out of the last set: what each is worth."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from doe_kc.correlation.likelihood import Likelihood
from doe_kc.discovery.fit import Fit, cost_of
from doe_kc.discovery.gauss_newton import refit_to_errors
from doe_kc.discovery.search import convergence
from doe_kc.discovery.search.effect_search import EffectSearch
from doe_kc.discovery.verdict.alternatives import alternatives
from doe_kc.discovery.verdict.removals import removals
from doe_kc.discovery.workers import DiscoveryWorkers
from tests.discovery.cases import discovery


def losses(search: EffectSearch) -> list[float]:
    """ln evidence lost by each member of the last set."""
    members = search.with_law_discrepancy.model.members
    every = removals(search, members, DiscoveryWorkers())
    return [one.base.evidence - one.without.evidence for one in every]


def test_each_loses_what_its_comparison_says() -> None:
    search, workers = discovery("pair").search, DiscoveryWorkers()
    members = search.with_law_discrepancy.model.members
    own = removals(search, members, workers)
    assert [r.base.model.members[-1] for r in own] == list(members)
    assert all(m not in r.without.model.members for r, m in zip(own, members, strict=True))
    compared = alternatives(search, 1.0, workers)
    assert [one.loss for one in compared] == pytest.approx(losses(search))


def test_what_a_member_is_worth_is_taken_at_the_optimum_with_it(monkeypatch: pytest.MonkeyPatch) -> None:
    """A bushing's progression worth 73 of ln evidence was told as a trace, its loss -94: derivatives of a fit
    nearby had left the one with it short."""
    search = discovery("pair").search
    members = search.with_law_discrepancy.model.members
    expected, lost = removals(search, members, DiscoveryWorkers()), losses(search)

    def short(fit: Fit, errors: Likelihood) -> Fit:
        known = refit_to_errors(fit, errors)
        z = known.z + 0.05 * (np.arange(known.z.size) >= known.model.dimension)
        residual = known.model.residual(z)
        return replace(known, z=z, residual=residual, cost=cost_of(known.model, z, residual), converged=False)

    monkeypatch.setattr(convergence, "refit_to_errors", short)
    found = removals(search, members, DiscoveryWorkers())
    for ours, theirs in zip(found, expected, strict=True):  # a free shape's cost is rough, and may end lower
        assert -0.5 < ours.base.evidence - theirs.base.evidence < 2.0
    # without one of both the cost is a hundred thousand, and rough
    assert losses(search) == pytest.approx(lost, rel=1e-3)
