"""The parts of the hybrid search, and what it is for: solvers that jump and fail."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import differential_evolution

from doe_kc.correlation.loop import run_method
from doe_kc.correlation.methods._base import MethodSettings
from doe_kc.correlation.methods.hybrid import method as hybrid
from doe_kc.correlation.methods.hybrid.evolution import DifferentialEvolution, Mutation
from doe_kc.correlation.methods.hybrid.method import Hybrid
from doe_kc.correlation.methods.hybrid.model_searches import linear_model
from doe_kc.correlation.methods.hybrid.search import LEAST_CREDIT, Credit, SearchTrial, reward
from doe_kc.correlation.modelled.history import SearchHistory, nearest
from doe_kc.correlation.problem import Candidate, Evaluated
from doe_kc.ground.typing import FloatArray
from doe_kc.true_solver.outcome import failure
from tests.correlation.synthetic import Synthetic, answer, at_random, solver, synthetic


def judged(problem: Synthetic, points: FloatArray, *, failed: int = 0) -> list[Evaluated]:
    """Designs, the last ones failed."""
    outcomes = [answer(problem, p) for p in points[: len(points) - failed]]
    outcomes += [failure("test")] * failed
    return [
        problem.judged(i, Candidate(p, "test"), o)
        for i, (p, o) in enumerate(zip(points, outcomes, strict=True))
    ]


def drawn(problem: Synthetic, count: int) -> FloatArray:
    return problem.space.snapped(np.random.default_rng(0).random((count, problem.space.dimension)))


def trial(problem: Synthetic, gain: float) -> SearchTrial:
    design = judged(problem, problem.space.start[None])[0]
    return SearchTrial(design, design.merit - gain)


def test_the_linear_model_is_exact_for_a_linear_map() -> None:
    rng = np.random.default_rng(0)
    x, slope = rng.random((10, 4)), rng.random((3, 4))
    y = 2.0 + x @ slope.T
    model = linear_model(x[0], x, y)
    new = rng.random((5, 4))
    assert model.predict(new) == pytest.approx(2.0 + new @ slope.T, abs=1e-4)
    assert model.gradient(new)[0] == pytest.approx(slope, abs=1e-4)
    assert model.variance(new).max() < 1e-8


def test_the_linear_model_of_few_designs_goes_through_them() -> None:
    rng = np.random.default_rng(0)
    x, y = rng.random((4, 9)), rng.random((4, 2))
    assert linear_model(x[0], x, y).predict(x) == pytest.approx(y, abs=1e-3)


def test_credit_goes_to_who_gains_and_never_vanishes() -> None:
    problem = synthetic(4)
    credit = Credit(3)
    for _ in range(20):
        credit.reward(0, trial(problem, 1e9))
        credit.reward(1, trial(problem, -1.0))
        credit.reward(2, trial(problem, 0.0))
    assert credit.probability.sum() == pytest.approx(1.0)
    assert credit.probability[0] > 0.8
    assert credit.probability[1:].min() >= LEAST_CREDIT


def test_a_failure_earns_nothing() -> None:
    problem = synthetic(4)
    dead = judged(problem, problem.space.start[None], failed=1)[0]
    assert reward(SearchTrial(dead, -1.0)) == 0.0


def test_fresh_designs_are_new_and_on_levels() -> None:
    problem = synthetic(4)
    record = SearchHistory(problem, judged(problem, drawn(problem, 6)), seed=0)
    rng = np.random.default_rng(0)
    known = record.evaluated[2].point
    found = record.fresh(known, [record.evaluated[3].point], rng)
    assert np.array_equal(found, problem.space.snapped(found))
    assert not any(np.array_equal(found, e.point) for e in record.evaluated)
    assert np.abs(found - known).max() <= 0.3
    new = problem.space.snapped(np.full(4, 0.123))
    assert np.array_equal(record.fresh(new, [], rng), new)


def test_the_record_keeps_failures_apart() -> None:
    problem = synthetic(4)
    points = drawn(problem, 8)
    record = SearchHistory(problem, judged(problem, points, failed=2), seed=0)
    assert len(record.sound) == 6
    assert len(record.archive.points) == 6
    assert record.doubtful(points[7])
    assert not record.doubtful(points[0])


def test_nearest_designs_keep_their_order() -> None:
    problem = synthetic(4)
    designs = judged(problem, drawn(problem, 10))
    chosen = nearest(designs, designs[4].point, 3)
    assert len(chosen) == 3
    assert designs[4] in chosen
    assert [e.index for e in chosen] == sorted(e.index for e in chosen)


@pytest.mark.parametrize("search", [DifferentialEvolution(), Mutation()])
def test_blind_searches_stay_inside_the_bounds(search: DifferentialEvolution | Mutation) -> None:
    problem = synthetic(4)
    record = SearchHistory(problem, judged(problem, drawn(problem, 12)), seed=0)
    rng = np.random.default_rng(0)
    for _ in range(50):
        found = search.propose(record, rng)
        assert found is not None
        assert found.point.min() >= 0.0 and found.point.max() <= 1.0


def test_mutations_grow_after_success_and_shrink_after_failure() -> None:
    problem = synthetic(4)
    record = SearchHistory(problem, judged(problem, problem.space.start[None]), seed=0)

    def size(gain: float) -> float:
        search = Mutation()
        for _ in range(8):
            search.learn(trial(problem, gain))
        found = search.propose(record, np.random.default_rng(0))
        assert found is not None
        return float(np.abs(found.point - problem.space.start).max())

    assert size(1.0) > 3.0 * size(-1.0)


def test_beats_differential_evolution_with_ten_times_the_budget() -> None:
    problem = synthetic(12)
    space = problem.space

    def loss(u: FloatArray) -> float:
        point = space.snapped(u)
        return -problem.judged(0, Candidate(point, ""), answer(problem, point)).merit

    rival = differential_evolution(
        loss,
        [(0.0, 1.0)] * 12,
        x0=space.start,
        popsize=3,
        maxiter=14,
        polish=False,
        rng=np.random.default_rng(1),
    )
    assert rival.nfev >= 450
    method = Hybrid(problem, MethodSettings(seed=1, budget=45))
    run = run_method(problem, method, solver(problem), budget=45)
    assert -run.evaluated[run.best].merit < 0.01 * rival.fun


@pytest.mark.parametrize("share", [0.0, 0.3])
def test_crosses_a_jump_between_start_and_answer(share: float) -> None:
    """All outputs are half as large again on the answer's side."""
    problem = synthetic(12, jump=0.5)
    method = Hybrid(problem, MethodSettings(seed=1, budget=70))
    run = run_method(problem, method, solver(problem, fails=at_random(share)), budget=70)
    best = run.evaluated[run.best]
    assert best.rating is not None and best.rating.feasible
    assert -best.merit < 1e-4 * -run.evaluated[0].merit


