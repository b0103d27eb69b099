"""What is asked for before a fault of the rig comes in."""

from __future__ import annotations

from dataclasses import replace

import pytest

from doe_kc.discovery.fit import Fit
from doe_kc.discovery.gauss_newton import fit
from doe_kc.discovery.screening.screen import Screened
from doe_kc.discovery.search.refits import HypothesisFit
from doe_kc.discovery.search.rig_faults import leading_rig_fault, refits_of_the_car
from doe_kc.discovery.search.set_prior import SetPrior
from doe_kc.discovery.thresholds import ACCEPTED_ODDS
from doe_kc.discovery.workers import DiscoveryWorkers
from tests.discovery.cases import library, model

LEAST = 4.0
NONE = SetPrior({})


@pytest.fixture(scope="module")
def current() -> Fit:
    """A car of a hub and a steering friction, re-tuned without either."""
    car = model("pair")
    return fit(car, car.centre)


@pytest.fixture(scope="module")
def screened(current: Fit) -> list[Screened]:
    """As at an earlier step, in which nothing of the hub or the friction showed."""
    known = library("hub_compliance", "steering_friction", "rig_channel_gain")
    return [replace(s, gain=-1.0) for s in DiscoveryWorkers().screenings(current, known)]


def trial(of: Screened, current: Fit, gain: float) -> HypothesisFit:
    return HypothesisFit(of.hypothesis, current, gain)


def of(screened: list[Screened], effect: str) -> Screened:
    return next(s for s in screened if s.hypothesis.effect == effect)


def test_effects_of_the_car_are_screened_anew_and_refitted(current: Fit, screened: list[Screened]) -> None:
    fault = trial(of(screened, "rig_channel_gain"), current, 400.0)
    refits = refits_of_the_car(current, screened, LEAST, [fault], NONE, DiscoveryWorkers())
    assert {t.hypothesis.effect for t in refits} <= {"hub_compliance", "steering_friction"}
    assert refits[0].gain > fault.gain
    assert refits[0].gain == pytest.approx(refits[0].fit.evidence - current.evidence + refits[0].prior)


def test_what_has_been_refitted_is_not_refitted_again(current: Fit, screened: list[Screened]) -> None:
    fault = trial(of(screened, "rig_channel_gain"), current, 400.0)
    before = [trial(s, current, 1.0) for s in screened if s.hypothesis.effect == "hub_compliance"]
    refits = refits_of_the_car(current, screened, LEAST, [fault, *before], NONE, DiscoveryWorkers())
    assert {t.hypothesis.effect for t in refits} == {"steering_friction"}


def test_where_an_effect_of_the_car_leads_nothing_more_is_asked_for(
    current: Fit, screened: list[Screened]
) -> None:
    fault, weak, hub = (
        trial(of(screened, effect), current, gain)
        for effect, gain in (
            ("rig_channel_gain", 400.0),
            ("rig_channel_gain", ACCEPTED_ODDS),
            ("hub_compliance", 500.0),
        )
    )
    assert leading_rig_fault([weak, fault]) is fault.hypothesis
    assert all(leading_rig_fault(trials) is None for trials in ([fault, hub], [weak], []))
    assert refits_of_the_car(current, screened, LEAST, [fault, hub], NONE, DiscoveryWorkers()) == []


def test_a_technique_stands_for_nothing_else(current: Fit, screened: list[Screened]) -> None:
    """It has no size that could stand for another effect's."""
    technique = HypothesisFit(library("roll_technique")[0], current, 400.0)
    assert leading_rig_fault([technique]) is technique.hypothesis
    assert refits_of_the_car(current, screened, LEAST, [technique], NONE, DiscoveryWorkers()) == []
