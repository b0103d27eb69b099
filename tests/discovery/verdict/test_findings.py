"""When an effect is named: not where a trace of another would do, nor where another predicts the same."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.stats import norm

import doe_kc.discovery.verdict.findings as findings_module
from doe_kc.discovery.fit import Fit, amplitude_estimates
from doe_kc.discovery.result import Finding, ParameterEstimate
from doe_kc.discovery.search.effect_search import EffectSearch
from doe_kc.discovery.search.refits import HypothesisFit
from doe_kc.discovery.thresholds import LINEAR_TO
from doe_kc.discovery.verdict.alternatives import Alternatives, alternatives, comparison, effect_change
from doe_kc.discovery.verdict.findings import (
    NO_EFFECT,
    best_alternative,
    estimate,
    findings,
    log_probabilities,
    sd_of_one_number,
)
from doe_kc.discovery.verdict.size_fit import size_fit
from doe_kc.discovery.workers import DiscoveryWorkers
from doe_kc.effects import EFFECTS
from doe_kc.effects.hypothesis import Size
from tests.discovery.cases import discovery, library

HUB = [1.0, 1.0]
"""Sizes of the car's own effect, the compliant hub."""


def search() -> EffectSearch:
    return discovery("named").search


def trial(
    effect: str, sizes: list[float], gain: float, apart: float = 0.0, prior: float = 0.0
) -> HypothesisFit:
    """A refit whose sizes are known to a hundredth of the typical one.

    apart: distance of what it predicts from the prediction without an effect, in standard deviations. prior:
    part of the gain.
    """
    tuned = search().tuned
    (hypothesis,) = [h for h in library(effect) if h.location in (None, "ROB")]
    columns = np.zeros((tuned.residual.size, len(sizes)))
    columns[range(len(sizes)), range(len(sizes))] = 100.0
    tuning = tuned.jacobian.own.copy()
    tuning[: len(sizes)] = 0.0
    model, z = tuned.model.extended(hypothesis), np.append(tuned.z, sizes)
    residual = tuned.residual.copy()
    residual[0] += apart
    return HypothesisFit(
        hypothesis,
        replace(
            tuned, model=model, z=z, residual=residual, jacobian=model.jacobian(np.hstack([tuning, columns]))
        ),
        gain,
        prior,
    )


def place(*trials: HypothesisFit, temper: float = 1.0, without: Fit | None = None) -> Alternatives:
    """An effect of the last set and its rivals."""
    own = next(s for s in search().first.screened if s.hypothesis.effect == trials[0].hypothesis.effect)
    base = without or search().tuned
    return comparison(base, (own,), effect_change(base, (own,)), trials, temper)


def judged(*rivals: HypothesisFit, gain: float = 100.0, without: Fit | None = None) -> Finding:
    """The hub among rivals."""
    (finding,) = findings(
        search(), [place(trial("hub_compliance", HUB, gain), *rivals, without=without)], DiscoveryWorkers()
    )
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


@pytest.mark.parametrize(("prior", "alike"), [(-5.0, ("tie_rod_compliance",)), (0.0, ())])
def test_what_is_rarer_is_not_told_apart_by_that(prior: float, alike: tuple[str, ...]) -> None:
    rival = trial("tie_rod_compliance", [0.5], 95.0, 1.0, prior)
    assert judged(rival).alike == alike


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
    assert judged(gain=loss, without=without).relevant is named


def test_beside_a_much_larger_effect_a_weak_one_is_named_by_its_own_loss() -> None:
    """What the larger one's law may leave behind is in the errors that the loss is taken in."""
    found = discovery("pair").search
    large, small = found.with_law_discrepancy.model.members
    screened = {s.hypothesis.name: s for s in found.first.screened}

    def relevant(loss: float) -> list[bool]:
        compared = []
        for member, gain in ((large, 2000.0), (small, loss)):
            refit = HypothesisFit(member, found.with_law_discrepancy, gain)
            own = (screened[member.name],)
            without = explained(found.tuned)
            compared.append(comparison(without, own, effect_change(found.tuned, own), (refit,), 1.0))
        shares = {large.name: 0.1, small.name: 0.0}
        return [
            f.relevant
            for f in findings(replace(found, discrepancy_shares=shares), compared, DiscoveryWorkers())
        ]

    assert relevant(19.0) == [True, True]
    assert relevant(17.0) == [True, False]


