"""Which hypotheses are refitted, which refit leads, which sizes are believed, which loop is tried."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from doe_kc.discovery.fit import Fit, FitStart, fit
from doe_kc.discovery.screening.screen import Screened
from doe_kc.discovery.screening.within_bounds import BoundedGain, many_held
from doe_kc.discovery.search.refits import (
    HypothesisFit,
    believable,
    best_of_each_set,
    leaders,
    leading_from_nominal,
    more_than_trace,
    overlooked,
    refits_from_nominal,
    stiffer_first,
    untried,
)
from doe_kc.discovery.search.search import with_conditioning
from doe_kc.discovery.search.set_prior import SetPrior
from doe_kc.discovery.workers import DiscoveryWorkers
from doe_kc.effects.hypothesis import Hypothesis, Size
from tests.discovery.cases import discovery, library, model
from tests.discovery.search.test_proposals import ROWS, hypotheses, tuned
from tests.discovery.search.test_proposals import screened as beside


def trial(place: str, gain: float, amplitude: float) -> HypothesisFit:
    hypothesis = next(h for h in library("left_right_asymmetry") if h.location == place)
    found = discovery("named").search.with_law_discrepancy
    return HypothesisFit(hypothesis, replace(found, z=np.append(found.z, amplitude)), gain)


@pytest.mark.parametrize(
    ("gains", "sizes", "leads"),
    [
        ((30.0, 29.8), (-1.0, 1.0), "UPB_L"),
        ((30.0, 29.8), (1.0, -1.0), "UPB_R"),
        ((30.0, 25.0), (-1.0, 1.0), "UPB_R"),
    ],
    ids=["tied", "stiffer already", "clearly better"],
)
def test_of_two_places_that_say_the_same_the_stiffer_leads(
    gains: tuple[float, float], sizes: tuple[float, float], leads: str
) -> None:
    trials = [trial("UPB_R", gains[0], sizes[0]), trial("UPB_L", gains[1], sizes[1])]
    assert stiffer_first(trials)[0].hypothesis.location == leads
    assert stiffer_first(trials[:1]) == trials[:1]


def test_a_size_is_disbelieved_or_a_trace_only_when_that_is_sure() -> None:
    size = Size("k", 1.0, "-")
    assert believable([(size, 3.5, 0.3)])
    assert not believable([(size, 1.0, 0.1), (size, -3.5, 0.2)])
    assert believable([(replace(size, most=4.0), -3.5, 0.2)])
    assert more_than_trace([(size, 0.3, 0.09)]) and not more_than_trace([(size, 0.3, 0.11)])
    assert more_than_trace([])


@pytest.mark.parametrize(("alike", "refitted"), [(0.8, True), (0.4, False)])
def test_a_rival_that_explains_the_same_is_refitted_however_little_it_gains(
    alike: float, refitted: bool
) -> None:
    """A trace of it, which a fit has, takes most of the gain to first order."""
    rng = np.random.default_rng(3)
    fit = tuned(rng.standard_normal(ROWS), rng)
    every, _ = np.linalg.qr(np.hstack([fit.jacobian.own, rng.standard_normal((ROWS, 3))]))
    first, second, third = 50.0 * every[:, -3:].T  # what no re-tuning absorbs
    changes = (first, alike * first + np.sqrt(1.0 - alike**2) * second, third)
    best, rival, other = (
        replace(beside(h, c), gain=gain)
        for h, c, gain in zip(hypotheses(3), changes, (1000.0, 30.0, 900.0), strict=True)
    )
    assert leaders([best, other, rival], fit, 10.0, decoy=False) == [best, *[rival] * refitted]
    assert leaders([best, other, rival], fit, 40.0, decoy=False) == [best]


class Asked(DiscoveryWorkers):
    """Notes which axles are to be fitted, and fits none."""

    def __init__(self) -> None:
        super().__init__()
        self.loops: list[int] = []

    def fits(self, starts: Sequence[FitStart], what: str) -> list[Fit | None]:
        self.loops += [s.model.axle.conditioning for s in starts]
        return [None for _ in starts]


@pytest.mark.parametrize(("own", "other"), [(0, 1), (1, 0), (2, 0)])
def test_the_other_loop_is_one_that_an_axle_file_can_say(own: int, other: int) -> None:
    found = discovery("friction").search.with_law_discrepancy
    model = replace(found.model, axle=found.model.axle.conditioned(own))
    asked = Asked()
    current = replace(found, model=model)
    refit, sure = with_conditioning(current, model.axle, asked)
    assert refit is current and not sure
    assert asked.loops == [other]


def test_without_friction_the_loops_are_those_of_the_file() -> None:
    found = discovery("named").search.with_law_discrepancy
    assert not found.model.with_effects(found.z).topology.frictional
    looped = replace(found, model=replace(found.model, axle=found.model.axle.conditioned(1)))
    again, sure = with_conditioning(looped, found.model.axle, Asked())
    assert not sure
    assert again.model.axle.conditioning == 0
    np.testing.assert_allclose(again.model.residual(again.z), looped.residual, atol=1e-9)


def screened(absorbed: float, detectability: float, failed: str = "") -> Screened:
    (hypothesis,) = library("tie_rod_compliance")
    none: Any = np.zeros(1)
    return Screened(
        hypothesis, none, none, -3.5, 0.0, none[:, None], none, none, detectability, absorbed, none, failed
    )


@pytest.mark.parametrize(
    ("candidate", "refitted"),
    [
        (screened(0.98, 10.9), True),
        (screened(0.6, 10.9), False),
        (screened(0.98, 3.0), False),
        (screened(0.98, 10.9, "no equilibrium"), False),
    ],
    ids=["hidden almost wholly", "hardly hidden", "not seen at typical size", "without an equilibrium"],
)
def test_what_a_screening_may_have_missed(candidate: Screened, refitted: bool) -> None:
    assert overlooked([candidate], 9.1) == ([candidate] if refitted else [])


def test_of_effects_that_no_refit_had_the_first_by_screening_is_left_to_try() -> None:
    friction, left, right = (
        screened(0.5, 10.0), screened(0.6, 10.0), screened(0.7, 10.0, "no equilibrium"),
    )  # fmt: skip
    known = library("left_right_asymmetry", "hub_compliance", "strut_bending")
    one, other = [h for h in known if h.effect == "left_right_asymmetry"][:2]
    hub, bending = (next(h for h in known if h.effect == e) for e in ("hub_compliance", "strut_bending"))
    given = [
        replace(friction, hypothesis=hub), replace(left, hypothesis=one), replace(left, hypothesis=other),
        replace(right, hypothesis=bending),
    ]  # fmt: skip
    assert untried(given, []) == [given[0], given[1]]
    done = HypothesisFit(hub, fit(model("pair"), model("pair").centre, steps=0), 1.0)
    assert untried(given, [done]) == [given[1]]


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
    trials = refits_from_nominal(current, screened, [], prior, DiscoveryWorkers())
    best = max(trials, key=lambda t: t.gain)
    members = [h.effect for h in best.fit.model.members]
    assert sorted(members) == ["hub_compliance", "steering_friction"]
    assert best.hypothesis.effect == members[-1]
    assert best.gain == pytest.approx(best.fit.evidence - current.evidence + best.prior)
    singles = [t for t in trials if len(t.fit.model.members) == 1]
    assert {t.hypothesis.effect for t in singles} >= set(members)
    assert best.gain > max(t.gain for t in singles) + 100.0


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


def test_of_one_set_refitted_twice_the_better_refit_stays(bent: tuple[Fit, list[Screened]]) -> None:
    current, _ = bent
    hub, friction = library("hub_compliance", "steering_friction")

    def refit(gain: float, *members: Hypothesis) -> HypothesisFit:
        model = replace(current.model, members=members)
        return HypothesisFit(members[-1], replace(current, model=model), gain)

    worse, other = refit(1.0, hub, friction), refit(2.0, friction)
    better = refit(3.0, friction, hub)
    assert best_of_each_set([worse, other, better]) == [better, other]


def test_where_bounds_hold_few_nothing_is_refitted_from_the_nominal_axle(
    bent: tuple[Fit, list[Screened]],
) -> None:
    current, screened = bent
    free = replace(current, z=current.model.centre.copy())
    assert not many_held(free)
    assert not refits_from_nominal(free, screened, [], SetPrior({}), DiscoveryWorkers())
