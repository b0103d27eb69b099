"""The search for a set of effects: which hypotheses are refitted at last."""

from __future__ import annotations

import pytest

from doe_kc.discovery.search import decision as decision_module
from doe_kc.discovery.search.search import search
from doe_kc.discovery.workers import DiscoveryWorkers
from tests.discovery.cases import library, model


@pytest.mark.parametrize(
    ("known", "tried"),
    [("hub_compliance", True), ("steering_friction", False)],
    ids=["beside a compliance", "not beside a friction, whose law may be another"],
)
def test_where_nothing_is_accepted_all_others_are_refitted(
    known: str, tried: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A steering friction of 210 N by a third law was answered as 322 N and a compliance of its mount."""
    asked = []
    monkeypatch.setattr(decision_module, "untried", lambda screened, trials: asked.append(trials) or [])
    found = search(model("pair"), library(known), DiscoveryWorkers())
    members = found.with_law_discrepancy.model.members
    assert [h.effect for h in members] == [known], "the car has both, the library one"
    assert bool(asked) is tried
