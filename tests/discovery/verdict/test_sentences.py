"""What is advised next, in words."""

from __future__ import annotations

from doe_kc.discovery.verdict.component_test import ComponentTest
from doe_kc.discovery.verdict.exclusion import HypothesisStatus
from doe_kc.discovery.verdict.sentences import next_tests
from doe_kc.discovery.verdict.verdict import Verdict
from doe_kc.effects import EFFECTS
from tests.discovery.cases import library


def test_parts_that_show_a_hidden_effect_are_advised_the_fewest_parts_first() -> None:
    (rod,), (arm,) = library("tie_rod_compliance"), library("steer_arm_compliance")
    statuses = [
        HypothesisStatus(h, "not testable", 9.0, 0.99, (), (), component_test=ComponentTest(parts, 12.4))
        for h, parts in ((rod, ("scb.Tz", "arb.radius")), (arm, ("scb.Tz",)))
    ]
    first, second = next_tests(Verdict("none"), (), (), statuses, {})
    assert first == (
        f"Not testable here, {EFFECTS['steer_arm_compliance'].label.lower()}: "
        f"{EFFECTS['steer_arm_compliance'].shown_by}; or measure scb.Tz on a bench, after which its typical "
        "size is 12 times its uncertainty."
    )
    assert "measure scb.Tz, arb.radius on a bench" in second
