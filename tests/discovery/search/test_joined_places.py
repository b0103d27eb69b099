"""Rubber of a further group of bushings, against rubber of all bushings in the place of both."""

from __future__ import annotations

import numpy as np
import pytest

from doe_kc.discovery.fit import Fit
from doe_kc.discovery.gauss_newton import FitStart, fit
from doe_kc.discovery.search import decision as decision_module
from doe_kc.discovery.search.decision import Decision, next_decision
from doe_kc.discovery.search.joined_places import joined_refits, joined_starts
from doe_kc.discovery.search.refits import HypothesisFit, hypothesis_fit
from doe_kc.discovery.search.set_prior import SetPrior
from doe_kc.discovery.workers import DiscoveryWorkers
from doe_kc.effects.hypothesis import Hypothesis
from tests.discovery.cases import library, model

EVERYWHERE, REAR, REST = library("rubber_hysteresis")
RUBBER = [EVERYWHERE, REAR, REST]
PRIOR = SetPrior.of(library("rubber_hysteresis", "hub_compliance"))


def fitted(car: str, *members: Hypothesis) -> Fit:
    """A car with some members."""
    begun = model(car)
    for member in members:
        begun = begun.extended(member)
    sizes = [0.0 if size.shape else 1.0 for size in begun.sizes]
    return fit(begun, np.append(np.zeros(begun.dimension), sizes))


def further(car: str) -> tuple[Fit, HypothesisFit]:
    """A car with rubber of most bushings, and with that of the lower arms' rear ones beside."""
    current = fitted(car, REST)
    return current, hypothesis_fit(fitted(car, REST, REAR), current, PRIOR)


def decided(current: Fit, trial: HypothesisFit, monkeypatch: pytest.MonkeyPatch) -> Decision:
    """The step in which nothing but one trial is refitted."""
    monkeypatch.setattr(decision_module, "_leader_refits", lambda *_: [trial])
    monkeypatch.setattr(decision_module, "refits_from_nominal", lambda *_: [])
    return next_decision(current, RUBBER, PRIOR, DiscoveryWorkers(), (), (), runners_up=set(), laws_open=True)


def test_rubber_of_all_bushings_comes_in_for_that_of_two_groups(monkeypatch: pytest.MonkeyPatch) -> None:
    current, trial = further("rubber")
    found = decided(current, trial, monkeypatch)
    assert found.accepted
    assert [t.fit.model.members for t in found.trials] == [(EVERYWHERE,), (REST, REAR)]
    joined = found.trials[0]
    assert joined.hypothesis == EVERYWHERE and joined.gain > trial.gain
    odds = PRIOR.log([EVERYWHERE]) - PRIOR.log([REST])
    assert joined.gain == pytest.approx(joined.fit.evidence - current.evidence + odds)
    share = next(s for s in EVERYWHERE.sizes if s.key == "share")
    told = share.value(joined.fit.model.sizes_at(joined.fit.z, EVERYWHERE)["share"])
    assert told == pytest.approx(0.3, rel=0.1)


def test_rubber_of_one_group_does_not(monkeypatch: pytest.MonkeyPatch) -> None:
    current, trial = further("rear_rubber")
    assert decided(current, trial, monkeypatch).trials[0] is trial


def test_a_trial_with_one_place_asks_for_no_fit() -> None:
    class NoFits(DiscoveryWorkers):
        def fits(self, starts: list[FitStart], *_: object, **__: object) -> list[None]:  # type: ignore[override]
            assert not starts
            return []

    current = fitted("none")
    trial = hypothesis_fit(fitted("none", REAR), current, PRIOR)
    assert joined_refits(current, trial, RUBBER, PRIOR, NoFits()) == []


def test_a_trial_that_gains_nothing_is_not_joined(monkeypatch: pytest.MonkeyPatch) -> None:
    current, trial = further("rubber")
    worse = HypothesisFit(trial.hypothesis, trial.fit, -1.0, trial.prior)
    assert [t.gain for t in decided(current, worse, monkeypatch).trials] == [-1.0]


def test_the_start_is_the_mean_of_the_places() -> None:
    both = fitted("rubber", REST, REAR)
    ((everywhere, start),) = joined_starts(both, RUBBER)
    assert everywhere == EVERYWHERE and start.model.members == (EVERYWHERE,)
    own, *others = (both.z[both.model.place(h)] for h in both.model.members)
    np.testing.assert_allclose(start.z[start.model.place(EVERYWHERE)], np.mean([own, *others], axis=0))
    np.testing.assert_array_equal(start.z[: both.model.dimension], both.z[: both.model.dimension])
