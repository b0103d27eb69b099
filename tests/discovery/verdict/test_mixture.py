"""Sizes over laws: what two laws that fit as well do not agree on is not known."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from doe_kc.discovery.fit import Fit, amplitude_estimates
from doe_kc.discovery.search.law_variants import open_laws
from doe_kc.discovery.search.refits import HypothesisFit
from doe_kc.discovery.verdict.mixture import (
    spread_between_laws,
    spread_between_optima,
    spread_in_larger_sets,
)
from doe_kc.ground.typing import FloatArray
from tests.discovery.cases import discovery


@pytest.fixture(scope="module")
def closed() -> Fit:
    return discovery("pair").search.with_effects


def other(closed: Fit, moved: FloatArray, cost: float) -> Fit:
    """As if the same set had ended at other sizes."""
    z = closed.z.copy()
    z[closed.model.dimension :] += moved
    return replace(closed, z=z, cost=closed.cost + cost)


def test_laws_that_fit_as_well_count_alike(closed: Fit) -> None:
    moved = np.arange(1.0, closed.amplitudes.size + 1)
    free = other(closed, moved, 0.0)
    for member, place in closed.model.places():
        own = amplitude_estimates(free, member)[0]
        there = slice(place.start - closed.model.dimension, place.stop - closed.model.dimension)
        np.testing.assert_allclose(
            spread_between_laws(member, own, free, closed), moved[there] / np.sqrt(2.0)
        )


@pytest.mark.parametrize(("cost", "share"), [(-20.0, 0.0), (-2.0, 0.26894), (2.0, 0.73106), (20.0, 1.0)])
def test_the_law_that_fits_better_counts_more(closed: Fit, cost: float, share: float) -> None:
    free = other(closed, np.ones(closed.amplitudes.size), cost)
    member = closed.model.members[0]
    own = amplitude_estimates(free, member)[0]
    np.testing.assert_allclose(spread_between_laws(member, own, free, closed) ** 2, share, atol=1e-4)


def test_numbers_of_another_law_are_not_compared(closed: Fit) -> None:
    member = next(h for h in closed.model.members if open_laws(h))
    law = open_laws(member)[-1]
    spread = spread_between_laws(law, np.full(len(law.sizes), 9.0), closed, closed)
    apart = [not s.shape and s.name in {known.name for known in member.sizes} for s in law.sizes]
    np.testing.assert_array_equal(spread > 0.0, apart)


def test_without_other_laws_there_is_no_spread(closed: Fit) -> None:
    member = closed.model.members[0]
    assert not spread_between_laws(member, np.ones(2), closed, None).any()


def test_a_larger_set_counts_by_its_odds_and_not_for_its_law(closed: Fit) -> None:
    friction = next(h for h in closed.model.members if open_laws(h) or h.law)
    own, sd = amplitude_estimates(closed, friction)
    moved = np.ones(closed.amplitudes.size)
    hub = closed.model.members[0]
    even = HypothesisFit(hub, other(closed, moved, 0.0), 0.0)
    np.testing.assert_allclose(spread_in_larger_sets(friction, own, sd, [even]), np.sqrt(0.5))
    likelier = replace(even, gain=2.0)
    np.testing.assert_allclose(spread_in_larger_sets(friction, own, sd, [likelier]) ** 2, 0.880797, atol=1e-6)
    assert not spread_in_larger_sets(friction, own, sd, []).any()
    law = replace(friction, law="another")
    numbers = spread_in_larger_sets(law, own, sd, [even])
    np.testing.assert_array_equal(numbers > 0.0, [not size.shape for size in law.sizes])


def test_what_is_less_sure_in_a_larger_set_is_less_sure(closed: Fit) -> None:
    """215 N were 159 N without a mount, 160 to 195 N with one."""
    member = closed.model.members[0]
    own, sd = amplitude_estimates(closed, member)
    same = HypothesisFit(member, closed, 0.0)
    assert not spread_in_larger_sets(member, own, sd, [same]).any()
    surer = spread_in_larger_sets(member, own, 0.5 * sd, [same])
    np.testing.assert_allclose(surer, np.sqrt(0.5 * 0.75) * sd)
    assert not spread_in_larger_sets(member, own, 2.0 * sd, [same]).any()


def test_optima_that_fit_as_well_count_alike(closed: Fit) -> None:
    member = closed.model.members[0]
    own, _ = amplitude_estimates(closed, member)
    moved = np.ones(closed.amplitudes.size)
    optima = [other(closed, moved, 8.0), other(closed, 2.0 * moved, 0.0)]
    np.testing.assert_allclose(spread_between_optima(member, own, optima), np.sqrt(5.0 / 3.0))
    assert not spread_between_optima(member, own, []).any()
