"""Rubber of all bushings that came in as that of two groups of them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from doe_kc.discovery.gauss_newton import FitStart, fit
from doe_kc.discovery.search import all_places
from doe_kc.discovery.search.all_places import with_all_places
from doe_kc.discovery.search.effect_search import EffectSearch
from doe_kc.discovery.search.law_variants import open_laws
from doe_kc.discovery.search.set_prior import SetPrior
from doe_kc.discovery.workers import DiscoveryWorkers
from doe_kc.effects.hypothesis import Hypothesis
from tests.discovery.cases import discovery, library, model

EVERYWHERE, REAR, REST = library("rubber_hysteresis")


def ended(car: str, *members: Hypothesis) -> EffectSearch:
    """A search that ended with some members."""
    begun, sizes = model(car), [0.0 if size.shape else 1.0 for h in members for size in h.sizes]
    for member in members:
        begun = begun.extended(member)
    last = fit(begun, np.append(np.zeros(begun.dimension), sizes))
    prior = SetPrior.of(library("rubber_hysteresis", "hub_compliance"))
    return replace(
        discovery("friction").search,
        with_law_discrepancy=last,
        with_effects=last,
        prior=prior,
        shape_loss=0.0,
    )


@pytest.fixture
def taken(monkeypatch: pytest.MonkeyPatch) -> list[FitStart]:
    """Sets that the search goes on from, each to one more probable than the last one."""
    starts: list[FitStart] = []

    def gone_on(before: EffectSearch, start: FitStart, changed: Hypothesis, *_: object) -> EffectSearch:
        assert changed == EVERYWHERE
        starts.append(start)
        last = before.with_law_discrepancy
        return replace(before, with_law_discrepancy=replace(last, cost=last.cost - 1.0))

    monkeypatch.setattr(all_places, "search_from", gone_on)
    return starts


def test_rubber_of_two_groups_is_told_as_that_of_all_bushings(taken: list[FitStart]) -> None:
    before = ended("rubber", REST, REAR)
    assert with_all_places(before, library("rubber_hysteresis"), DiscoveryWorkers()) is not before
    (start,) = taken
    assert [h.name for h in start.model.members] == [EVERYWHERE.name]
    share = next(s for s in EVERYWHERE.sizes if s.key == "share")
    told = share.value(start.model.sizes_at(start.z, start.model.members[0])["share"])
    assert told == pytest.approx(0.3, rel=0.1)


def test_rubber_of_one_group_stays_where_it_is(taken: list[FitStart]) -> None:
    before = ended("rear_rubber", REST, REAR)
    assert with_all_places(before, library("rubber_hysteresis"), DiscoveryWorkers()) is before
    assert not taken


def test_bushings_that_differ_do_so_in_all_places_too(taken: list[FitStart]) -> None:
    (unlike,) = open_laws(REST)[-1:]
    with_all_places(ended("rubber", unlike, REAR), library("rubber_hysteresis"), DiscoveryWorkers())
    assert [start.model.members[-1].law for start in taken] == [open_laws(EVERYWHERE)[-1].law]


def test_a_set_with_one_place_or_none_asks_for_nothing(taken: list[FitStart]) -> None:
    class NoFits(DiscoveryWorkers):
        def fits(self, *_: object, **__: object) -> list[None]:  # type: ignore[override]
            raise AssertionError

    for members in ((REAR,), library("hub_compliance")):
        before = ended("rubber", *members)
        assert with_all_places(before, library("rubber_hysteresis", "hub_compliance"), NoFits()) is before
    assert not taken
