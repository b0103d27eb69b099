"""The search for a set of effects: which hypotheses are refitted at last."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest

from doe_kc.discovery.fit import Fit
from doe_kc.discovery.search import decision as decision_module
from doe_kc.discovery.search import search as search_module
from doe_kc.discovery.search.decision import Decision
from doe_kc.discovery.search.final_laws import FinalLaws
from doe_kc.discovery.search.refits import HypothesisFit
from doe_kc.discovery.search.search import search
from doe_kc.discovery.workers import DiscoveryWorkers
from tests.discovery.cases import discovery, library, model


@pytest.mark.parametrize(
    ("known", "order"),
    [
        ("ball_joint_compliance", ["others"]),
        ("hub_compliance", ["laws", "others"]),
        ("steering_friction", ["laws", "others", "others"]),  # at the end by another closed law
    ],
    ids=["beside an effect of one law", "beside a compliance", "beside a friction"],
)
def test_where_nothing_is_accepted_laws_are_tried_and_then_all_others(
    known: str, order: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """A steering friction of 210 N by a third law was answered as 322 N and a compliance of its mount."""
    asked = []
    monkeypatch.setattr(decision_module, "untried", lambda *_: asked.append("others") or [])
    monkeypatch.setattr(search_module, "with_free_laws", lambda fit, *_: (asked.append("laws") or fit, set()))
    found = search(model("pair"), library(known), DiscoveryWorkers())
    members = found.with_law_discrepancy.model.members
    assert [h.effect for h in members] == [known], "the car has both, the library one"
    assert asked == order


def test_a_step_whose_laws_gain_nothing_is_told_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """It stood twice in the picture of the evidence: before its other effects were tried, and with them."""
    monkeypatch.setattr(search_module, "with_free_laws", lambda fit, *_: (fit, set()))
    found = search(model("pair"), library("steering_friction"), DiscoveryWorkers())
    assert [[h.effect for h in step.members] for step in found.steps] == [[], ["steering_friction"]]
    assert [step.accepted for step in found.steps] == [True, False]


def test_a_search_goes_back_to_no_laws_that_it_had(monkeypatch: pytest.MonkeyPatch) -> None:
    """A friction of 299 N went between two laws without end, each better than the effect that came next."""
    asked = []
    monkeypatch.setattr(search_module, "laws_instead", lambda fit, *_: asked.append(1) or fit)
    found = search(model("pair"), library("steering_friction", "hub_compliance"), DiscoveryWorkers())
    assert {h.effect for h in found.with_effects.model.members} == {"steering_friction", "hub_compliance"}
    assert 1 <= len(asked) <= 6


def test_an_effect_comes_in_with_the_best_laws_beside_it(monkeypatch: pytest.MonkeyPatch) -> None:
    """Not with those of the set before it, which Prandtl-Iwan's law of a strut friction left far behind."""
    given, taken = [], []
    monkeypatch.setattr(
        search_module,
        "laws_instead",
        lambda _, further, *__: given.append(replace(further.fit)) or given[-1],
    )
    with_loops = search_module.with_loops
    monkeypatch.setattr(
        search_module, "with_loops", lambda fit, *a, **k: taken.append(fit) or with_loops(fit, *a, **k)
    )
    found = search(model("pair"), library("steering_friction", "hub_compliance"), DiscoveryWorkers())
    assert [step.accepted for step in found.steps] == [True, True, False]
    assert len(taken) == len(given) == 2 and all(a is b for a, b in zip(taken, given, strict=True))


def test_a_law_that_explains_a_friction_comes_in_with_it(monkeypatch: pytest.MonkeyPatch) -> None:
    """And is not compared again at the end."""
    explaining, compared = search_module.with_explaining_law, []

    def noted(fit: Fit, *given: Any) -> tuple[Fit, frozenset[str]]:
        taken, _ = explaining(fit, *given)
        return taken, frozenset(h.name for h in taken.model.members)

    final = search_module.with_final_laws
    monkeypatch.setattr(search_module, "with_explaining_law", noted)
    monkeypatch.setattr(
        search_module,
        "with_final_laws",
        lambda fit, own, *given: compared.append(own) or final(fit, own, *given),
    )
    search(model("friction"), library("steering_friction"), DiscoveryWorkers())
    assert compared and all(own == {"steering_friction"} for own in compared)


