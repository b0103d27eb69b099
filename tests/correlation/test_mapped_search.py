"""`ego` led by a twin, on outside models whose answer is known."""

from __future__ import annotations

import numpy as np
import pytest

from doe_kc.correlation.loop import Run, run_method
from doe_kc.correlation.methods import MethodSettings
from doe_kc.correlation.methods.ego import Ego
from doe_kc.correlation.methods.ego.mapped_search import MAPPED
from doe_kc.correlation.options import Gradients
from doe_kc.correlation.problem import Problem
from doe_kc.correlation.twin_agreement import twin_agreement
from doe_kc.correlation.twin_changes import explained_share
from tests.correlation.synthetic import Synthetic, solver, synthetic
from tests.correlation.twins import lacking, unrelated, with_twin

BUDGET = 30


def search(
    problem: Synthetic, budget: int = BUDGET, *, gradients: Gradients = "auto", first: int | None = None
) -> Run:
    settings = MethodSettings(seed=1, budget=budget, gradients=gradients, first=first)
    return run_method(problem, Ego(problem, settings), solver(problem), budget=budget)


def deviation(problem: Problem, run: Run, n: int) -> float:
    """Smallest sum of squared normalised deviations of the first n designs, over the baseline's."""
    wanted = np.array([t.value for t in problem.targets.characteristics])
    scale = np.array([t.scale for t in problem.targets.characteristics])
    errors = [
        float((((e.score.values - wanted) / scale) ** 2).sum())
        for e in run.evaluated[:n]
        if e.score is not None
    ]
    return min(errors) / errors[0]


def test_a_twin_that_lacks_something_leads_to_the_answer_within_a_few_designs() -> None:
    known = synthetic()
    run = search(with_twin(lacking(known.map)), 8)
    assert run.evaluated[1].candidate.origin == MAPPED
    assert deviation(known, run, 3) < 0.05
    assert deviation(known, run, 8) < 1e-3 < deviation(known, search(known, 8, gradients=False), 8)


def test_a_twin_of_something_else_is_let_go() -> None:
    problem = with_twin(unrelated(synthetic().map))
    run = search(problem)
    origins = [e.candidate.origin for e in run.evaluated]
    last = max(i for i, origin in enumerate(origins) if origin == MAPPED)
    assert last < 12 and origins[last + 1] == "opening sample"
    alone = search(problem, gradients=False)
    for count in (8, 16, BUDGET):  # what the mapping learns is worth more than the sample that it puts off
        assert deviation(problem, run, count) < max(deviation(problem, alone, count), 1e-6)
    agreement = twin_agreement(problem, run.evaluated, run.evaluated[run.best])
    assert agreement is not None and agreement.status == "not_usable" and not agreement.usable
    assert "too little to lead" in agreement.line


def test_a_twin_without_an_answer_does_not_stop_the_search() -> None:
    problem = with_twin(lacking(synthetic().map), fails=True)
    run = search(problem, 12)
    assert MAPPED not in [e.candidate.origin for e in run.evaluated] and len(run.evaluated) > 3
    agreement = twin_agreement(problem, run.evaluated, run.evaluated[run.best])
    assert agreement is not None and agreement.status == "not_usable" and "no equilibrium" in agreement.line


def test_without_gradients_the_twin_is_not_asked() -> None:
    run = search(with_twin(lacking(synthetic().map)), 12, gradients=False)
    assert MAPPED not in [e.candidate.origin for e in run.evaluated]


def test_an_opening_sample_that_is_asked_for_comes_first() -> None:
    run = search(with_twin(lacking(synthetic().map)), 6, first=3)
    assert [e.candidate.origin for e in run.evaluated[1:5]] == [*["opening sample"] * 3, MAPPED]


def test_the_share_of_changes_that_a_twin_makes() -> None:
    known = synthetic()
    same, other = with_twin(known.map), with_twin(unrelated(known.map))
    run = search(same, 4)
    assert explained_share(same, run.evaluated) == pytest.approx(1.0, abs=1e-12)
    assert (explained_share(other, run.evaluated) or 0.0) < 0.0
    assert explained_share(same, run.evaluated[:1]) is None
    assert explained_share(known, run.evaluated) is None


def test_an_equal_twin_is_sound_and_a_shift_of_one_variable_is_named() -> None:
    known = synthetic()
    run = search(with_twin(known.map), 3)
    sound = twin_agreement(with_twin(known.map), run.evaluated, run.evaluated[run.best])
    assert sound is not None and sound.status == "sound" and sound.usable and sound.shift is None
    moved = np.zeros(known.space.dimension)
    moved[4] = 0.05
    z = known.map.centre + moved
    shifted = with_twin(type(known.map)(z, known.map.value, known.map.slope, known.map.bend))
    found = twin_agreement(shifted, run.evaluated, run.evaluated[run.best])
    assert found is not None and found.status == "doubtful" and found.shift is not None
    assert found.shift.path == known.space.paths[4] and found.shift.share > 0.9
    slope = float(known.space.slopes(known.space.start)[4])
    assert found.shift.change == pytest.approx(0.05 * slope, rel=0.15)
    worst = found.rows[0]
    assert worst.load_case == "vertical" and worst.size > 1.0 and worst in found.beyond