def test_several_searches_contribute_and_say_who_they_are() -> None:
    problem = synthetic(12)
    method = Hybrid(problem, MethodSettings(seed=2, budget=70))
    run = run_method(problem, method, solver(problem), budget=70)
    origins = {e.candidate.origin for e in run.evaluated}
    assert {"surrogate", "linear model", "differential evolution", "mutation", "restart"} <= origins
    modelled = [e for e in run.evaluated if e.candidate.origin in ("surrogate", "linear model")]
    assert sum(e.candidate.predicted is not None for e in modelled) > 0.5 * len(modelled)


def test_stops_when_nothing_gains_any_more(monkeypatch: pytest.MonkeyPatch) -> None:
    patience = 15
    monkeypatch.setattr(hybrid, "HYBRID_PATIENCE", patience)
    problem = synthetic(3)
    method = Hybrid(problem, MethodSettings(seed=1, budget=400))
    run = run_method(problem, method, solver(problem), budget=400)
    assert run.stopped.startswith("no search gained") and f"last {patience} designs" in run.stopped
    assert len(run.evaluated) < 400
    merits = [e.merit for e in run.evaluated]
    before, idle = max(merits[:-patience]), max(merits[-patience:])
    assert idle - before <= hybrid.HYBRID_PROGRESS * abs(before) < max(merits) - merits[0]
