"""Refits from the nominal axle: where bounds hold many parameters, of what leads there."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from doe_kc.discovery.fit import Fit
from doe_kc.discovery.gauss_newton import FitStart, fit
from doe_kc.discovery.screening.screen import Screened
from doe_kc.discovery.screening.within_bounds import BoundedGain, many_held
from doe_kc.discovery.search.nominal_refits import (
    leading_at_first,
    leading_from_nominal,
    leading_pairs,
    refit_anew,
    refits_from_nominal,
)
from doe_kc.discovery.search.refits import HypothesisFit, useful_cost
from doe_kc.discovery.search.set_prior import SetPrior
from doe_kc.discovery.thresholds import ACCEPTED_ODDS
from doe_kc.discovery.workers import DiscoveryWorkers
from doe_kc.effects.hypothesis import Hypothesis
from tests.discovery.cases import library, model
from tests.discovery.search.test_refits import screened


@pytest.fixture(scope="module")
def bent() -> tuple[Fit, list[Screened]]:
    """A car of two effects, tuned between bounds so narrow that most parameters end at one."""
    car = model("pair")
    narrow = replace(car, space=car.space.widened(0.1))
    current = fit(narrow, narrow.centre)
    known = library("hub_compliance", "steering_friction", "strut_bending", "rig_channel_gain")
    return current, DiscoveryWorkers().screenings(current, known)


def test_where_bounds_hold_many_a_pair_is_refitted_from_the_nominal_axle(
    bent: tuple[Fit, list[Screened]],
) -> None:
    current, screened = bent
    assert many_held(current)
    prior = SetPrior.of(library())
    trials = refits_from_nominal(current, screened, [], [], prior, DiscoveryWorkers())
    best = max(trials, key=lambda t: t.gain)
    members = [h.effect for h in best.fit.model.members]
    assert sorted(members) == ["hub_compliance", "steering_friction"]
    assert best.hypothesis.effect == members[-1]
    assert best.gain == pytest.approx(best.fit.evidence - current.evidence + best.prior)
    singles = [t for t in trials if len(t.fit.model.members) == 1]
    assert {t.hypothesis.effect for t in singles} >= set(members)
    assert best.gain > max(t.gain for t in singles) + 100.0


def test_refits_from_the_nominal_axle_are_given_up_where_they_cannot_gain(
    bent: tuple[Fit, list[Screened]],
) -> None:
    """A single effect has to beat the set before it, a pair the best single one."""
    current, screened = bent
    prior, starts = SetPrior.of(library()), list[FitStart]()

    class Watched(DiscoveryWorkers):
        def fits(self, given: Sequence[FitStart], *args: Any, **more: Any) -> list[Fit | None]:
            starts.extend(given)
            return super().fits(given, *args, **more)

    trials = refits_from_nominal(current, screened, [], [], prior, Watched())
    single = max((t for t in trials if len(t.fit.model.members) == 1), key=lambda t: t.gain)
    assert {len(s.model.members) for s in starts} == {1, 2}
    for start in starts:
        pair, last = len(start.model.members) == 2, start.model.members[-1]
        before, least = (single.fit, 0.0) if pair else (current, ACCEPTED_ODDS)
        assert start.ceiling == useful_cost(before, last, least, prior)


def test_from_the_nominal_axle_effects_that_lead_between_bounds_or_by_screening_are_refitted() -> None:
    """A ride height 8 mm off was third by screening and fifth between the bounds, and missed."""
    known = library("strut_friction", "hub_compliance", "strut_bending", "steering_friction")
    ride, gain = library("ride_height_offset", "rig_channel_gain")[:2]

    def bounded(hypothesis: Hypothesis, by_screening: float, between_bounds: float) -> BoundedGain:
        own = replace(screened(0.5, 10.0), hypothesis=hypothesis, gain=by_screening)
        return BoundedGain(own, between_bounds, np.zeros(1))

    friction, hub, bending, other = (next(h for h in known if h.effect == e) for e in
        ("strut_friction", "hub_compliance", "strut_bending", "steering_friction"))  # fmt: skip
    gains = [
        bounded(friction, 900.0, 800.0), bounded(gain, 500.0, 400.0), bounded(hub, 100.0, 300.0),
        bounded(bending, 50.0, 200.0), bounded(ride, 300.0, 100.0), bounded(other, 200.0, 1.0),
    ]  # fmt: skip
    assert [g.screened.hypothesis for g in leading_from_nominal(gains)] == [friction, gain, hub, ride]


def test_where_a_fault_of_the_rig_leads_the_first_effect_of_the_car_is_paired_too(
    bent: tuple[Fit, list[Screened]],
) -> None:
    """A gain of the tyre load stood for a ride height 5 mm off, until each of the library had been tried."""
    gain, offset, ride, hub = (
        library(effect)[0]
        for effect in ("rig_channel_gain", "rig_channel_offset", "ride_height_offset", "hub_compliance")
    )

    def pairs(*hypotheses: Hypothesis) -> list[tuple[Hypothesis, Hypothesis]]:
        trials = [HypothesisFit(h, bent[0], 10.0) for h in hypotheses]
        return [(one.hypothesis, other.hypothesis) for one, other in leading_pairs(trials)]

    assert pairs(gain, ride, hub) == [(gain, ride), (gain, hub), (ride, hub)]
    assert pairs(gain, offset, ride) == [(gain, offset), (gain, ride), (ride, offset)]
    assert pairs(ride, gain, hub) == [(ride, gain), (ride, hub)]
    assert pairs(gain, offset) == [(gain, offset)]
    assert pairs(ride) == []


def test_what_led_before_any_effect_is_refitted_from_the_nominal_axle_too() -> None:
    """Beside a strut friction that bent the axle a ride height 7 mm off promised -3 of ln evidence, and a
    gain of the tyre load stood for it."""
    (friction, hub, *gains), (ride,) = (
        library("strut_friction", "hub_compliance", "rig_channel_gain"), library("ride_height_offset"),
    )  # fmt: skip

    def at_first(hypothesis: Hypothesis, gain: float) -> Screened:
        return replace(screened(0.5, 10.0), hypothesis=hypothesis, gain=gain)

    opening = [
        at_first(hub, 100.0), at_first(ride, 300.0), at_first(gains[0], 400.0), at_first(gains[1], 350.0),
        at_first(friction, 900.0), at_first(library("strut_bending")[0], 1.0),
    ]  # fmt: skip
    led = leading_at_first(opening, model("pair").extended(friction))
    assert [s.hypothesis for s in led] == [gains[0], ride, hub]


def test_where_bounds_hold_few_nothing_is_refitted_from_the_nominal_axle(
    bent: tuple[Fit, list[Screened]],
) -> None:
    current, screened = bent
    free = replace(current, z=current.model.centre.copy())
    assert not many_held(free)
    assert not refits_from_nominal(free, screened, [], [], SetPrior({}), DiscoveryWorkers())


def test_where_a_fault_of_the_rig_leads_what_led_before_any_effect_is_refitted(
    bent: tuple[Fit, list[Screened]],
) -> None:
    """A ride height 7 mm off beside a friction of the strut was told by way of twelve steps: a gain of the
    tyre load led, and bounds held too few parameters."""
    current, screened = bent
    free, none = replace(current, z=current.model.centre.copy()), SetPrior({})
    rig, hub = (
        next(s for s in screened if s.hypothesis.effect == e) for e in ("rig_channel_gain", "hub_compliance")
    )
    fault, effect = (HypothesisFit(s.hypothesis, free, 400.0, 0.0) for s in (rig, hub))
    refits = refits_from_nominal(free, screened, [hub], [fault], none, DiscoveryWorkers())
    assert [t.fit.model.members for t in refits] == [(hub.hypothesis,)]
    assert refits[0].gain > 1000.0
    stronger = replace(effect, gain=500.0)
    assert not refits_from_nominal(free, screened, [hub], [fault, stronger], none, DiscoveryWorkers())


def test_a_set_is_fitted_anew_from_the_nominal_axle_where_that_brings_more(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Beside a free play a fit ended at 1787 of ln evidence less than that from the nominal axle."""
    car = model("pair").extended(*library("hub_compliance"))
    best, own = fit(car, car.centre), slice(car.parameters)
    astray = best.z.copy()
    astray[own] = 0.5 * (car.centre + car.upper)[own]
    far = fit(car, astray, steps=0)
    anew = refit_anew(far, DiscoveryWorkers())
    assert anew is not None
    assert anew.evidence == pytest.approx(best.evidence, abs=1.0)
    assert anew.evidence > far.evidence + 1000.0
    assert refit_anew(anew, DiscoveryWorkers()) is None
    monkeypatch.setattr("doe_kc.discovery.search.nominal_refits.NOISE_CHANCE", 0.0)
    assert refit_anew(far, DiscoveryWorkers()) is None