def test_probabilities_follow_the_evidence_and_are_no_constant() -> None:
    def hub_s(own: float, rival: float, temper: float = 1.0) -> float:
        hub, bent = trial("hub_compliance", HUB, own), trial("strut_bending", HUB, rival)
        return log_probabilities(place(hub, bent, temper=temper))["hub_compliance"]

    assert np.exp(hub_s(50.0, 50.0)) == pytest.approx(0.5)
    assert np.exp(hub_s(50.0, 48.0)) == pytest.approx(1.0 / (1.0 + np.exp(-2.0)))
    assert np.exp(hub_s(50.0, 40.0, temper=10.0)) == pytest.approx(1.0 / (1.0 + np.exp(-1.0) + np.exp(-5.0)))
    assert np.exp(hub_s(9.0, 1.0)) < np.exp(hub_s(20.0, 1.0)) < 1.0


def test_odds_are_against_the_best_alternative_the_removal_among_them() -> None:
    hub, bent = trial("hub_compliance", [1.0, 1.0], 12.0), trial("strut_bending", [1.0, 1.0], 5.0)
    logs = log_probabilities(place(hub, bent))
    assert best_alternative(logs, "hub_compliance") == ("strut_bending", pytest.approx(7.0 / np.log(10.0)))
    logs = log_probabilities(place(hub))
    assert best_alternative(logs, "hub_compliance") == (NO_EFFECT, pytest.approx(12.0 / np.log(10.0)))


def test_a_size_is_that_of_the_fit_that_knows_of_other_laws(monkeypatch: pytest.MonkeyPatch) -> None:
    found = discovery("pair").search
    large = next(h for h in found.with_law_discrepancy.model.members if h.effect == "hub_compliance")
    place = [h.name for h, _ in found.with_law_discrepancy.model.places()].index(large.name)
    sized = size_fit(found, DiscoveryWorkers())
    amplitudes, sd = amplitude_estimates(sized.fit, large)
    own_errors = replace(found.with_effects, z=1.1 * found.with_effects.z)  # as where the law is another
    searched = replace(found, with_effects=own_errors)
    screened = {s.hypothesis.name: s for s in found.first.screened}
    compared = []
    for member in found.with_law_discrepancy.model.members:
        refit, own = HypothesisFit(member, found.with_law_discrepancy, 1000.0), (screened[member.name],)
        compared.append(comparison(found.tuned, own, effect_change(found.tuned, own), (refit,), 1.0))
    for share in (0.0, 0.05, 0.1):
        shifts = {large.name: share * np.outer(sized.fit.z, [0.6, 0.8])}
        monkeypatch.setattr(findings_module, "size_fit", lambda *_, s=shifts: replace(sized, law_shifts=s))
        camber, _ = findings(searched, compared, DiscoveryWorkers())[place].estimates
        assert camber.value == pytest.approx(large.sizes[0].value(float(amplitudes[0])), rel=1e-3)
        assert camber.sd / camber.value == pytest.approx(
            np.hypot(sd[0] / amplitudes[0], max(share, LINEAR_TO)), rel=0.02
        )


def test_a_friction_s_force_is_one_number_to_a_share_at_best(monkeypatch: pytest.MonkeyPatch) -> None:
    """Its travel is not: a friction of 187.7 N was told as 187.45 +- 0.095 N."""
    answer = discovery("pair")

    def told(share: float) -> list[ParameterEstimate]:
        monkeypatch.setattr(findings_module, "CONSTANT_TO", share)
        every = findings(
            answer.search, alternatives(answer.search, 1.0, DiscoveryWorkers()), DiscoveryWorkers()
        )
        return list(next(f for f in every if f.hypothesis.effect == "steering_friction").estimates)

    assert findings_module.CONSTANT_TO == 0.0003
    (force, *others), (wider, *same) = told(0.0), told(0.1)
    assert wider.sd == pytest.approx(np.hypot(force.sd, 0.1 * force.value), rel=1e-6)
    assert others == same


def test_a_size_that_the_records_do_not_tell_from_none_has_a_limit() -> None:
    """By the records alone: information of 3 at 0.99 / (1 - 0.25), its share above the limit 5 %."""
    force = Size("force_N", 100.0, "N")
    below, above = estimate(force, 0.99, 0.99, 0.5, 0.5), estimate(force, 1.01, 1.01, 0.5, 0.5)
    alone, sd = 0.99 / 0.75, 3.0**-0.5
    assert below.limit is not None and above.limit is None
    share = norm.sf(below.limit / 100.0, alone, sd) / norm.sf(0.0, alone, sd)
    assert share == pytest.approx(0.05, rel=1e-3)
    assert below.shown and above.shown


