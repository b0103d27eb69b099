"""Exchanges: a last set that a rival in one effect's place betters is not where the search ends."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from doe_kc.discovery.search.refits import HypothesisFit
from doe_kc.discovery.search.search import EffectSearch
from doe_kc.discovery.verdict.alternatives import Alternatives, alternatives
from doe_kc.discovery.verdict.exchange import better_rival, exchanged
from doe_kc.discovery.workers import DiscoveryWorkers
from tests.discovery.cases import discovery, known_to

TRUE, WRONG = "hub_compliance", "strut_bending"


def with_gains(one: Alternatives, *gains: float, temper: float = 1.0) -> Alternatives:
    first = one.trials[0]
    trials = (first, *(HypothesisFit(first.hypothesis, first.fit, first.gain + g) for g in gains))
    return replace(one, trials=trials, temper=temper)


@pytest.fixture(scope="module")
def right() -> EffectSearch:
    return discovery("named").search


@pytest.fixture(scope="module")
def wrong(right: EffectSearch) -> EffectSearch:
    """The search as if it had ended with another effect than the true one."""
    refit = next(t.fit for t in right.first.trials if t.hypothesis.effect == WRONG)
    return replace(right, with_law_discrepancy=refit, with_effects=refit, discrepancy_shares={WRONG: 0.0})


def test_the_search_goes_on_from_a_rival_that_is_more_probable(
    right: EffectSearch, wrong: EffectSearch
) -> None:
    again, compared = exchanged(wrong, known_to("named"), DiscoveryWorkers())
    assert [h.effect for h in again.with_effects.model.members] == [TRUE]
    assert [c.hypothesis.effect for c in compared] == [TRUE]
    np.testing.assert_allclose(again.with_effects.z, right.with_effects.z, atol=0.02)
    step = again.steps[len(wrong.steps)]
    assert [h.effect for h in step.members] == [WRONG]
    assert [h.effect for h in step.added] == [TRUE]
    assert step.accepted and step.candidates[0].gain > 100.0


def test_a_search_that_no_rival_betters_stays(right: EffectSearch) -> None:
    again, _ = exchanged(right, known_to("named"), DiscoveryWorkers())
    assert again is right


def test_a_rival_needs_the_odds_of_an_effect_that_is_accepted(right: EffectSearch) -> None:
    (one,) = alternatives(right, 1.0, DiscoveryWorkers())
    assert better_rival([with_gains(one, 4.0, -3.0)]) is None
    assert better_rival([with_gains(one, 9.0, temper=2.0)]) is None
    better = better_rival([with_gains(one, 5.0), with_gains(one, 4.0, 8.0)])
    assert better is not None and better[2] == pytest.approx(8.0)
