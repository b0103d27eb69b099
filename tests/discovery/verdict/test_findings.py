"""When an effect is named: not where a trace of another would do, nor where another predicts the same."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from doe_kc.discovery.fit import Fit
from doe_kc.discovery.result import Finding
from doe_kc.discovery.search.refits import HypothesisFit, log_odds
from doe_kc.discovery.search.search import EffectSearch
from doe_kc.discovery.thresholds import TRACE_SD
from doe_kc.discovery.verdict.alternatives import Alternatives
from doe_kc.discovery.verdict.findings import (
    NO_EFFECT,
    best_alternative,
    findings,
    log_probabilities,
    unseen_effect_sd,
)
from tests.discovery.cases import discovery, library

HUB = [1.0, 1.0]
"""Sizes of the car's own effect, the compliant hub."""


def search() -> EffectSearch:
    return discovery("named").search


def trial(effect: str, sizes: list[float], gain: float, apart: float = 0.0) -> HypothesisFit:
    """A refit whose sizes are known to a hundredth of the typical one.

    apart: distance of what it predicts from the prediction without an effect, in standard deviations.
    """
    tuned = search().tuned
    (hypothesis,) = [h for h in library(effect) if h.location in (None, "ROB")]
    columns = np.zeros((tuned.residual.size, len(sizes)))
    columns[range(len(sizes)), range(len(sizes))] = 100.0
    tuning = tuned.jacobian.copy()
    tuning[: len(sizes)] = 0.0
    model, z = tuned.model.extended(hypothesis), np.append(tuned.z, sizes)
    residual = tuned.residual + np.eye(tuned.residual.size)[0] * apart
    return HypothesisFit(
        hypothesis,
        replace(tuned, model=model, z=z, residual=residual, jacobian=np.hstack([tuning, columns])),
        gain,
    )


def place(*trials: HypothesisFit, temper: float = 1.0, without: Fit | None = None) -> Alternatives:
    """An effect of the last set and its rivals."""
    own = next(s for s in search().steps[0].screened if s.hypothesis.effect == trials[0].hypothesis.effect)
    return Alternatives(without or search().tuned, (own,), trials, temper)


def judged(*rivals: HypothesisFit, gain: float = 100.0, without: Fit | None = None) -> Finding:
    """The hub among rivals."""
    (finding,) = findings(search(), [place(trial("hub_compliance", HUB, gain), *rivals, without=without)])
    return finding


@pytest.mark.parametrize(
    ("size", "gain", "relevant"),
    [(0.05, 96.4, False), (0.3, 96.4, True), (0.05, 93.0, True)],
    ids=["a trace as likely", "more than a trace", "a hundred times less likely"],
)
def test_an_effect_is_not_named_where_a_trace_of_another_would_do(
    size: float, gain: float, relevant: bool
) -> None:
    assert judged(trial("strut_bending", [size, 0.0], gain)).relevant is relevant


def test_effects_that_predict_the_same_are_mistaken_for_each_other() -> None:
    near, far = (judged(trial("tie_rod_compliance", [0.5], 99.0, apart)) for apart in (1.0, 6.0))
    assert near.wrong_name == pytest.approx(0.3085, abs=1e-4)
    assert near.alike == ("tie_rod_compliance",)
    assert far.wrong_name < 0.002
    assert far.alike == ()


@pytest.mark.parametrize(("gap", "counted"), [(0.0, False), (0.005, False), (0.1, True)])
def test_a_free_play_without_a_gap_is_a_compliance_by_another_name(gap: float, counted: bool) -> None:
    finding = judged(trial("tie_rod_free_play", [gap, 2.0], 99.0, 0.5))
    assert finding.alike == (("tie_rod_free_play",) if counted else ())
    assert (finding.wrong_name > 0.0) is counted


def explained(fit: Fit) -> Fit:
    """The fit of records that agree with it, its parameters where they are in the file."""
    return replace(fit, z=fit.model.centre, residual=0.0 * fit.residual)


@pytest.mark.parametrize(
    ("loss", "agrees", "named"),
    [(20.0, True, True), (15.0, True, False), (15.0, False, True)],
    ids=["six standard deviations", "less, and noise explains what was there", "less, and noise does not"],
)
def test_a_weak_effect_is_named_where_noise_does_not_explain_what_it_explains(
    loss: float, agrees: bool, named: bool
) -> None:
    tuned = search().tuned
    without = explained(tuned) if agrees else tuned
    assert (without.residual_map.chance >= 0.01) is agrees
    (hub,) = library("hub_compliance")
    assert judged(gain=loss + log_odds(hub), without=without).relevant is named


