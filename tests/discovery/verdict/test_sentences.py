"""The verdict and what is advised next, in words."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import pytest

from doe_kc.discovery.result import Finding, VerdictKind
from doe_kc.discovery.verdict.component_test import ComponentTest
from doe_kc.discovery.verdict.exclusion import HypothesisStatus
from doe_kc.discovery.verdict.sentences import next_tests, sentences, trace_words
from doe_kc.discovery.verdict.verdict import Verdict
from doe_kc.effects import EFFECTS
from tests.discovery.cases import discovery, library


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


def test_a_trace_is_not_called_untestable() -> None:
    (rod,) = library("tie_rod_compliance")
    status = HypothesisStatus(
        rod, "trace", 9.0, 0.99, (), (), component_test=ComponentTest(("scb.Tz",), 12.4)
    )
    (advice,) = next_tests(Verdict("none"), (), (), [status], {})
    assert advice.startswith("Seen only as a trace, tie-rod compliance: ")


def opening(kind: VerdictKind, findings: Sequence[Finding]) -> str:
    found = discovery("named")
    return sentences(
        Verdict(kind), findings, found.adequacy, found.gap, found.residual_map, None, (), 1.0, ()
    )[0]


def test_a_sure_effect_beside_a_class_is_told_as_sure() -> None:
    one = discovery("named").findings[0]
    (friction,), (offset,) = library("strut_friction"), library("ride_height_offset")
    sure = replace(one, hypothesis=friction, estimates=(), verdict="named")
    unsure = replace(one, hypothesis=offset, estimates=(), verdict="class")
    alone = (
        "The model lacks an effect that is most likely ride-height offset, but others cannot be told from it."
    )
    assert opening("class", [replace_sizes(unsure)]) == alone
    assert opening("class", [replace_sizes(sure), replace_sizes(unsure)]) == alone.replace(
        "an effect", "strut friction, and an effect"
    )
    both = opening("class", [replace_sizes(unsure), replace_sizes(replace(sure, verdict="class"))])
    assert "effects that are most likely ride-height offset and strut friction" in both


def replace_sizes(finding: Finding) -> Finding:
    """Without numbers."""
    return replace(finding, hypothesis=replace(finding.hypothesis, sizes=()), estimates=())


def test_a_roll_technique_says_which_one() -> None:
    one = discovery("named").findings[0]
    techniques = [
        replace_sizes(replace(one, hypothesis=h, verdict="named")) for h in library("roll_technique")
    ]
    words = {opening("named", [t]) for t in techniques}
    assert len(words) == len(techniques) and all("roll technique (" in w for w in words)


def test_a_size_that_is_not_told_from_none_is_its_limit_in_a_sentence() -> None:
    found = discovery("named")
    (camber, toe), one = found.findings[0].estimates, found.findings[0]
    limit = replace(toe, limit=20000.0, shown=True)
    told = replace(one, estimates=(camber, limit), elsewhere=("LLR_R",))
    _, line, other, *_ = sentences(
        Verdict("named"), [told], found.adequacy, found.gap, found.residual_map, None, (), 1.0, ["Other."]
    )
    assert "toe_Nm_deg not told from rigid (above 20000 Nm/deg, 95 %)" in line
    assert "; at LLR right it would do as well" in line and other == "Other."


@pytest.mark.parametrize(
    ("small", "words"), [(True, "too small to matter"), (False, "too weakly to be named")]
)
def test_what_is_seen_and_not_named_is_said_why(small: bool, words: str) -> None:
    """A mount of 2900 N/mm with even odds was "too small to matter"."""
    assert trace_words(replace(discovery("named").findings[0], small=small)) == words
