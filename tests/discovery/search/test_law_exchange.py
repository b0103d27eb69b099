"""Another law of a friction at the end of a search: weighed with what it asks for, kept where that helps."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import pytest

from doe_kc.discovery.fit import Fit
from doe_kc.discovery.gauss_newton import FitStart
from doe_kc.discovery.search import law_exchange
from doe_kc.discovery.search.effect_search import EffectSearch
from doe_kc.discovery.search.law_exchange import proposed, with_exchanged_laws
from doe_kc.discovery.search.law_variants import open_laws
from doe_kc.discovery.search.proposals import SetProposal
from doe_kc.discovery.search.refits import HypothesisFit
from doe_kc.discovery.workers import DiscoveryWorkers
from doe_kc.effects.hypothesis import Hypothesis
from tests.discovery.cases import discovery, known_to, library
from tests.discovery.search.test_laws import Answers, agreeing, disagreeing

LAWS = ["iwan", "duhem", "lognormal"]


@pytest.fixture
def search() -> EffectSearch:
    """A search that ended with a friction beside which something remains."""
    return replace(discovery("friction").search, with_law_discrepancy=disagreeing())


@pytest.fixture
def taken(search: EffectSearch, monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """Laws that the search goes on with, each to a set that is more probable than the last one by their count
    less one."""
    laws: list[str] = []

    def gone_on(before: EffectSearch, start: FitStart, changed: Hypothesis, *_: object) -> EffectSearch:
        laws.append(changed.law)
        assert changed in start.model.members
        last = before.with_law_discrepancy
        return replace(before, with_law_discrepancy=replace(last, cost=last.cost - 2.0 * (len(laws) - 1)))

    monkeypatch.setattr(law_exchange, "search_from", gone_on)
    return laws


def test_where_noise_explains_what_remains_no_law_is_asked_for() -> None:
    asked, ended = Answers(-100.0), discovery("friction").search
    assert agreeing() is ended.with_law_discrepancy
    assert with_exchanged_laws(ended, known_to("friction"), asked) is ended
    assert asked.laws == []


@pytest.mark.parametrize("law", ["iwan", "lognormal"])
def test_a_law_counts_with_the_effects_that_it_asks_for(
    search: EffectSearch, taken: list[str], law: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    def promised(_: EffectSearch, fit: Fit) -> SetProposal:
        return _proposal(fit, 100.0 if fit.model.members[0].law == law else 5.0)

    monkeypatch.setattr(law_exchange, "proposed", promised)
    asked = Answers(150.0)
    assert with_exchanged_laws(search, [], asked) is search, "no more probable where it leads to"
    assert asked.laws == LAWS and taken == [law]
    assert with_exchanged_laws(search, [], Answers(150.0)) is not search
    assert taken == [law, law]


@pytest.mark.parametrize(
    ("promise", "refit", "left"),
    [(70.0, 0.0, False), (60.0, -40.0, False), (60.0, -100.0, True), (40.0, -100.0, False)],
    ids=["a promise alone", "not kept", "kept and more", "too little to ask"],
)
def test_a_law_whose_promise_is_little_less_than_it_loses_is_refitted_with_what_it_asks_for(
    search: EffectSearch,
    taken: list[str],
    monkeypatch: pytest.MonkeyPatch,
    promise: float,
    refit: float,
    left: bool,
) -> None:
    """A mount of the rack promised 90 and brought 165, where the law lost 125. refit: cost of the set."""

    def promised(_: EffectSearch, fit: Fit) -> SetProposal | None:
        return _proposal(fit, promise) if fit.model.members[0].law == "iwan" else None

    def refitted(fit: Fit, proposals: Sequence[SetProposal], *_: object) -> list[HypothesisFit]:
        assert fit.model.members[0].law == "iwan" and proposals[0].gain == promise
        return [HypothesisFit(fit.model.members[-1], fit, -0.5 * refit + 50.0)]

    monkeypatch.setattr(law_exchange, "proposed", promised)
    monkeypatch.setattr(law_exchange, "set_refits", refitted)
    assert with_exchanged_laws(search, [], Answers(150.0)) is search
    assert bool(taken) is left


def _proposal(fit: Fit, gain: float) -> SetProposal:
    return SetProposal(fit.model.members, fit.amplitudes, gain)


def test_a_friction_that_the_search_gave_a_free_shape_is_asked_where_noise_explains_the_rest(
    taken: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """The free shape of a steering friction had taken up a mount of the rack that came too late."""
    ended = discovery("friction").search
    assert agreeing() is ended.with_law_discrepancy
    free = open_laws(agreeing().model.members[0])[-1]
    freed = replace(ended, steps=(*ended.steps, replace(ended.steps[-1], members=(free,))))

    def promised(_: EffectSearch, fit: Fit) -> SetProposal:
        return _proposal(fit, 100.0)

    monkeypatch.setattr(law_exchange, "proposed", promised)
    assert with_exchanged_laws(freed, [], Answers(150.0)) is freed and taken == ["iwan"]


def test_a_set_promises_what_it_lacks_to_first_order() -> None:
    ended = discovery("named").search
    asked = proposed(ended, ended.first.before)
    assert asked is not None and asked.gain > 100.0
    own = proposed(ended, ended.with_effects)
    assert own is None or own.gain < 5.0


class NoSolution(DiscoveryWorkers):
    def fits(self, starts: Sequence[FitStart], what: str, **_: object) -> list[Fit | None]:
        return [None for _ in starts]


def test_laws_without_an_equilibrium_are_passed_over(search: EffectSearch) -> None:
    assert with_exchanged_laws(search, [], NoSolution()) is search


def test_a_set_by_another_law_may_have_lost_the_friction(
    search: EffectSearch, monkeypatch: pytest.MonkeyPatch
) -> None:
    """What a better set asks for may stand in its place."""
    friction, hub = search.with_effects.model.members[0], library("hub_compliance")[0]
    told: list[Hypothesis | None] = []

    def gone_on(
        before: EffectSearch, start: FitStart, changed: Hypothesis | None, *_: object
    ) -> EffectSearch:
        told.append(changed)
        return before

    monkeypatch.setattr(law_exchange, "search_from", gone_on)
    for added in ((), (hub,)):

        def without(
            _: EffectSearch, fit: Fit, *__: object, added: tuple[Hypothesis, ...] = added
        ) -> tuple[Fit, float]:
            own = next(h for h in fit.model.members if h.name == friction.name)
            return replace(fit, model=replace(fit.model.without(own), members=added)), 100.0

        monkeypatch.setattr(law_exchange, "_best_set", without)
        assert with_exchanged_laws(search, [], Answers(150.0)) is search
    assert told == [None, hub]
