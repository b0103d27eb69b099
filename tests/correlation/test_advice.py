"""What a user is told who asks for more than the levels can give."""

from __future__ import annotations

from dataclasses import replace

import pytest

from doe_kc.correlation.advice import level_sentences
from doe_kc.correlation.problem import Candidate, Evaluated, Problem
from doe_kc.variables import VariableOptions
from tests.correlation.cases import outcome, problem


def moved(case: Problem, sd: float, error: float) -> Problem:
    """The baseline as target of anti-lift, missed by `error`, and no other objective."""
    base = outcome(case.axle, case.space.values(case.space.start))
    rows = zip(case.targets.characteristics, base.characteristics[case.targets.rows], strict=True)
    targets = tuple(
        replace(t, value=v + error, sd=sd)
        if t.entry.id == "drive.anti_lift"
        else replace(t, objective=None, constraint=None)
        for t, v in rows
    )
    return replace(case, targets=replace(case.targets, characteristics=targets, curves=()))


def judged(case: Problem) -> Evaluated:
    start = case.space.start
    return case.judged(0, Candidate(start, "baseline"), outcome(case.axle, case.space.values(start)))


def test_levels_too_coarse_for_a_target_are_named_with_what_they_cost() -> None:
    case = moved(problem("car_b", VariableOptions(levels=101)), sd=0.0, error=1e-4)
    (sentence,) = level_sentences(case, judged(case), case.linearize(case.space.start))
    row = case.linearize(case.space.start).characteristics[case.targets.rows]
    at = [t.entry.id for t in case.targets.characteristics].index("drive.anti_lift")
    largest = abs(row[at]).max() * 0.5 / 100.0
    assert sentence.startswith("drive.anti_lift: half a level of LLF.z moves it by ")
    assert f"{largest:.2g} %" in sentence and 'levels = "continuous"' in sentence


@pytest.mark.parametrize(("sd", "error"), [(0.1, 1e-4), (0.0, 1.0)], ids=["noisy target", "far from it"])
def test_nothing_is_said_where_levels_do_not_matter(sd: float, error: float) -> None:
    case = moved(problem("car_b", VariableOptions(levels=101)), sd=sd, error=error)
    assert level_sentences(case, judged(case), case.linearize(case.space.start)) == []


def test_nothing_is_said_of_continuous_variables() -> None:
    case = moved(problem("car_b"), sd=0.0, error=1e-4)
    assert level_sentences(case, judged(case), case.linearize(case.space.start)) == []
