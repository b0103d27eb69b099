"""When an effect is named: not where a trace of another would do, nor where another predicts the same."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from doe_kc.discovery.thresholds import TRACE_SD
from doe_kc.discovery.verdict.findings import (
    NO_EFFECT,
    _alike,
    _confusion_chances,
    _stands_out,
    _trace_would_do,
    best_alternative,
    log_probabilities,
    unseen_effect_sd,
)
from tests.discovery.cases import discovery, library


def trial(effect: str, sizes: list[float], gain: float, residual: float = 0.0) -> Any:
    """A refit whose sizes are known to a hundredth of the typical one."""
    (hypothesis,) = [h for h in library(effect) if h.location in (None, "ROB")]
    fit = SimpleNamespace(
        z=np.array(sizes), covariance=1e-4 * np.eye(len(sizes)), residual=np.array([residual])
    )
    return SimpleNamespace(hypothesis=hypothesis, fit=fit, gain=gain)


def place(*trials: Any, temper: float = 1.0) -> Any:
    """An effect of the final set and its rivals."""
    return SimpleNamespace(trials=trials, temper=temper, hypothesis=trials[0].hypothesis)


@pytest.mark.parametrize(
    ("hub", "gain", "would_do"),
    [([0.05, 0.0], 15.4, True), ([0.3, 0.0], 15.4, False), ([0.05, 0.0], 12.0, False)],
    ids=["a trace as likely", "more than a trace", "a hundred times less likely"],
)
def test_an_effect_is_not_named_where_a_trace_of_another_would_do(
    hub: list[float], gain: float, would_do: bool
) -> None:
    strut = trial("strut_bending", [0.2, 0.0], 19.0)
    assert _trace_would_do(place(strut, trial("hub_compliance", hub, gain))) is would_do


def test_effects_that_predict_the_same_are_mistaken_for_each_other() -> None:
    rod = trial("tie_rod_compliance", [1.5], 100.0)
    near, far = (trial("hub_compliance", [0.5, 0.5], 99.0, apart) for apart in (1.0, 6.0))
    assert _confusion_chances(place(rod, near))["hub_compliance"] == pytest.approx(0.3085, abs=1e-4)
    assert _confusion_chances(place(rod, far))["hub_compliance"] < 0.002


def test_a_free_play_without_a_gap_is_the_tie_rod_s_compliance_by_another_name() -> None:
    rod = trial("tie_rod_compliance", [1.5], 100.0)
    for gap, counted in ((0.0, False), (0.005, False), (0.1, True)):
        play = trial("tie_rod_free_play", [gap, 2.0], 99.0)
        chances = {"tie_rod_free_play": 0.4}
        assert ("tie_rod_free_play" in _confusion_chances(place(rod, play))) is counted
        assert _alike(place(rod, play), chances) == (("tie_rod_free_play",) if counted else ())


@pytest.mark.parametrize(
    ("loss", "chance", "named"),
    [(20.0, 0.5, True), (15.0, 0.5, False), (15.0, 0.005, True)],
    ids=["six standard deviations", "less, and noise explains what was there", "less, and noise does not"],
)
def test_a_weak_effect_is_named_where_noise_does_not_explain_what_it_explains(
    loss: float, chance: float, named: bool
) -> None:
    own = trial("tie_rod_compliance", [0.5], 15.0)
    finding: Any = SimpleNamespace(trials=(own,), loss=loss, map=SimpleNamespace(chance=chance))
    assert _stands_out(finding, 0.0) is named
    assert not _stands_out(finding, 16.0)


def test_probabilities_follow_the_evidence_and_are_no_constant() -> None:
    known = library("hub_compliance", "strut_bending")

    def hub_s(own: float, rival: float, temper: float = 1.0) -> float:
        hub, bent = trial("hub_compliance", [1.0, 1.0], own), trial("strut_bending", [1.0, 1.0], rival)
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
    rival: Any = SimpleNamespace(hypothesis=one, fit=rod.fit, gain=9.0)
    logs = log_probabilities(place(rod, rival), known)
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
