"""Each effect of the last set against its removal and its rivals, whatever the order they came in by."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from doe_kc.discovery.fit import last_member, member_detectability
from doe_kc.discovery.search.effect_search import EffectSearch
from doe_kc.discovery.search.refits import HypothesisFit, plausible
from doe_kc.discovery.verdict import alternatives as alternatives_module
from doe_kc.discovery.verdict.alternatives import (
    Alternatives,
    alternatives,
    alternatives_by_group,
    effect_change,
    in_groups,
)
from doe_kc.discovery.verdict.findings import findings
from doe_kc.discovery.workers import DiscoveryWorkers
from tests.discovery.cases import discovery

BOTH = {"hub_compliance", "steering_friction"}


@pytest.fixture(scope="module")
def found() -> EffectSearch:
    return discovery("pair").search


@pytest.fixture(scope="module")
def compared(found: EffectSearch) -> tuple[Alternatives, ...]:
    return alternatives(found, 1.0, DiscoveryWorkers())


def test_two_effects_are_named_and_are_no_class() -> None:
    answer = discovery("pair")
    assert answer.verdict == "named", answer.sentences
    assert {f.hypothesis.effect for f in answer.findings} == BOTH
    assert answer.classes == ()
    for f in answer.findings:
        assert f.probability > 0.98
        assert f.log10_odds > 6.0
        assert not {r.effect for r in f.rivals} & BOTH


def test_no_member_of_the_set_is_a_rival_of_another(compared: tuple[Alternatives, ...]) -> None:
    for one in compared:
        assert {t.hypothesis.effect for t in one.trials[1:]} <= {"strut_bending", "tie_rod_compliance"}
        assert {s.hypothesis.effect for s in one.screened} & BOTH == {one.hypothesis.effect}
        assert all(plausible(t) for t in one.trials)


def test_an_effect_is_taken_out_of_the_whole_set(
    compared: tuple[Alternatives, ...], found: EffectSearch
) -> None:
    """Not out of the set that it came into."""
    for one in compared:
        others = {h.effect for h in found.with_law_discrepancy.model.members} - {one.hypothesis.effect}
        assert {h.effect for h in one.without.model.members} == others
        assert one.loss == pytest.approx(one.trials[0].fit.evidence - one.without.evidence)


def test_the_order_of_two_effects_does_not_matter(
    compared: tuple[Alternatives, ...], found: EffectSearch
) -> None:
    first, second = found.with_law_discrepancy.model.members
    swapped = replace(
        found,
        with_law_discrepancy=last_member(found.with_law_discrepancy, first),
        with_effects=last_member(found.with_effects, first),
    )
    assert swapped.with_law_discrepancy.model.members == (second, first)
    there = findings(found, compared, DiscoveryWorkers())
    back = findings(swapped, alternatives(swapped, 1.0, DiscoveryWorkers()), DiscoveryWorkers())
    for one, other in zip(there, reversed(back), strict=True):
        assert one.hypothesis == other.hypothesis
        assert one.log10_odds == pytest.approx(other.log10_odds, rel=1e-3, abs=0.05)
        assert one.probability == pytest.approx(other.probability, abs=1e-6)
        assert one.rivals == other.rivals


def test_a_first_trial_at_its_bound_is_no_rival_of_the_effect_beside_it(
    compared: tuple[Alternatives, ...], found: EffectSearch
) -> None:
    """Beside no friction, a hub may win by an absurd size; beside friction it is in the set itself."""
    hub = next(s for s in found.screened if s.hypothesis.effect == "hub_compliance")
    friction = next(c for c in compared if c.hypothesis.effect == "steering_friction")
    model = found.tuned.model.extended(hub.hypothesis)
    fit = replace(found.tuned, model=model, z=np.append(found.tuned.z, [1.5, 6.0]))
    own = np.hstack([found.tuned.jacobian.own, 100.0 * np.ones((fit.residual.size, 2)) * [[1.0, 0.3]]])
    absurd = HypothesisFit(hub.hypothesis, replace(fit, jacobian=model.jacobian(own)), 50_000.0)
    first = replace(found.first, trials=(*found.first.trials, absurd))
    again = alternatives(replace(found, first=first), 1.0, DiscoveryWorkers())
    same = next(c for c in again if c.hypothesis == friction.hypothesis)
    assert "hub_compliance" not in {t.hypothesis.effect for t in same.trials}
    assert same.loss == pytest.approx(friction.loss)


def test_one_effect_alone_is_judged_by_the_refits_of_the_search() -> None:
    """No solution more: the set without it is the re-tuned axle."""
    search = discovery("named").search
    (one,) = alternatives(search, 1.0, DiscoveryWorkers())
    assert one.without is search.first.before
    assert {id(t) for t in one.trials[1:]} <= {id(t) for t in search.first.trials}


def test_of_several_effects_no_derivatives_are_kept(compared: tuple[Alternatives, ...]) -> None:
    for one in compared:
        assert not any(f.jacobian.own.size for f in (one.without, *(t.fit for t in one.trials)))
        assert not any(s.change.size for s in one.screened)
        assert one.without.evidence == pytest.approx(one.trials[0].fit.evidence - one.loss)


def test_what_an_effect_makes_of_the_records_is_seen_in_the_set_without_it() -> None:
    """Camber under lateral force, of a compliant hub; alike to itself wholly."""
    search = discovery("named").search
    hub = next(s for s in search.first.screened if s.hypothesis.effect == "hub_compliance")
    change = effect_change(search.tuned, [hub, hub])
    assert change.correlations == (("hub_compliance", pytest.approx(1.0)),)
    worst = search.tuned.model.contrasts.names[int(np.argmax(change.contrasts))]
    assert worst.response == "camber" and "lateral" in worst.load_case


def test_members_are_taken_a_few_at_a_time() -> None:
    assert in_groups([1, 2, 3, 4, 5, 6, 7]) == [[1, 2, 3], [4, 5, 6], [7]]
    assert in_groups([]) == []


def test_the_weakest_member_is_compared_first(
    compared: tuple[Alternatives, ...], found: EffectSearch, monkeypatch: pytest.MonkeyPatch
) -> None:
    """One group or several, each is the same."""
    monkeypatch.setattr(alternatives_module, "AT_ONCE", 1)
    groups = list(alternatives_by_group(found, 1.0, DiscoveryWorkers()))
    strengths = [member_detectability(found.with_effects, one.hypothesis) for (one,) in groups]
    assert strengths == sorted(strengths) and len(groups) == len(BOTH)
    again = {one.hypothesis.name: one for (one,) in groups}
    for one in compared:
        assert again[one.hypothesis.name].loss == pytest.approx(one.loss, rel=1e-12)


def test_a_decoy_stands_in_the_place_of_the_strongest_member(
    compared: tuple[Alternatives, ...], found: EffectSearch
) -> None:
    """Which the verdict begins with."""
    strongest = max(compared, key=lambda one: member_detectability(found.with_effects, one.hypothesis))
    assert {t.hypothesis.effect for t in strongest.trials} > {strongest.hypothesis.effect}