@pytest.mark.parametrize(("share", "named"), [(0.0, True), (0.02, False)])
def test_beside_a_hundred_times_larger_one_whose_law_is_another_an_effect_is_not_named(
    share: float, named: bool
) -> None:
    found = discovery("pair").search
    large, small = found.with_law_discrepancy.model.members
    screened = {s.hypothesis.name: s for s in found.steps[0].screened}
    shares = {large.name: share, small.name: 0.0}
    compared = []
    for member, gain in ((large, 2000.0), (small, 15.0)):
        refit = HypothesisFit(member, found.with_law_discrepancy, gain)
        compared.append(Alternatives(found.tuned, (screened[member.name],), (refit,), 1.0))
    one, other = findings(replace(found, discrepancy_shares=shares), compared)
    assert one.relevant
    assert other.relevant is named


def test_probabilities_follow_the_evidence_and_are_no_constant() -> None:
    known = library("hub_compliance", "strut_bending")

    def hub_s(own: float, rival: float, temper: float = 1.0) -> float:
        hub, bent = trial("hub_compliance", HUB, own), trial("strut_bending", HUB, rival)
        return log_probabilities(place(hub, bent, temper=temper), known)["hub_compliance"]

    assert np.exp(hub_s(50.0, 50.0)) == pytest.approx(0.5)
    assert np.exp(hub_s(50.0, 48.0)) == pytest.approx(1.0 / (1.0 + np.exp(-2.0)))
    assert np.exp(hub_s(50.0, 40.0, temper=10.0)) == pytest.approx(1.0 / (1.0 + np.exp(-1.0) + np.exp(-5.0)))
    assert np.exp(hub_s(9.0, 1.0)) < np.exp(hub_s(20.0, 1.0)) < 1.0


def test_odds_are_against_the_best_alternative_the_removal_among_them() -> None:
    known = library("hub_compliance", "strut_bending", "rig_channel_gain")
    hub, bent = trial("hub_compliance", [1.0, 1.0], 12.0), trial("strut_bending", [1.0, 1.0], 5.0)
    logs = log_probabilities(place(hub, bent), known)
    assert best_alternative(logs, "hub_compliance") == ("strut_bending", pytest.approx(7.0 / np.log(10.0)))
    logs = log_probabilities(place(hub), known)
    assert best_alternative(logs, "hub_compliance") == (NO_EFFECT, pytest.approx(12.0 / np.log(10.0)))


def test_the_prior_odds_of_an_effect_are_shared_between_its_places() -> None:
    known = library("tie_rod_compliance", "bushing_progression")
    places = sum(h.effect == "bushing_progression" for h in known)
    (one, *_) = library("bushing_progression")
    rod = trial("tie_rod_compliance", [1.0], 9.0)
    logs = log_probabilities(place(rod, HypothesisFit(one, rod.fit, 9.0)), known)
    assert logs["tie_rod_compliance"] - logs["bushing_progression"] == pytest.approx(np.log(places))


def test_each_trace_moves_a_size_as_a_refit_to_first_order_says() -> None:
    found = discovery("named").search
    (one,) = [s for s in found.steps[-1].screened if s.hypothesis.effect == "strut_bending"]
    last = replace(found.steps[-1], screened=(one,))
    alone = replace(found, steps=(*found.steps[:-1], last))
    final = found.with_law_discrepancy
    share = min(TRACE_SD, 4.0 / one.detectability)
    weight = np.diag(final.model.prior_sd**-1.0)
    stacked = np.vstack([final.jacobian, weight])
    change = np.concatenate([share * one.change, np.zeros(final.z.size)])
    moved = np.linalg.lstsq(stacked, change, rcond=None)[0][final.model.dimension :]
    assert unseen_effect_sd(alone) == pytest.approx(np.abs(moved), rel=1e-6)
    assert np.all(unseen_effect_sd(found) >= unseen_effect_sd(alone) * (1.0 - 1e-12))


def test_with_nothing_else_in_the_library_nothing_is_added() -> None:
    found = discovery("named").search
    last = replace(found.steps[-1], screened=())
    assert not unseen_effect_sd(replace(found, steps=(*found.steps[:-1], last))).any()
