"""What every registered correlation method promises, on a problem without a solver."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from doe_kc.correlation.loop import Evaluate, Run, run_method
from doe_kc.correlation.methods import METHODS, Method, MethodSettings
from doe_kc.correlation.methods.pareto import infill
from doe_kc.correlation.problem import Candidate, Evaluated
from doe_kc.ground.typing import FloatArray
from doe_kc.true_solver.outcome import Outcome, failure
from tests.correlation.synthetic import Fails, Synthetic, at_random, everywhere, solver, synthetic

BUDGETS = {"gauss_newton": 15, "pareto": 30}
FIRST = 16
FACTORS = {"gauss_newton": 20.0}
"""By which the loss falls within the budget; the others: 100."""
CONTINUOUS = {"gauss_newton"}
WITHOUT_CHANCE = {"gauss_newton"}
everyone = pytest.mark.parametrize("name", list(METHODS))
by_chance = pytest.mark.parametrize("name", [n for n in METHODS if n not in WITHOUT_CHANCE])


@pytest.fixture(autouse=True)
def _short_searches(monkeypatch: pytest.MonkeyPatch) -> None:
    """A promise holds for any number of generations."""
    monkeypatch.setattr(infill, "GENERATIONS", 5)


@cache
def case() -> Synthetic:
    return synthetic(12)


def settings(name: str, seed: int = 1, batch: int = 1) -> MethodSettings:
    return MethodSettings(seed=seed, budget=BUDGETS.get(name, 45), batch=batch, first=FIRST)


def started(name: str, *, seed: int = 1, batch: int = 1) -> Method:
    return METHODS[name](case(), settings(name, seed, batch))


def run(name: str, method: Method | None = None, evaluate: Evaluate | None = None) -> Run:
    used = method or started(name)
    return run_method(case(), used, evaluate or solver(case()), budget=settings(name).budget)


@cache
def plain(name: str) -> Run:
    """A run without failures, used by several tests."""
    return run(name)


def points(evaluated: Sequence[Evaluated]) -> FloatArray:
    return np.array([e.point for e in evaluated])


@everyone
def test_spends_no_more_than_the_budget_and_says_why_it_stopped(name: str) -> None:
    found = plain(name)
    assert 1 < len(found.evaluated) <= settings(name).budget
    assert found.stopped
    assert [e.index for e in found.evaluated] == list(range(len(found.evaluated)))


@everyone
def test_the_baseline_comes_first_and_every_candidate_has_an_origin(name: str) -> None:
    found = plain(name).evaluated
    assert found[0].candidate.origin == "baseline"
    assert np.array_equal(found[0].point, case().space.start)
    assert all(e.candidate.origin and e.candidate.origin != "baseline" for e in found[1:])


@everyone
def test_points_lie_within_the_bounds_and_on_levels(name: str) -> None:
    found = points(plain(name).evaluated[1:])
    assert found.min() >= 0.0
    assert found.max() <= 1.0
    if name not in CONTINUOUS:
        assert np.array_equal(found, case().space.snapped(found))


@by_chance
def test_evaluates_no_design_twice(name: str) -> None:
    found = points(plain(name).evaluated)
    assert len(np.unique(found, axis=0)) == len(found)


@everyone
def test_improves_the_rating(name: str) -> None:
    found = plain(name)
    before, after = found.evaluated[0].merit, found.evaluated[found.best].merit
    assert before < 0.0
    assert -after <= -before / FACTORS.get(name, 100.0)


@everyone
def test_the_same_seed_gives_the_same_run(name: str) -> None:
    assert np.array_equal(points(run(name).evaluated), points(plain(name).evaluated))


@by_chance
def test_another_seed_gives_another_run(name: str) -> None:
    one, other = (started(name, seed=s) for s in (1, 2))
    for method in (one, other):
        method.tell(plain(name).evaluated[:1])
    assert not np.array_equal(one.ask()[-1].point, other.ask()[-1].point)


@everyone
def test_predictions_are_of_the_rating_or_the_characteristics(name: str) -> None:
    predicted = [e.candidate.predicted for e in plain(name).evaluated if e.candidate.predicted]
    assert predicted
    for one in predicted:
        assert one.values.shape == one.sd.shape == (len(case().targets.characteristics),)
        assert np.isfinite(one.rating) or np.isfinite(one.values).all()


@everyone
@pytest.mark.parametrize("fails", [at_random(0.3), everywhere], ids=["30 percent", "all"])
def test_survives_failing_designs(name: str, fails: Fails) -> None:
    found = run(name, evaluate=solver(case(), fails=fails))
    assert found.stopped
    assert found.evaluated[found.best].rating is not None


@everyone
def test_survives_a_later_round_of_failures(name: str) -> None:
    asked = [0]
    answers = solver(case())

    def evaluate(designs: Sequence[Mapping[str, float]]) -> Sequence[Outcome]:
        asked[0] += 1
        return [failure("no licence") for _ in designs] if asked[0] == 4 else answers(designs)

    found = run(name, evaluate=evaluate)
    assert found.evaluated[found.best].merit > found.evaluated[0].merit


@by_chance
def test_a_batch_holds_different_designs(name: str) -> None:
    method = started(name, batch=3)
    method.tell(plain(name).evaluated[:1])
    opening = method.ask()
    method.tell(answered(opening))
    batch = method.ask()
    assert len(batch) >= 3
    assert len(np.unique(np.array([c.point for c in batch]), axis=0)) == len(batch)


def answered(candidates: Sequence[Candidate]) -> list[Evaluated]:
    outcomes = solver(case())([case().space.values(c.point) for c in candidates])
    pairs = zip(candidates, outcomes, strict=True)
    return [case().judged(i + 1, c, o) for i, (c, o) in enumerate(pairs)]


@everyone
def test_knows_designs_of_before(name: str) -> None:
    """An opening sample that is known already is not run again."""
    method = started(name)
    rng = np.random.default_rng(5)
    drawn = case().space.snapped(rng.uniform(0.3, 0.7, (16, case().space.dimension)))
    sample = [(e.candidate, e.outcome) for e in answered([Candidate(p, "sample") for p in drawn])]
    found = run_method(case(), method, solver(case()), budget=3, known=sample)
    assert all(e.candidate.origin != "opening sample" for e in found.evaluated)


@everyone
def test_is_on_the_page(name: str) -> None:
    page = (Path(__file__).parents[2] / "docs" / "methods.md").read_text(encoding="utf-8")
    assert page.count(f"\n| `{name}` |") == 2
    assert f"\n## {name}\n" in page