def test_a_size_that_is_as_open_as_before_the_records_is_not_shown() -> None:
    stiffness = Size("k_N_mm", 100.0, "N/mm", "compliance")
    unseen, hardly = estimate(stiffness, 0.0, 0.0, 1.0, 1.0), estimate(stiffness, 0.0, 0.0, 0.85, 0.85)
    assert (unseen.shown, unseen.limit) == (False, None)
    assert unseen.value == pytest.approx(100.0 / 0.798, rel=1e-3)
    assert unseen.sd == pytest.approx(100.0 * 0.603 / 0.798**2, rel=2e-2)
    assert hardly.shown
    assert hardly.limit == pytest.approx(100.0 / (1.96 * (0.85**-2 - 1.0) ** -0.5), rel=1e-3)
    assert not estimate(Size("offset_mm", 7.0, "mm", signed=True), 0.1, 0.1, 0.95, 0.95).shown
    assert estimate(Size("presliding_mm", 0.1, "mm", "shape"), 0.1, 0.1, 0.95, 0.95).shown


@pytest.mark.parametrize(
    "size",
    [
        Size("offset_mm", 7.0, "mm", signed=True),
        Size("LLR_L", 1.25, "-", "factor", signed=True),
        Size("presliding_mm", 0.1, "mm", "shape"),
    ],
    ids=lambda size: size.key,
)
def test_a_size_of_either_sign_has_no_limit(size: Size) -> None:
    own = estimate(size, 0.1, 0.1, 0.5, 0.5)
    assert own.limit is None
    assert own.value == size.value(0.1)


def test_a_shape_with_several_optima_is_told_to_a_quarter_at_best() -> None:
    """The spread of rubber's yield distances; not its yield distance, a shape with one optimum."""
    (rubber, *_) = EFFECTS["rubber_hysteresis"].hypotheses()
    share, travel, spread = sd_of_one_number(rubber, np.array([1.0, -0.5, 1.3]), np.full(3, 0.01))
    size = rubber.sizes[2]
    value = size.value(1.3)
    assert size.key == "spread" and (share, travel) == (0.01, 0.01)
    assert size.value(1.3 + spread) / value - 1.0 == pytest.approx(0.25, abs=0.04)
    assert 1.0 - size.value(1.3 - spread) / value == pytest.approx(0.25, abs=0.04)


@pytest.mark.parametrize("spread", ["sets", "laws", "optima"])
def test_an_effect_that_is_another_size_elsewhere_is_no_trace(
    spread: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A friction of 338 N on a mount, certain and told as 447 +- 240 N, was neither an effect nor a trace."""
    function = f"spread_between_{spread}"
    monkeypatch.setattr(findings_module, function, lambda _, amplitudes, *__: 0.6 * np.abs(amplitudes))
    (found,) = findings(search(), [place(trial("hub_compliance", HUB, 400.0))], DiscoveryWorkers())
    assert found.relevant and found.seen and not found.small
    camber, _ = found.estimates
    assert camber.sd > 0.3 * camber.value and camber.limit is None and camber.shown


def test_what_other_sets_leave_of_a_size_counts() -> None:
    """It is told from none by what it is at least; a limit holds what all sets make of it."""
    force = Size("force_N", 100.0, "N")
    assert estimate(force, 1.0, 0.4, 0.1, 0.6).limit is None
    surely_less, wide = estimate(force, 1.0, 0.1, 0.1, 0.6), estimate(force, 1.0, 0.1, 0.1, 2.0)
    assert surely_less.limit is not None and surely_less.limit > 200.0
    assert wide.limit is not None and np.isfinite(wide.limit) and wide.shown


def test_an_effect_whose_size_hangs_on_one_that_it_may_hide_is_no_trace(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A steering friction of 126 +- 56 N, 193 N on a mount, was "too small to matter"."""
    wide = "spread_in_larger_sets"
    monkeypatch.setattr(findings_module, wide, lambda _, amplitudes, *__: np.abs(amplitudes))
    (found,) = findings(search(), [place(trial("hub_compliance", HUB, 400.0))], DiscoveryWorkers())
    assert found.relevant and found.seen
    assert all(e.sd > 0.5 * abs(e.value) for e in found.estimates)
