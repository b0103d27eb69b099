from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from doe_kc.characteristics import CHARACTERISTICS
from doe_kc.correlation.problem import Candidate, Evaluated, Problem
from doe_kc.correlation.reach import Relaxation, conflict, level_sentences, out_of_reach, reaches, relaxation
from doe_kc.ground.typing import FloatArray
from doe_kc.targets import Constraint, Objective, Target
from doe_kc.variables import VariableOptions
from tests.correlation.cases import outcome, problem

ENTRIES = list(CHARACTERISTICS.values())


def target(i: int, value: float, half: float = 0.1) -> Target:
    return Target(
        entry=ENTRIES[i], value=value, sd=0.0, objective=Objective(),
        constraint=Constraint(low=value - half, high=value + half),
    )  # fmt: skip


SLOPES = np.array([[2.0, -1.0], [0.0, 4.0]])
POINT = np.array([0.5, 0.25])


def test_span_over_the_bounds() -> None:
    np.testing.assert_allclose(reaches(np.array([1.0, 0.0]), SLOPES, POINT), [[-0.75, 2.25], [-1.0, 3.0]])


def test_targets_that_the_bounds_do_not_reach_are_out_of_reach() -> None:
    targets = [target(0, 5.0), target(1, 2.0)]
    assert out_of_reach(targets, np.array([1.0, 0.0]), SLOPES, POINT) == [0]


def test_a_target_that_only_harm_to_another_would_reach_is_out_of_reach() -> None:
    slopes = np.array([[1.0, 0.0], [1.0, 0.1]])
    targets = [target(0, 0.4), target(1, 0.0)]  # the second is where it shall be, and moves with the first
    values, point = np.zeros(2), np.array([0.5, 0.5])
    assert out_of_reach(targets, values, slopes, point) == [0]
    free = np.array([[1.0, 0.0], [0.0, 1.0]])
    assert out_of_reach(targets, values, free, point) == []


def relaxed(targets: list[Target], values: FloatArray, slopes: FloatArray, point: FloatArray) -> Relaxation:
    prior = np.full(point.size, 12.0**-0.5)
    return relaxation(targets, values, slopes, point, prior, [f"p{i}" for i in range(point.size)])


def test_a_bound_that_is_a_little_narrow_is_used_up() -> None:
    """One variable moves the value to 0.5 of the 0.6 wanted: the interval is widened to what is left."""
    found = relaxed([target(0, 0.6, half=0.02)], np.zeros(1), np.array([[1.0]]), np.array([0.5]))
    assert found.distances[ENTRIES[0].id] == pytest.approx(1.1 * 0.1, rel=0.3)
    assert found.limits[ENTRIES[0].id] == ("p0",)


def test_a_missing_effect_does_not_bend_all_parameters() -> None:
    """Thirty variables together would move the value by a fifth of what is missing: it stays where it is."""
    slopes = np.full((1, 30), 0.01)
    found = relaxed([target(0, 0.75, half=0.01)], np.zeros(1), slopes, np.full(30, 0.5))
    assert found.distances[ENTRIES[0].id] > 0.9 * 0.75


def test_a_target_on_which_the_study_insists_is_not_relaxed() -> None:
    firm = replace(target(0, 5.0), relax=False)
    assert relaxed([firm], np.zeros(1), SLOPES[:1], POINT).distances == {}


@settings(max_examples=60, deadline=None)
@given(seed=st.integers(0, 10_000))
def test_what_is_relaxed_is_never_further_than_it_was(seed: int) -> None:
    rng = np.random.default_rng(seed)
    values, slopes = rng.normal(size=4), rng.normal(size=(4, 3))
    targets = [target(i, float(v), half=0.05) for i, v in enumerate(rng.normal(scale=3.0, size=4))]
    found = relaxed(targets, values, slopes, np.full(3, 0.5))
    for t, v in zip(targets, values, strict=True):
        assert found.distances.get(t.entry.id, 0.0) <= abs(v - t.value) + 1e-12


def test_constraints_that_one_variable_cannot_serve_both() -> None:
    slopes = np.array([[1.0, 0.0], [1.0, 0.0], [0.0, 1.0]])
    targets = [target(0, 0.4), target(1, -0.4), target(2, 0.1)]
    found = conflict(targets, np.zeros(3), slopes, np.array([0.5, 0.5]))
    assert found is not None
    named = {t.entry.id for t in (*found.violated, *found.against)}
    assert named == {ENTRIES[0].id, ENTRIES[1].id}


def test_constraints_that_can_be_met_are_no_conflict() -> None:
    targets = [target(0, 0.2), target(1, 0.5)]
    assert conflict(targets, np.zeros(2), SLOPES, POINT) is None


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
