"""SMT's EGO driven one iteration at a time."""

from __future__ import annotations

import numpy as np
import pytest

from doe_kc.correlation.methods import smt_ego
from doe_kc.correlation.methods._base import MethodSettings
from doe_kc.correlation.methods._smt import propose
from doe_kc.correlation.methods.smt_ego import SmtEgo
from doe_kc.correlation.problem import Candidate
from doe_kc.ground.errors import RunError
from tests.correlation.synthetic import answer, synthetic


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
