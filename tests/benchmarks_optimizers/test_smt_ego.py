"""SMT's EGO driven one iteration at a time."""

from __future__ import annotations

import numpy as np
import pytest

from benchmarks.optimizers import smt_ego
from benchmarks.optimizers.smt_ego import SmtEgo, propose
from doe_kc.correlation.loop import run_method
from doe_kc.correlation.methods import METHODS, MethodSettings
from doe_kc.correlation.problem import Candidate
from doe_kc.ground.errors import RunError
from tests.correlation.synthetic import answer, at_random, solver, synthetic


def parabola(points: np.ndarray) -> np.ndarray:
    return np.asarray(((points - [0.3, 0.7]) ** 2).sum(axis=1))


def test_ego_gains_on_its_first_sample() -> None:
    points = np.random.default_rng(0).random((8, 2))
    first = parabola(points).min()
    for _ in range(2):
        found = propose(points, parabola(points), number=1, seed=1)
        assert found[0].loss_sd >= 0.0 and np.isfinite(found[0].loss)
        points = np.vstack([points, found[0].point])
    assert parabola(points).min() < 0.5 * first


def test_several_designs_of_one_iteration_differ_and_leave_the_data_alone() -> None:
    points = np.random.default_rng(0).random((8, 2))
    losses = parabola(points)
    copies = points.copy(), losses.copy()
    found = propose(points, losses, number=2, seed=1)
    assert len(found) == 2
    assert not np.allclose(found[0].point, found[1].point, atol=1e-6)
    assert np.array_equal(points, copies[0]) and np.array_equal(losses, copies[1])


def test_a_training_failure_ends_the_search_and_keeps_the_run(monkeypatch: pytest.MonkeyPatch) -> None:
    def broken(*_: object, **__: object) -> list[object]:
        raise RunError("SMT's EGO could not be trained.")

    monkeypatch.setattr(smt_ego, "propose", broken)
    problem = synthetic(3)
    method = SmtEgo(problem, MethodSettings(seed=1, budget=10, first=3))
    points = np.array([problem.space.start, problem.truth, 0.5 * (problem.space.start + problem.truth)])
    designs = [problem.judged(i, Candidate(p, ""), answer(problem, p)) for i, p in enumerate(points)]
    method.tell(designs)
    while method.ask():
        method.tell([])
    assert method.stopped == "SMT's EGO could not be trained."


@pytest.mark.parametrize("share", [0.0, 0.3])
def test_a_run_keeps_to_budget_and_levels_and_survives_failures(share: float) -> None:
    problem = synthetic(3)
    method = SmtEgo(problem, MethodSettings(seed=1, budget=7, first=5))
    run = run_method(problem, method, solver(problem, fails=at_random(share)), budget=7)
    points = np.array([e.point for e in run.evaluated])
    assert 1 < len(points) <= 7 and len(np.unique(points, axis=0)) == len(points)
    assert np.array_equal(points[1:], problem.space.snapped(points[1:]))
    assert run.evaluated[run.best].merit >= run.evaluated[0].merit
    origins = {e.candidate.origin for e in run.evaluated}
    assert share or "expected improvement" in origins


def test_is_no_method_of_the_product() -> None:
    assert "smt_ego" not in METHODS
