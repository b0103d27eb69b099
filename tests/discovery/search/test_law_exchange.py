"""Another law of a friction at the end of a search: weighed with what it asks for, kept where that helps."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import pytest

from doe_kc.discovery.fit import Fit
from doe_kc.discovery.gauss_newton import FitStart
from doe_kc.discovery.search import law_exchange
from doe_kc.discovery.search.law_exchange import promise, with_exchanged_laws
from doe_kc.discovery.search.search import EffectSearch
from doe_kc.discovery.workers import DiscoveryWorkers
from doe_kc.effects.hypothesis import Hypothesis
from tests.discovery.cases import discovery, known_to
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
    def promised(_: EffectSearch, fit: Fit) -> float:
        return 100.0 if fit.model.members[0].law == law else 5.0

    monkeypatch.setattr(law_exchange, "promise", promised)
    asked = Answers(150.0)
    assert with_exchanged_laws(search, [], asked) is search, "no more probable where it leads to"
    assert asked.laws == LAWS and taken == [law]
    assert with_exchanged_laws(search, [], Answers(150.0)) is not search
    assert taken == [law, law]


def test_a_law_that_promises_less_than_it_loses_is_left_alone(
    search: EffectSearch, taken: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(law_exchange, "promise", lambda *_: 70.0)
    assert with_exchanged_laws(search, [], Answers(150.0)) is search
    assert taken == []


def test_a_set_promises_what_it_lacks_to_first_order() -> None:
    ended = discovery("named").search
    assert promise(ended, ended.first.before) > 100.0
    assert promise(ended, ended.with_effects) < 5.0


class NoSolution(DiscoveryWorkers):
    def fits(self, starts: Sequence[FitStart], what: str, **_: object) -> list[Fit | None]:
        return [None for _ in starts]


def test_laws_without_an_equilibrium_are_passed_over(search: EffectSearch) -> None:
    assert with_exchanged_laws(search, [], NoSolution()) is search
