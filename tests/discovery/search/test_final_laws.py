"""The laws and the optimum that a set ends with."""

from __future__ import annotations

import pytest

from doe_kc.discovery.search.final_laws import with_final_laws
from tests.discovery.search.law_answers import Answers, beside_a_hub, rubber_alone


def test_a_set_whose_laws_are_the_best_ends_as_it_is() -> None:
    final = with_final_laws(beside_a_hub(), frozenset(), Answers(5.0))
    assert [h.law for h in final.fit.model.members] == ["", ""]
    assert final.loss == 0.0 and not final.changed


def test_the_best_closed_law_of_a_friction_changes_a_set() -> None:
    final = with_final_laws(beside_a_hub(), frozenset(), Answers(-1.0, best="iwan"))
    assert [h.law for h in final.fit.model.members] == ["iwan", ""]
    assert final.loss == 0.0 and final.changed


def test_bushings_that_differ_change_a_set_and_cost_evidence() -> None:
    """Here half of what they are worse by: their numbers move no curve, so that the prior loses nothing."""
    final = with_final_laws(rubber_alone(), frozenset(), Answers(3.0))
    assert [h.law for h in final.fit.model.members] == ["each"] and final.changed
    assert final.loss == pytest.approx(1.5)


def test_bushings_that_differ_cost_nothing_where_they_say_more() -> None:
    """Else a set with a further effect was compared with less than the set has without it."""
    final = with_final_laws(rubber_alone(), frozenset(), Answers(-3.0))
    assert [h.law for h in final.fit.model.members] == ["each"] and final.changed
    assert final.loss == 0.0
