"""Backward elimination: a member is judged by errors that do not hold its own law."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from doe_kc.discovery.fit import Fit, rewhitened_fit
from doe_kc.discovery.gauss_newton import FitStart, fit, known_columns, refit_to_errors
from doe_kc.discovery.search.law_discrepancy import effect_signals, with_discrepancy, without_own_discrepancy
from doe_kc.discovery.search.pruning import backward_elimination
from doe_kc.discovery.search.set_prior import SetPrior
from doe_kc.discovery.thresholds import ACCEPTED_ODDS, BEYOND_DOUBT
from doe_kc.discovery.workers import DiscoveryWorkers
from doe_kc.effects.hypothesis import Hypothesis
from tests.discovery.cases import library, model


def two_fitted() -> tuple[Fit, Hypothesis]:
    """A car with a compliant hub, fitted with that and a strut that bends; the hub."""
    (hub,), (bent,) = library("hub_compliance"), library("strut_bending")
    both = model("named").extended(hub).extended(bent)
    return fit(both, np.append(both.centre[: both.dimension], np.ones(len(both.sizes)))), hub


def test_an_effect_does_not_pass_for_the_law_that_was_granted_to_it() -> None:
    """Errors of half of what the hub does to every curve explain it away; errors without them do not."""
    exact, hub = hub_fitted()
    wide = with_discrepancy(exact.model.likelihood, effect_signals(exact), [0.5])
    begun = rewhitened_fit(exact, wide)
    found = fit(begun.model, exact.z, known=known_columns(begun, begun.model))
    fooled = _loss(found, hub)
    own = _loss(refit_to_errors(found, exact.model.likelihood), hub)
    assert own > 1.5 * fooled
    between = float(np.sqrt(own * fooled))
    prior = SetPrior({})
    least = between + prior.log_odds([], hub)
    assert hub not in backward_elimination(found, least, DiscoveryWorkers(), {}, prior).model.members
    own_errors = {hub.name: exact.model.likelihood}
    judged = backward_elimination(found, least, DiscoveryWorkers(), own_errors, prior)
    assert hub in judged.model.members
    assert judged.model.likelihood is wide


def test_a_removal_beyond_doubt_is_given_up() -> None:
    """The hub is worth thousands: its removal needs no end."""
    exact, hub = hub_fitted()
    assert _loss(exact, hub) > 2.0 * BEYOND_DOUBT
    starts: list[FitStart] = []

    class Watched(DiscoveryWorkers):
        def fits(self, given: Sequence[FitStart], what: str, **more: Any) -> list[Fit | None]:
            starts.extend(given if what == "taking effects out" else ())
            return super().fits(given, what, **more)

    least = 1e6  # so that the removal is tried
    found = backward_elimination(exact, least, Watched(), {}, SetPrior({}))
    assert [s.ceiling for s in starts] == [exact.cost + 2.0 * BEYOND_DOUBT]
    assert found.model.members == ()


def test_one_member_goes_at_a_time_the_least_needed_first() -> None:
    """What is needless beside another may be needed without it. All are tried at once."""
    both, hub = two_fitted()
    asked: list[list[tuple[str, ...]]] = []

    class Watched(DiscoveryWorkers):
        def fits(self, given: Sequence[FitStart], what: str, **more: Any) -> list[Fit | None]:
            if what == "taking effects out":
                asked.append([tuple(h.effect for h in s.model.members) for s in given])
            return super().fits(given, what, **more)

    assert backward_elimination(both, ACCEPTED_ODDS, Watched(), {}, SetPrior({})).model.members == (hub,)
    asked.clear()
    assert backward_elimination(both, 1e6, Watched(), {}, SetPrior({})).model.members == ()
    assert asked == [[("strut_bending",), ("hub_compliance",)], [()]]


def hub_fitted() -> tuple[Fit, Hypothesis]:
    """The same car, fitted with the hub alone."""
    (hub,) = library("hub_compliance")
    extended = model("named").extended(hub)
    return fit(extended, np.append(extended.centre[: extended.dimension], np.ones(2))), hub


def _loss(found: Fit, member: Hypothesis) -> float:
    """ln evidence lost by a member's removal."""
    place = next(p for h, p in found.model.places() if h == member)
    return found.evidence - fit(found.model.without(member), np.delete(found.z, np.r_[place])).evidence


def test_errors_without_one_law_hold_those_of_the_others() -> None:
    exact, _ = two_fitted()
    names = [h.name for h in exact.model.members]
    made = effect_signals(exact)
    assert without_own_discrepancy(exact, made, dict.fromkeys(names, 0.0)) == {}
    found = without_own_discrepancy(exact, made, dict.fromkeys(names, 0.1))
    for name, shares in zip(names, ([0.0, 0.1], [0.1, 0.0]), strict=True):
        expected = with_discrepancy(exact.model.likelihood, made, shares)
        for one, other in zip(found[name].curves, expected.curves, strict=True):
            np.testing.assert_array_equal(one.root, other.root)
