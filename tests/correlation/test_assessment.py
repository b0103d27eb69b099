"""When an axle is sound, doubtful or not usable, and what is said of it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from doe_kc.correlation.assessment import Objection, assess, harmed, inside
from doe_kc.correlation.loop import Run
from doe_kc.correlation.problem import Candidate, Problem
from doe_kc.correlation.reach import Relaxation
from doe_kc.correlation.result import Correlation
from doe_kc.targets import Improvement
from tests.correlation.synthetic import Synthetic, answer, synthetic

NEAR = 0.02


def correlation(case: Problem, point: np.ndarray) -> Correlation:
    """A run that ended at a design of the synthetic problem."""
    assert isinstance(case, Synthetic)
    runs = [
        case.judged(0, Candidate(case.space.start, "baseline"), answer(case, case.space.start)),
        case.judged(1, Candidate(point, "ego"), answer(case, point)),
    ]
    return Correlation("ego", case, Run(tuple(runs), 1, "converged"), (), None, 1.0)


@pytest.fixture(scope="module")
def case() -> Synthetic:
    return synthetic(20, curves=False)


def test_at_the_targets_it_is_sound(case: Synthetic) -> None:
    found = assess(correlation(case, case.truth), misfit=1.0)
    assert found.status == "sound" and found.line.startswith("Sound: All ")


def test_worse_than_before_is_not_usable(case: Synthetic) -> None:
    away = np.clip(2.0 * case.space.start - case.truth, 0.0, 1.0)
    found = assess(correlation(case, away), misfit=1.0)
    assert found.status == "not_usable" and found.line.startswith("Not usable: ")
    assert any(r.startswith("Worse than before: ") for r in found.reasons)


def test_no_better_design_is_not_usable(case: Synthetic) -> None:
    found = assess(correlation(case, case.space.start), misfit=1.0)
    assert found.status == "not_usable"
    assert "No design was better than the axle that was handed in." in found.reasons


def test_what_is_left_beside_noise_is_doubtful(case: Synthetic) -> None:
    found = assess(correlation(case, case.truth), misfit=1.7)
    assert found.status == "doubtful"
    assert found.reasons == ("The deviations that are left are 1.7 times the noise of the records.",)


def test_targets_out_of_reach_are_doubtful_and_named(case: Synthetic) -> None:
    half = correlation(case, 0.5 * (case.space.start + case.truth))
    outside = [e.target.entry.id for e in half.improvements if not inside(e)]
    assert outside
    relaxed = replace(half, relaxation=Relaxation(dict.fromkeys(outside, 1.0), {}))
    found = assess(relaxed, misfit=1.0)
    assert found.status == "doubtful"
    (sentence,) = [r for r in found.reasons if r.startswith("Out of reach within the bounds: ")]
    assert all(name in sentence for name in outside)


def test_many_variables_at_a_bound_are_doubtful(case: Synthetic) -> None:
    best = correlation(case, case.truth)
    point = best.best.point.copy()
    point[:5] = 1.0
    moved = replace(best.best, candidate=replace(best.best.candidate, point=point))
    runs = (best.run.evaluated[0], moved)
    found = assess(replace(best, run=replace(best.run, evaluated=runs)), misfit=1.0)
    assert found.status == "doubtful" and found.reasons[0].startswith("5 of 20 variables end at a bound")


def test_what_others_know_counts(case: Synthetic) -> None:
    best = correlation(case, case.truth)
    assert assess(best, misfit=1.0, further=[Objection("it is a class.")]).status == "doubtful"
    fatal = assess(best, misfit=1.0, further=[Objection("a."), Objection("b.", fatal=True)])
    assert fatal.status == "not_usable" and fatal.reasons == ("b.", "a.")


@pytest.mark.parametrize(
    ("final", "sd", "is_inside", "is_harmed"),
    [(1.1, 0.0, True, False), (1.3, 0.0, False, False), (1.3, 0.11, True, False), (1.6, 0.0, False, True)],
    ids=["in the interval", "as far as before at most", "in the noise", "further than before"],
)
def test_interval_noise_and_baseline(
    case: Synthetic, final: float, sd: float, is_inside: bool, is_harmed: bool
) -> None:
    target = replace(case.targets.characteristics[0], value=1.0, sd=sd, constraint=None)
    entry = Improvement(target, 1.5, final)
    assert inside(entry) == is_inside and harmed(entry) == is_harmed