@pytest.mark.parametrize("changes", [0, 9])
def test_effects_are_asked_for_once_more_beside_the_laws_that_a_set_ends_with(
    changes: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """And the laws not again where none comes in; the step is told once."""
    asked = []
    decisions: list[int] = []
    next_decision = search_module.next_decision
    monkeypatch.setattr(
        search_module,
        "with_final_laws",
        lambda fit, *_: asked.append(1) or FinalLaws(fit, 0.0, len(asked) <= changes),
    )
    monkeypatch.setattr(
        search_module,
        "next_decision",
        lambda fit, *a, **k: decisions.append(len(fit.model.members)) or next_decision(fit, *a, **k),
    )
    found = search(model("named"), library("hub_compliance"), DiscoveryWorkers())
    assert decisions == [0, 1] + [1] * min(changes, 1) and len(asked) == 1
    assert [len(step.members) for step in found.steps] == [0, 1]


def test_the_laws_of_the_end_are_asked_for_again_beside_an_effect_that_came_in_by_them(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    asked: list[int] = []
    next_decision = search_module.next_decision

    def hidden(fit: Fit, *given: Any, **named: Any) -> Decision:
        decision = next_decision(fit, *given, **named)
        return decision if asked or not fit.model.members else replace(decision, accepted=False)

    monkeypatch.setattr(search_module, "next_decision", hidden)
    monkeypatch.setattr(
        search_module,
        "with_final_laws",
        lambda fit, *_: asked.append(len(fit.model.members)) or FinalLaws(fit, 0.0, True),
    )
    found = search(model("pair"), library("hub_compliance", "steering_friction"), DiscoveryWorkers())
    assert asked == [1, 2] and len(found.with_effects.model.members) == 2


def test_an_effect_that_a_law_makes_needless_does_not_come_in(monkeypatch: pytest.MonkeyPatch) -> None:
    asked = []
    monkeypatch.setattr(search_module, "needless_beside_laws", lambda *_: asked.append(1) or len(asked) > 1)
    found = search(model("pair"), library("hub_compliance", "steering_friction"), DiscoveryWorkers())
    assert len(found.with_law_discrepancy.model.members) == 1, "the car has both"
    assert [step.accepted for step in found.steps] == [True, False] and not found.steps[-1].added
    assert len(asked) > 1


def test_refits_that_lose_are_told_without_their_derivatives() -> None:
    """The car has another effect beside the compliance, so that every effect of the library is refitted."""
    found = search(model("pair"), library("hub_compliance", "steering_ratio"), DiscoveryWorkers())
    last = found.steps[-1]
    assert [h.effect for h in last.members] == ["hub_compliance"] and not last.accepted
    assert any(c.joint and c.hypothesis.effect == "steering_ratio" for c in last.candidates)


def test_what_passes_but_is_not_taken_is_told_so(monkeypatch: pytest.MonkeyPatch) -> None:
    """As where a set has as many effects as it may have."""
    monkeypatch.setattr(search_module, "EFFECTS_MOST", 0)
    found = search(model("pair"), library("hub_compliance"), DiscoveryWorkers())
    (step,) = found.steps
    assert not found.with_effects.model.members and not step.accepted and not step.added
    assert step.candidates[0].joint and step.candidates[0].gain > 100.0


def test_a_refit_of_several_effects_tells_all_of_them() -> None:
    """It stands by the last of them, the others beside it; what was screened stands alone."""
    ended = discovery("pair").search
    both = ended.with_effects
    *others, last = both.model.members
    decision = replace(ended.first, trials=(HypothesisFit(last, both, 9.0),), accepted=True)
    step = decision.step(both.model.likelihood, ended.prior)
    first, *screened = step.candidates
    assert (first.hypothesis, first.beside) == (last, tuple(others)) and others
    assert step.added == both.model.members
    assert screened and not any(c.beside for c in screened)
