"""The verdict's rules, one by one."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from doe_kc.discovery.contrasts import Contrast
from doe_kc.discovery.disagreement import Map
from doe_kc.discovery.findings import probabilities
from doe_kc.discovery.fit import Fit
from doe_kc.discovery.held_out import HeldOut, Prediction
from doe_kc.discovery.result import Finding, Rival
from doe_kc.discovery.trials import Trial
from doe_kc.discovery.verdict import classes, verdict
from tests.discovery.cases import library, model

CLEAR = Finding(library("hub_compliance")[0], (), 0.99, (), 500.0, 40.0, 0.0, (), 1.2, True, True)
BETTER = (HeldOut("lateral", Prediction(5.0, -900.0), Prediction(1.0, -50.0)),)
NO_BETTER = HeldOut("steer", Prediction(1.0, -10.0), Prediction(1.0, -11.0))


def of(largest: float, *, count: int = 50) -> Map:
    """A map with one disagreement of that size and quiet noise elsewhere."""
    names = tuple(Contrast("lateral", "toe", "gradient", "both") for _ in range(count))
    z = np.full(count, 0.1)
    z[0] = largest
    return Map(names, z, np.eye(count))


def with_rms(rms: float) -> Fit:
    rows = 5000
    return Fit(model("none"), np.zeros(1), np.full(rows, rms), np.zeros((rows, 1)), 0.0, 1, True)


def judged(findings=(CLEAR,), *, before=60.0, after=2.0, held_out=BETTER, tuned=3.0, final=1.0):  # type: ignore[no-untyped-def]
    return verdict(list(findings), of(before), of(after), held_out, with_rms(tuned), with_rms(final))


def test_a_clear_effect_is_named() -> None:
    assert judged().kind == "named"


def test_nothing_found_and_nothing_left_needs_nothing() -> None:
    assert judged((), after=2.0, tuned=1.0).kind == "none"
    assert judged((), before=9.0, after=9.0, tuned=1.0).kind == "unexplained"


@pytest.mark.parametrize(
    ("case", "words"),
    [
        ({"after": 20.0}, "still disagrees by 20.0"),
        ({"final": 2.0}, "closes only"),
        ({"findings": (replace(CLEAR, largest=4.0, believed=False),)}, "4.0 times its typical size"),
        (
            {"held_out": (*BETTER, HeldOut("steer", Prediction(1.0, -10.0), Prediction(4.0, -200.0)))},
            "steer is predicted worse",
        ),
        (
            {"held_out": (HeldOut("steer", Prediction(1.0, -10.0), Prediction(1.0, -11.0)),)},
            "not predicted better",
        ),
        ({"findings": (CLEAR, CLEAR, replace(CLEAR, detectability=7.0))}, "3 effects at once"),
    ],
)
def test_what_speaks_against_a_name(case: dict, words: str) -> None:  # type: ignore[type-arg]
    found = judged(**case)
    assert found.kind == "unexplained"
    assert any(words in o for o in found.objections), found.objections


def test_a_small_remainder_of_a_gap_all_but_closed_is_the_shape_of_the_law() -> None:
    assert judged(before=60.0, after=11.0).kind == "named"
    assert judged(before=60.0, after=13.0).kind == "unexplained"


def test_doubt_between_effects_makes_a_class() -> None:
    unsure = replace(CLEAR, probability=0.6, rivals=(Rival("strut_bending", 0.4),))
    assert judged((unsure,)).kind == "class"
    assert classes([unsure]) == (("hub_compliance", "strut_bending"),)
    alike = replace(CLEAR, alike=("tie_rod_compliance",))
    assert judged((alike,)).kind == "class"
    assert classes([CLEAR, alike]) == (("hub_compliance", "tie_rod_compliance"),)


def test_probabilities_follow_the_evidence() -> None:
    hub, bending = library("hub_compliance", "strut_bending")
    fit = with_rms(1.0)
    sure = probabilities([Trial(hub, fit, 50.0), Trial(bending, fit, 40.0)], 1.0, 0.5)
    assert sure["hub_compliance"] == pytest.approx(0.98, abs=0.002)
    equal = probabilities([Trial(hub, fit, 50.0), Trial(bending, fit, 50.0)], 1.0, 0.5)
    assert equal["hub_compliance"] == equal["strut_bending"] == pytest.approx(0.495, abs=0.002)
    tempered = probabilities([Trial(hub, fit, 50.0), Trial(bending, fit, 40.0)], 10.0, 0.5)
    assert tempered["strut_bending"] > 0.2
    left_over = probabilities([Trial(hub, fit, 50.0)], 1.0, 1e-4)
    assert left_over["hub_compliance"] < 0.2
