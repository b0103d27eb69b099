"""The scoring, on analysers that know the key, nothing, or luck."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from benchmarks.discovery import pretend
from benchmarks.discovery.answer import read_answer
from benchmarks.discovery.detectability import wrong_name
from benchmarks.discovery.report import Run, write
from benchmarks.discovery.scoring import Predicted, Score, score
from benchmarks.discovery.statistics import brier, calibration_error, reliability, wilson
from benchmarks.discovery.suites import ALL_SUITES
from benchmarks.discovery.table import followup_lines, groups, parameter_lines, small_effect_lines
from benchmarks.discovery.truth import TrueEffect, Truth

RUN = Run("python x", "example", 1, "abc", "a machine")


def _truth(name: str, suite: str, *ids: str, outside: str = "") -> Truth:
    effects = tuple(TrueEffect(i, 1.0, "", {"force_N": 250.0}, False) for i in ids)
    shows = frozenset({("brake", "spin")}) if outside else frozenset()
    small = (TrueEffect("strut_friction", 0.04, "", {"force_N": 4.0}, True),)
    return Truth(name, suite, effects, small, outside, shows)


TRUTHS = (
    _truth("a", "null"),
    _truth("b", "single", "steering_friction"),
    _truth("c", "single", "hub_compliance"),
    _truth("d", "two", "steering_friction", "hub_compliance"),
    _truth("e", "library_deleted", "strut_bending"),
    _truth("f", "outside", outside="kink"),
)


def clear(truth: Truth) -> Predicted:
    """Every hidden effect stands out by itself."""
    return Predicted(dict.fromkeys(truth.ids, (50.0, 0.001)))


def _scores(analyser: Callable[[Truth], dict[str, Any]]) -> list[Score]:
    return [score(t, read_answer(analyser(t)), clear(t)) for t in TRUTHS]


def test_the_perfect_analyser_is_always_right(tmp_path: Path) -> None:
    found = _scores(pretend.perfect)
    assert all(s.exact for s in found if s.suite in ("null", "single", "two"))
    assert all(s.unexplained for s in found if s.suite in ("library_deleted", "outside"))
    assert not any(s.wrong or s.missed or s.trace for s in found)
    assert found[5].placed
    assert found[3].found and found[3].in_class
    assert all(e.z == 0.0 for s in found for e in s.estimates)
    assert found[1].closed == pytest.approx(1.0) and found[1].decoy == pytest.approx(0.5)
    assert [s.members for s in found] == [(0, 0), (1, 1), (1, 1), (2, 2), (0, 0), (0, 0)]
    text = "\n".join(write(found, RUN, tmp_path))
    assert "of those diagnosable by themselves: 4/4 = 100 % (51-100)" in text
    assert "false names: 0/4" in text
    assert "| single | 2 | 100 (34-100) |" in text
    assert (tmp_path / "discovery.png").stat().st_size > 10_000
    assert (tmp_path / "discovery_reliability.png").stat().st_size > 10_000
    assert (tmp_path / "discovery_confusion.csv").read_text().startswith("hidden,")


def test_cars_with_several_effects_alone_have_no_confusion(tmp_path: Path) -> None:
    several = [s for s in _scores(pretend.perfect) if s.suite == "two"]
    assert "discovery.png" not in "\n".join(write(several, RUN, tmp_path))
    assert not (tmp_path / "discovery.png").exists()


def test_finding_nothing_is_right_for_null_cars_only() -> None:
    found = _scores(pretend.always_none)
    assert [s.exact for s in found] == [True, False, False, False, False, False]
    assert [s.missed for s in found] == [False, True, True, True, True, True]
    assert not any(s.wrong for s in found)
    assert [s.members for s in found] == [(0, 0), (0, 1), (0, 1), (0, 2), (0, 0), (0, 0)]


def test_a_member_that_is_too_weak_or_like_another_is_not_asked_for() -> None:
    weak, alike = {"hub_compliance": (9.0, 0.001)}, {"steering_friction": (50.0, 0.2)}
    found = score(TRUTHS[3], read_answer(pretend.always_none(TRUTHS[3])), Predicted(weak | alike))
    assert found.members == (0, 0)
    assert found.diagnosable is False


def test_a_name_beside_something_unexplained_counts_whether_right_or_wrong() -> None:
    named = pretend.perfect(TRUTHS[3]) | {"verdict": "unexplained"}
    named["effects"] = [effect | {"verdict": "named"} for effect in named["effects"]]
    both = score(TRUTHS[3], read_answer(named), clear(TRUTHS[3]))
    assert both.members == (2, 2) and both.false_names == (0, 2)
    assert not both.exact and not both.wrong and both.names == ()
    other = score(TRUTHS[4], read_answer(named), None)
    assert other.wrong and other.false_names == (2, 2)
    assert [right for _, right in both.believed] == [True] * 2
    assert [right for _, right in other.believed] == [False] * 2


@pytest.mark.parametrize(
    ("verdict", "said", "is_open"),
    [
        ("none", ["steering_friction", "hub_compliance"], True),
        ("none", ["hub_compliance"], False),
        ("unexplained", ["steering_friction", "hub_compliance"], False),
    ],
)
def test_an_effect_that_is_said_not_to_be_testable_is_left_open(
    verdict: str, said: list[str], is_open: bool
) -> None:
    answer = pretend.always_none(TRUTHS[3]) | {"verdict": verdict, "not_testable": said}
    found = score(TRUTHS[3], read_answer(answer), clear(TRUTHS[3]))
    assert found.open is is_open
    assert not found.in_class


@pytest.mark.parametrize(
    ("place", "above", "is_open"),
    [
        ("LLR", [370.0, None, 370.0], True),
        ("LLR", [None, 370.0, None], False),
        ("LLF", [370.0, 370.0, 370.0], True),
        ("LLR", [None, 900.0, None], False),
    ],
    ids=["its component is not shown", "excluded", "only elsewhere", "excluded above its size"],
)
def test_a_place_that_the_records_do_not_show_is_left_open(
    place: str, above: list[float | None], is_open: bool
) -> None:
    effect = TrueEffect("bushing_preload", 1.0, "LLR", {"LLR[0]": 40.0, "LLR[1]": 600.0}, False)
    truth = Truth("x", "confounded", (effect,), (), "", frozenset())
    said = {"id": "bushing_preload", "location": place, "above": {place: {"value": above, "unit": "N"}}}
    assert score(truth, read_answer({"verdict": "none", "excluded": [said]})).open is is_open


def test_what_the_tests_advised_bring_is_told() -> None:
    truths = [_truth(name, "confounded", "steering_friction") for name in "abc"]
    first = [
        score(truths[0], read_answer(pretend.perfect(truths[0]))),
        *(score(t, read_answer(pretend.always_none(t))) for t in truths[1:]),
    ]
    again = [score(truths[1], read_answer(pretend.perfect(truths[1])))]
    (line,) = followup_lines(first, [])
    assert "none was carried out" in line and "at once: 1/3" in line
    assert followup_lines([], []) == []
    (line,) = followup_lines(first, again)
    assert "exact set 1/1" in line and "wrong name 0/1" in line and "at once or then: 2/3" in line


def test_luck_names_wrongly_and_is_sure() -> None:
    found = [s for seed in range(20) for s in _scores(lambda t, at=seed: pretend.lucky(t, at))]
    assert sum(s.wrong for s in found) / len(found) > 0.7
    assert calibration_error([b for s in found for b in s.believed]) > 0.6


@pytest.mark.parametrize(
    ("ident", "place", "true", "above", "wrong"),
    [
        ("steering_friction", "", {"force_N": 250.0}, {"force_N": 200.0}, True),
        ("steering_friction", "", {"force_N": 250.0}, {"force_N": 300.0}, False),
        ("strut_bending", "", {"k_Nm_deg": 6500.0}, {"k_Nm_deg": 9000.0}, True),
        ("strut_bending", "", {"k_Nm_deg": 6500.0}, {"k_Nm_deg": None}, False),
        ("bushing_preload", "LLR", {"LLR[0]": 9.0, "LLR[2]": -1177.0}, {"LLR": [370.0, 370.0, 370.0]}, True),
        ("bushing_preload", "LLR", {"LLR[0]": 9.0, "LLR[2]": -1177.0}, {"LLR": [370.0, 370.0, None]}, False),
        ("bushing_preload", "LLF", {"LLF[0]": 900.0}, {"LLR": [370.0, 370.0, 370.0]}, False),
        ("steering_ratio", "", {"factor": 0.9}, {"factor": 1.05}, True),
    ],
)
def test_an_exclusion_of_what_is_there_is_counted(
    ident: str, place: str, true: dict[str, float], above: dict[str, Any], wrong: bool
) -> None:
    truth = Truth("x", "single", (TrueEffect(ident, 1.0, place, true, False),), (), "", frozenset())
    said = {"id": ident, "location": "LLR" if ident == "bushing_preload" else None}
    said["above"] = {key: {"value": value, "unit": ""} for key, value in above.items()}
    found = score(truth, read_answer({"verdict": "none", "excluded": [said]}))
    assert found.excluded == (int(wrong), 1)


def test_a_class_is_no_name() -> None:
    effects = [{"id": "strut_bending", "location": None, "probability": 0.6, "parameters": {}}]
    classes = [["strut_bending", "hub_compliance"]]
    answer = read_answer({"verdict": "class", "effects": effects, "classes": classes})
    found = score(TRUTHS[2], answer)
    assert answer.names == ()
    assert found.in_class and not found.exact and not found.wrong and not found.top
    assert score(TRUTHS[1], answer).in_class is False


def test_a_trace_counts_as_such_only_in_its_own_size() -> None:
    def answer(force: float) -> Score:
        numbers = {"force_N": {"value": force, "sd": 1.0, "unit": "N"}}
        effect = {"id": "strut_friction", "probability": 0.99, "parameters": numbers}
        return score(TRUTHS[0], read_answer({"verdict": "named", "effects": [effect]}))

    assert answer(5.0).trace and not answer(5.0).wrong
    assert answer(80.0).wrong and not answer(80.0).trace


def test_a_trace_that_is_told_is_scored_by_what_the_car_has() -> None:
    """Of a small effect and of a hidden one; not of what the car has not got, nor at another place."""
    hidden = TrueEffect("bushing_preload", 0.1, "LLR", {"LLR[1]": 60.0}, False)
    small = TrueEffect("strut_friction", 0.04, "", {"force_N": 4.0}, True)
    truth = Truth("x", "single", (hidden,), (small,), "", frozenset())

    def trace(ident: str, location: str | None, **values: float) -> dict[str, Any]:
        numbers = {key: {"value": value, "sd": 1.0, "unit": "N"} for key, value in values.items()}
        return {"id": ident, "location": location, "parameters": numbers}

    told = [
        trace("strut_friction", None, force_N=5.5),
        trace("bushing_preload", "LLR", **{"LLR[1]": 57.0}),
        trace("bushing_preload", "LLF", **{"LLF[1]": 57.0}),
        trace("hub_compliance", None, camber_Nm_deg=90000.0),
    ]
    found = score(truth, read_answer({"verdict": "none", "traces": told}))
    assert found.traced == (2, 4)
    assert {(e.effect, e.z, e.approximate) for e in found.traces} == {
        ("strut_friction", 1.5, True),
        ("bushing_preload", -3.0, False),
    }
    lines = "\n".join(small_effect_lines([found]))
    assert "that the car has: 2/4" in lines and "another shape: 1, within 1 sd: 0/1" in lines


@pytest.mark.parametrize(("limit", "above"), [(3.0, (1, 1)), (5.0, (0, 1)), (None, (0, 0))])
def test_a_limit_of_exclusion_is_scored_by_the_small_effect_that_every_car_has(
    limit: float | None, above: tuple[int, int]
) -> None:
    said = {"id": "strut_friction", "location": None, "above": {"force_N": {"value": limit, "unit": "N"}}}
    found = score(TRUTHS[0], read_answer({"verdict": "none", "excluded": [said]}))
    assert found.limits == above and found.excluded == (0, 0)


def test_leads_of_an_unexplained_verdict_are_no_names() -> None:
    effect = {"id": "hub_compliance", "probability": 0.99, "parameters": {}}
    found = score(TRUTHS[1], read_answer({"verdict": "unexplained", "effects": [effect]}))
    assert not found.wrong and found.unexplained and found.first == "unexplained"


def test_an_analysis_that_broke_off_is_no_answer() -> None:
    found = score(TRUTHS[0], read_answer(None))
    assert found.verdict == "failed" and not found.exact


@pytest.mark.parametrize("verdict", ["named", "unexplained"])
def test_location_and_numbers(verdict: str) -> None:
    effect = TrueEffect("bushing_preload", 1.0, "LLR", {"LLR[1]": 600.0}, False)
    truth = Truth("x", "single", (effect,), (), "", frozenset())
    numbers = {"LLR[1]": {"value": 660.0, "sd": 40.0, "unit": "N"}}
    named = {"id": "bushing_preload", "location": "llr", "probability": 0.95, "parameters": numbers}
    found = score(truth, read_answer({"verdict": verdict, "effects": [{**named, "verdict": "named"}]}))
    assert found.located == (1, 1)
    assert found.estimates[0].z == pytest.approx(1.5)
    assert found.estimates[0].relative == pytest.approx(0.1)


@pytest.mark.parametrize("verdict", ["named", "unexplained"])
def test_a_name_elsewhere_is_a_wrong_place(verdict: str) -> None:
    effect = TrueEffect("bushing_preload", 1.0, "LLR", {"LLR[1]": 600.0}, False)
    truth = Truth("x", "single", (effect,), (), "", frozenset())
    named = {"id": effect.id, "location": "LLF", "probability": 0.95, "parameters": {}, "verdict": "named"}
    found = score(truth, read_answer({"verdict": verdict, "effects": [named]}))
    assert found.located == (0, 1)


@pytest.mark.parametrize(
    ("true", "value", "limit", "right"),
    [
        (9000.0, 30000.0, 8000.0, True),
        (7000.0, 30000.0, 8000.0, False),
        (50.0, 40.0, 90.0, True),
        (95.0, 40.0, 90.0, False),
    ],
    ids=["a stiffer joint", "a softer one", "a smaller force", "a larger one"],
)
def test_a_size_told_as_a_limit_is_judged_by_that(
    true: float, value: float, limit: float, right: bool
) -> None:
    effect = TrueEffect("x", 1.0, "", {"size": true, "other": 1.0, "unseen": 1.0}, False)
    truth = Truth("x", "single", (effect,), (), "", frozenset())
    numbers = {
        "size": {"value": value, "sd": value, "limit": limit},
        "other": {"value": 1.5, "sd": 0.4, "limit": None},
        "unseen": {"value": 1.5, "sd": 1.0, "limit": None, "shown": False},
    }
    named = {"id": "x", "location": None, "probability": 0.95, "parameters": numbers}
    found = score(truth, read_answer({"verdict": "named", "effects": [named]}))
    assert found.estimates[0].within_limit is right
    told, limits, every = parameter_lines([found])
    assert "told as a value: 1, within 1 sd: 0/1" in told
    assert f"told as a limit: {int(right)}/1" in limits
    assert "all by value and sd, 1 not shown by the records among them: 3, within" in every


def test_a_stiffer_left_is_a_softer_right() -> None:
    effect = TrueEffect("left_right_asymmetry", 1.0, "LLR_L", {"LLR_L": 1.25}, False)
    truth = Truth("x", "single", (effect,), (), "", frozenset())
    numbers = {"LLR_R": {"value": 0.78, "sd": 0.02, "unit": "-"}}
    named = {"id": effect.id, "location": "LLR_R", "probability": 0.95, "parameters": numbers}
    found = score(truth, read_answer({"verdict": "named", "effects": [named]}))
    assert found.located == (1, 1)
    assert found.estimates[0].true == pytest.approx(0.8)
    assert found.estimates[0].z == pytest.approx(-1.0)


def test_wilson_interval() -> None:
    """59 of 60 and 0 of 120, as tabulated."""
    assert wilson(59, 60) == pytest.approx((0.911, 0.997), abs=1e-3)
    assert wilson(0, 120) == pytest.approx((0.0, 0.031), abs=1e-3)
    assert wilson(0, 0) == (0.0, 1.0)


def test_calibration() -> None:
    honest = [(0.8, True)] * 8 + [(0.8, False)] * 2
    assert calibration_error(honest) == pytest.approx(0.0)
    assert brier(honest) == pytest.approx(0.16)
    assert reliability([(1.0, True), (0.2, False)])[-1].right.hits == 1
    assert math.isnan(brier([]))


def test_chance_of_a_wrong_name() -> None:
    """10.4 standard deviations tell apart two effects that correlate by 0.9, 99 times in 100."""
    assert wrong_name(10.42, 0.9) == pytest.approx(0.01, abs=5e-4)
    assert wrong_name(5.0, 1.0) == pytest.approx(0.5)


def test_every_suite_has_its_place_in_the_table() -> None:
    truths = [_truth(f"case_{i}", suite, "hub_compliance") for i, suite in enumerate(ALL_SUITES)]
    found = [score(t, read_answer(pretend.perfect(t))) for t in reversed(truths)]
    assert [s for s in groups(found) if s in ALL_SUITES] == list(ALL_SUITES)


@pytest.mark.parametrize(("location", "share"), [("LLR", 0.4), ("REST", 0.2), ("", 0.2 * 2.0 ** (1 / 3))])
def test_rubber_is_compared_with_the_bushings_that_were_told(location: str, share: float) -> None:
    """The rear bushing's own share, 0.4, was taken for wrong where that of all was 0.25."""
    own = {"share": {"LLR": 0.4, "LLF": 0.1, "UPB": 0.4}}
    effect = TrueEffect("rubber_hysteresis", 1.0, "", {"share": 0.25}, True, own)
    told = {"id": "rubber_hysteresis", "location": location, "probability": 0.99}
    told["parameters"] = {"share": {"value": share, "sd": 0.01}}
    truth = Truth("x", "rubber", (effect,), (), "", frozenset())
    found = score(truth, read_answer({"verdict": "named", "effects": [told]}), clear(truth))
    assert [e.z for e in found.estimates] == [pytest.approx(0.0, abs=1e-9)]
