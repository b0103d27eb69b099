"""Which hypotheses are refitted, which refit leads, which sizes are believed."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from doe_kc.discovery.fit import Fit
from doe_kc.discovery.gauss_newton import fit
from doe_kc.discovery.screening.screen import Screened
from doe_kc.discovery.search.refits import (
    HypothesisFit,
    believable,
    best_of_each_set,
    held_loss,
    leaders,
    more_than_none,
    more_than_trace,
    overlooked,
    stiffer_first,
    untried,
)
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


def test_a_size_is_there_when_that_is_sure() -> None:
    size = Size("gain", 0.05, "-", "factor", signed=True)
    assert more_than_none([(size, -0.03, 0.014)]) and not more_than_none([(size, -0.03, 0.016)])
    assert more_than_none([])


def test_a_size_beyond_belief_costs_what_the_records_lose_at_the_limit() -> None:
    """To second order: with d standard deviations between, d^2 / 2, and nothing that others lose."""
    explained = discovery("named").search.with_law_discrepancy
    (member,) = explained.model.members
    place, most = explained.model.place(member), np.array([size.most for size in member.sizes])
    assert not any(size.shape for size in member.sizes)
    covariance = explained.covariance[place, place]
    sd = np.sqrt(np.diag(covariance))

    def at(amplitudes: Any) -> Fit:
        z = explained.z.copy()
        z[place] = amplitudes
        return replace(explained, z=z)

    assert held_loss(explained, ()) == held_loss(at(most), ()) == 0.0
    for apart in (1.0, 7.0):
        one = at(np.where(np.arange(most.size) == 0, most + apart * sd, 0.0))
        assert held_loss(one, ()) == pytest.approx(0.5 * apart**2, rel=1e-9)
        beyond = apart * sd
        both = 0.5 * beyond @ np.linalg.inv(covariance) @ beyond
        assert held_loss(at(most + beyond), ()) == pytest.approx(both, rel=1e-9)
        assert held_loss(at(-most - beyond), ()) == pytest.approx(both, rel=1e-9)
    assert held_loss(at(most + 7.0 * sd), [member]) == 0.0


@pytest.mark.parametrize("outwards", [True, False])
def test_a_size_at_the_bound_costs_what_it_still_gained_there_too(outwards: bool) -> None:
    """Against the least of the quadratic model with the sizes held, all else free."""
    explained = discovery("named").search.with_law_discrepancy
    (member,) = explained.model.members
    place, most = explained.model.place(member), np.array([size.most for size in member.sizes])
    z, slope = explained.z.copy(), np.zeros(explained.z.size)
    z[place] = explained.model.upper[place]
    slope[place] = [-30.0, -20.0] if outwards else [30.0, 20.0]
    inwards, others = most - z[place], np.setdiff1d(np.arange(z.size), np.arange(z.size)[place])
    hessian = explained.hessian
    rest = -np.linalg.solve(hessian[np.ix_(others, others)], hessian[others, place] @ inwards)
    step = np.zeros(z.size)
    step[place], step[others] = inwards, rest
    lost = 0.5 * step @ hessian @ step + (slope @ step if outwards else 0.0)  # no fit ends uphill of a bound
    assert held_loss(replace(explained, z=z, slope=slope), ()) == pytest.approx(lost, rel=1e-6)


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


def screened(absorbed: float, detectability: float, failed: str = "") -> Screened:
    (hypothesis,) = library("tie_rod_compliance")
    none: Any = np.zeros(1)
    return Screened(
        hypothesis, none, none, -3.5, none[:, None], none, none, detectability, absorbed, none, failed
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


def test_of_one_set_refitted_twice_the_better_refit_stays() -> None:
    current = discovery("named").search.tuned
    hub, friction = library("hub_compliance", "steering_friction")

    def refit(gain: float, *members: Hypothesis) -> HypothesisFit:
        model = replace(current.model, members=members)
        return HypothesisFit(members[-1], replace(current, model=model), gain)

    worse, other = refit(1.0, hub, friction), refit(2.0, friction)
    better = refit(3.0, friction, hub)
    assert best_of_each_set([worse, other, better]) == [better, other]
