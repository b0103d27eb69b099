"""Backward elimination: a member is judged by errors that do not hold its own law."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from doe_kc.discovery.fit import Fit, rewhitened_fit
from doe_kc.discovery.gauss_newton import FitStart, fit, known_columns, refit_to_errors
from doe_kc.discovery.search.convergence import at_optimum
from doe_kc.discovery.search.law_discrepancy import effect_signals, with_discrepancy, without_own_discrepancy
from doe_kc.discovery.search.member_state import MemberState, TriedRemoval
from doe_kc.discovery.search.pruning import backward_elimination
from doe_kc.discovery.search.set_prior import SetPrior
from doe_kc.discovery.thresholds import ACCEPTED_ODDS, BEYOND_DOUBT
from doe_kc.discovery.workers import DiscoveryWorkers
from doe_kc.effects.hypothesis import Hypothesis
from tests.discovery.cases import library, model


class Watched(DiscoveryWorkers):
    """Keeps where fits of removals begin."""

    def __init__(self) -> None:
        super().__init__()
        self.starts: list[list[FitStart]] = []

    def fits(self, given: Sequence[FitStart], what: str, **more: Any) -> list[Fit | None]:
        if what == "taking effects out" and given:
            self.starts.append(list(given))
        return super().fits(given, what, **more)


def pruned(
    found: Fit,
    least: float,
    known: MemberState | None = None,
    prior: SetPrior | None = None,
    workers: DiscoveryWorkers | None = None,
) -> Fit:
    asked = workers or DiscoveryWorkers()
    return backward_elimination(found, least, asked, known or MemberState(), prior or SetPrior({})).fit


def two_fitted() -> tuple[Fit, Hypothesis]:
    """A car with a compliant hub, fitted with that and a strut that bends; the hub."""
    (hub,), (bent,) = library("hub_compliance"), library("strut_bending")
    both = model("named").extended(hub).extended(bent)
    return fit(both, np.append(both.centre[: both.dimension], np.ones(len(both.sizes)))), hub


def test_an_effect_does_not_pass_for_the_law_that_was_granted_to_it() -> None:
    """Errors of half of what the hub does to every curve explain it away; errors without them do not."""
    exact, hub = hub_fitted()
    wide = with_discrepancy(exact.model.likelihood, effect_signals(exact, DiscoveryWorkers()), [0.5])
    begun = rewhitened_fit(exact, wide)
    found = fit(begun.model, exact.z, known=known_columns(begun, begun.model))
    fooled = _loss(found, hub)
    own = _loss(refit_to_errors(found, exact.model.likelihood), hub)
    assert own > 1.5 * fooled
    between = float(np.sqrt(own * fooled))
    prior = SetPrior({})
    least = between + prior.log_odds([], hub)
    assert hub not in pruned(found, least, prior=prior).model.members
    own_errors = {hub.name: exact.model.likelihood}
    judged = pruned(found, least, MemberState(without_own=own_errors), prior)
    assert hub in judged.model.members
    assert judged.model.likelihood is wide


def test_a_removal_beyond_doubt_is_given_up() -> None:
    """The hub is worth thousands: its removal needs no end."""
    exact, hub = hub_fitted()
    assert _loss(exact, hub) > 2.0 * BEYOND_DOUBT
    workers, least = Watched(), 1e6  # so that the removal is tried
    found = pruned(exact, least, workers=workers)
    assert [s.ceiling for (s,) in workers.starts] == [exact.cost + 2.0 * BEYOND_DOUBT]
    assert found.model.members == ()


def test_one_member_goes_at_a_time_the_least_needed_first() -> None:
    """What is needless beside another may be needed without it. All are tried at once."""
    both, hub = two_fitted()
    assert pruned(both, ACCEPTED_ODDS).model.members == (hub,)
    workers = Watched()
    assert pruned(both, 1e6, workers=workers).model.members == ()
    tried = [[tuple(h.effect for h in s.model.members) for s in starts] for starts in workers.starts]
    assert tried == [[("strut_bending",), ("hub_compliance",)], [()]]


@pytest.mark.parametrize(("share", "tried"), [(1.0, False), (0.5, False), (0.1, True)])
def test_what_cost_much_is_not_tried_without_again_while_its_sizes_carry_as_much(
    share: float, tried: bool
) -> None:
    """A progression carried 60 of ln likelihood to second order, and its removal lost thousands each time."""
    exact, hub = hub_fitted()
    place, prior, z = exact.model.place(hub), SetPrior({}), exact.z.copy()
    z[place] *= np.sqrt(20.0 / _carried(exact, place))
    weak, least = replace(exact, z=z), 6.0 + prior.log_odds([], hub)
    first, again = Watched(), Watched()
    pruned(weak, least, prior=prior, workers=first)
    removals = {hub.name: TriedRemoval(20.0 / share, 5000.0)}
    pruned(weak, least, MemberState(removals=removals), prior, again)
    assert first.starts
    assert bool(again.starts) == tried


@pytest.mark.parametrize(("lost", "tried"), [(None, True), (5.0, True), (5000.0, False)])
def test_what_has_no_size_is_tried_without_until_that_has_cost_much(lost: float | None, tried: bool) -> None:
    """What another roll technique carries no derivative says: it was taken out for trial in every step."""
    exact, hub = hub_fitted()
    technique = library("roll_technique")[0]
    both = replace(exact, model=exact.model.extended(technique))
    asked = Watched()
    removals = {} if lost is None else {technique.name: TriedRemoval(0.0, lost)}
    found = pruned(both, ACCEPTED_ODDS, MemberState(removals=removals), SetPrior({}), asked)
    assert bool(asked.starts) is tried
    assert found.model.members == ((hub,) if tried else (hub, technique)), "no roll record: it moves nothing"


def test_removals_are_told() -> None:
    exact, hub = hub_fitted()
    removals = backward_elimination(exact, 1e6, DiscoveryWorkers(), MemberState(), SetPrior({})).removals
    assert removals[hub.name].lost > BEYOND_DOUBT
    assert removals[hub.name].carried > 0.0


def test_a_fit_beside_the_removals_is_brought_to_its_optimum_where_all_members_stay() -> None:
    """The same digits as by itself: it only fills a worker that would be idle."""
    exact, hub = hub_fitted()
    place, prior, z = exact.model.place(hub), SetPrior({}), exact.z.copy()
    z[place] *= np.sqrt(20.0 / _carried(exact, place))  # so weak that its removal is tried, and loses more
    weak, least = replace(exact, z=z), 6.0 + prior.log_odds([], hub)
    wide = with_discrepancy(exact.model.likelihood, effect_signals(exact, DiscoveryWorkers()), [0.1])
    beside = replace(rewhitened_fit(exact, wide), z=0.9 * exact.z, converged=False)

    def end(fit: Fit, least: float, near: Fit) -> Fit | None:
        return backward_elimination(fit, least, DiscoveryWorkers(), MemberState(), prior, near).beside

    alone, together = at_optimum(beside, DiscoveryWorkers()), end(weak, least, beside)
    assert together is not None and together.converged
    np.testing.assert_array_equal(together.z, alone.z)
    assert end(weak, least, replace(beside, converged=True)) is None, "has its end"
    assert end(exact, least, beside) is None, "no removal was tried"
    assert end(exact, 1e6, beside) is None, "the member went"


def hub_fitted() -> tuple[Fit, Hypothesis]:
    """The same car, fitted with the hub alone."""
    (hub,) = library("hub_compliance")
    extended = model("named").extended(hub)
    return fit(extended, np.append(extended.centre[: extended.dimension], np.ones(2))), hub


def _carried(found: Fit, place: slice) -> float:
    sizes = found.z[place]
    return 0.5 * float(sizes @ np.linalg.inv(found.covariance[place, place]) @ sizes)


def _loss(found: Fit, member: Hypothesis) -> float:
    """ln evidence lost by a member's removal."""
    place = next(p for h, p in found.model.places() if h == member)
    return found.evidence - fit(found.model.without(member), np.delete(found.z, np.r_[place])).evidence


def test_errors_without_one_law_hold_those_of_the_others() -> None:
    exact, _ = two_fitted()
    names = [h.name for h in exact.model.members]
    made = effect_signals(exact, DiscoveryWorkers())
    assert without_own_discrepancy(exact, made, dict.fromkeys(names, 0.0)) == {}
    found = without_own_discrepancy(exact, made, dict.fromkeys(names, 0.1))
    for name, shares in zip(names, ([0.0, 0.1], [0.1, 0.0]), strict=True):
        expected = with_discrepancy(exact.model.likelihood, made, shares)
        for one, other in zip(found[name].curves, expected.curves, strict=True):
            np.testing.assert_array_equal(one.root, other.root)
