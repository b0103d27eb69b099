"""The verdict's rules, one by one."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from doe_kc.discovery.fit import Fit
from doe_kc.discovery.jacobian import Jacobian
from doe_kc.discovery.result import Finding, Rival
from doe_kc.discovery.screening.contrasts import Contrast
from doe_kc.discovery.screening.disagreement import Map
from doe_kc.discovery.verdict.adequacy import adequacy
from doe_kc.discovery.verdict.held_out import HeldOut, HeldOutScore
from doe_kc.discovery.verdict.verdict import classes, verdict
from tests.discovery.cases import library, model

CLEAR = Finding(
    library("hub_compliance")[0], (), 0.99, 2.0, "", (), 500.0, 40.0, 0.0, (), 1.2, True, True, True
)
SIZE = 1300


def held(case: str, tuned: tuple[float, float], with_effect: tuple[float, float]) -> HeldOut:
    """(RMS, score) without and with the effect."""
    after = HeldOutScore(*with_effect, SIZE)
    return HeldOut(case, HeldOutScore(*tuned, SIZE), after, after)


BETTER = (held("lateral", (5.0, -900.0), (1.0, -50.0)),)


def of(largest: float, *, count: int = 50) -> Map:
    """A map with one disagreement of that size and quiet noise elsewhere."""
    names = tuple(Contrast("lateral", "toe", "gradient", "both") for _ in range(count))
    z = np.full(count, 0.1)
    z[0] = largest
    noise = np.abs(np.random.default_rng(11).standard_normal((1000, count))).max(axis=1)
    return Map(names, z, noise)


def with_rms(rms: float) -> Fit:
    rows = 5000
    return Fit(model("none"), np.zeros(1), np.full(rows, rms), Jacobian(np.zeros((rows, 1))), 0.0, 1, True)


def judged(findings=(CLEAR,), *, after=2.0, held_out=BETTER, tuned=3.0, final=1.0):  # type: ignore[no-untyped-def]
    return verdict(list(findings), of(after), held_out, with_rms(tuned), with_rms(final))


def test_a_clear_effect_is_named() -> None:
    assert judged().kind == "named"


def test_nothing_found_and_nothing_left_needs_nothing() -> None:
    assert judged((), after=2.0, tuned=1.0).kind == "none"
    assert judged((), after=9.0, tuned=1.0).kind == "unexplained"


@pytest.mark.parametrize(
    ("case", "words"),
    [
        ({"after": 20.0}, "still disagrees by 20.0"),
        ({"final": 2.0}, "closes only"),
        ({"findings": (replace(CLEAR, largest=4.0, believed=False),)}, "4.0 times its typical size"),
        (
            {"held_out": (*BETTER, held("steer", (1.0, -10.0), (1.05, -200.0)))},
            "steer is predicted worse",
        ),
        (
            {"held_out": (held("steer", (1.0, -10.0), (1.0, -11.0)),)},
            "not predicted better",
        ),
        ({"held_out": (*BETTER, held("steer", (4.0, -900.0), (1.23, -90.0)))}, "RMS of 1.23"),
    ],
)
def test_what_speaks_against_a_name(case: dict, words: str) -> None:  # type: ignore[type-arg]
    found = judged(**case)
    assert found.kind == "unexplained"
    assert any(words in o for o in found.objections), found.objections


def test_held_out_load_cases_are_predicted_in_absolute_terms() -> None:
    """Better than without the effect is not enough; what chance gives so many records is."""
    assert judged(held_out=(*BETTER, held("steer", (4.0, -900.0), (1.06, -90.0)))).kind == "named"
    assert judged(held_out=(*BETTER, held("steer", (4.0, -900.0), (1.23, -90.0)))).kind == "unexplained"
    granted = replace(held("steer", (4.0, -900.0), (1.23, -90.0)), law_granted=HeldOutScore(1.0, 0.0, SIZE))
    assert judged(held_out=(*BETTER, granted)).kind == "named"


def test_an_unlikely_map_is_no_law_s_shape() -> None:
    """However much of the gap is closed."""
    assert judged(after=11.0, tuned=60.0).kind == "unexplained"


def test_a_weak_one_among_many_clear_effects_is_named() -> None:
    weak = replace(CLEAR, detectability=8.0)
    assert judged((CLEAR, CLEAR, CLEAR, CLEAR, weak)).kind == "named"


def test_the_adequacy_is_one_statement_and_no_constant() -> None:
    good, poor = (adequacy(of(largest), BETTER) for largest in (1.0, 3.6))
    assert good.holds
    assert poor.holds
    assert good.unlisted == pytest.approx(0.0196, abs=1e-4)
    assert poor.unlisted is not None
    assert 0.02 < poor.unlisted < 0.3
    failed = adequacy(of(1.0), (*BETTER, held("steer", (4.0, -900.0), (1.23, -90.0))))
    assert not failed.holds
    assert failed.unlisted is None
    assert failed.worst is not None
    assert failed.worst.load_case == "steer"
    assert adequacy(of(9.0), ()).unlisted is None


def test_doubt_between_effects_makes_a_class() -> None:
    unsure = replace(CLEAR, probability=0.6, rivals=(Rival("strut_bending", 0.4),))
    assert judged((unsure,)).kind == "class"
    assert classes([unsure]) == (("hub_compliance", "strut_bending"),)
    alike = replace(CLEAR, alike=("tie_rod_compliance",))
    assert judged((alike,)).kind == "class"
    assert classes([CLEAR, alike]) == (("hub_compliance", "tie_rod_compliance"),)
