"""Exchanges: a last set that a rival or nothing in one effect's place betters is not where a search ends."""

from __future__ import annotations

import gc
import weakref
from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from doe_kc.discovery.fit import Fit
from doe_kc.discovery.gauss_newton import FitStart
from doe_kc.discovery.search.effect_search import EffectSearch
from doe_kc.discovery.search.refits import HypothesisFit
from doe_kc.discovery.verdict import alternatives as alternatives_module
from doe_kc.discovery.verdict import exchange as exchange_module
from doe_kc.discovery.verdict.alternatives import Alternatives, alternatives
from doe_kc.discovery.verdict.exchange import better_set, exchanged
from doe_kc.discovery.verdict.removals import Removal
from doe_kc.discovery.workers import DiscoveryWorkers
from doe_kc.effects.hypothesis import Hypothesis
from tests.discovery.cases import discovery, known_to

TRUE, WRONG, NEEDLESS = "hub_compliance", "strut_bending", "tie_rod_compliance"


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


@pytest.fixture(scope="module")
def more(right: EffectSearch) -> EffectSearch:
    """The search as if it had ended with a needless effect beside the true one."""
    last = right.with_effects
    (needless,) = (h for h in known_to("named") if h.name == NEEDLESS)
    start = FitStart(last.model.extended(needless), np.append(last.z, 0.05), last)
    (both,) = DiscoveryWorkers().fits([start], "")
    assert both is not None
    shares = {TRUE: 0.0, NEEDLESS: 0.0}
    return replace(right, with_law_discrepancy=both, with_effects=both, discrepancy_shares=shares)


def test_the_search_goes_on_without_an_effect_whose_removal_is_more_probable(
    right: EffectSearch, more: EffectSearch
) -> None:
    again, compared = exchanged(more, known_to("named"), DiscoveryWorkers())
    assert [h.effect for h in again.with_effects.model.members] == [TRUE]
    assert [c.hypothesis.effect for c in compared] == [TRUE]
    np.testing.assert_allclose(again.with_effects.amplitudes, right.with_effects.amplitudes, atol=0.01)
    following = again.steps[len(more.steps)]
    assert [h.effect for h in following.members] == [TRUE] and not following.added


def test_once_an_effect_is_exchanged_the_stronger_ones_are_not_compared(
    more: EffectSearch, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Of a set of six that took 7 of 67 seconds, for a set that is not the last one."""
    monkeypatch.setattr(alternatives_module, "AT_ONCE", 1)
    asked: list[str] = []
    own = alternatives_module.removals

    def noted(
        search: EffectSearch, members: Sequence[Hypothesis], workers: DiscoveryWorkers
    ) -> list[Removal]:
        asked.extend(h.name for h in members)
        return own(search, members, workers)

    monkeypatch.setattr(alternatives_module, "removals", noted)
    exchanged(more, known_to("named"), DiscoveryWorkers())
    assert asked == [NEEDLESS, TRUE], "the needless one, and the true one alone in the set that followed"


def test_an_exchange_that_ends_no_more_probable_is_not_made(
    right: EffectSearch, more: EffectSearch, monkeypatch: pytest.MonkeyPatch
) -> None:
    """All members are compared then."""
    asked: list[EffectSearch] = []
    monkeypatch.setattr(exchange_module, "search_from", lambda search, *_: asked.append(search) or search)
    again, compared = exchanged(more, known_to("named"), DiscoveryWorkers())
    assert again is more and asked == [more]
    assert [c.hypothesis.name for c in compared] == [h.name for h in more.with_effects.model.members]


def test_what_was_compared_is_let_go_before_the_next_set_is(
    more: EffectSearch, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The fits of both sets at once took 50 MB more."""
    left: list[weakref.ref[Fit]] = []
    known: list[int] = []
    own = exchange_module.alternatives_by_group

    def noted(*args: Any) -> Iterator[list[Alternatives]]:
        gc.collect()
        known.append(sum(fit() is not None for fit in left))
        for group in own(*args):
            left.extend(weakref.ref(one.without) for one in group)
            yield group

    monkeypatch.setattr(exchange_module, "alternatives_by_group", noted)
    exchanged(more, known_to("named"), DiscoveryWorkers())
    assert known == [0, 0] and len(left) > 1


def test_a_search_that_no_rival_betters_stays(right: EffectSearch) -> None:
    again, _ = exchanged(right, known_to("named"), DiscoveryWorkers())
    assert again is right


def test_a_rival_needs_the_odds_of_an_effect_that_is_accepted(right: EffectSearch) -> None:
    (one,) = alternatives(right, 1.0, DiscoveryWorkers())
    assert better_set([with_gains(one, 4.0, -3.0)]) is None
    assert better_set([with_gains(one, 9.0, temper=2.0)]) is None
    better = better_set([with_gains(one, 5.0), with_gains(one, 4.0, 8.0)])
    assert better is not None and better.gain == pytest.approx(8.0)


def test_nothing_in_a_place_needs_those_odds_too(right: EffectSearch) -> None:
    (one,) = alternatives(right, 1.0, DiscoveryWorkers())
    needless = with_gains(replace(one, trials=(replace(one.trials[0], gain=-4.0),)))
    assert better_set([needless]) is None
    needless = with_gains(replace(one, trials=(replace(one.trials[0], gain=-5.0),)))
    better = better_set([needless])
    assert better is not None and better.rival is None and better.fit is one.without
    assert better.own == one.hypothesis and better.gain == pytest.approx(5.0)
    better = better_set([with_gains(needless, 6.0)])
    assert better is not None and better.rival is not None and better.gain == pytest.approx(6.0)
