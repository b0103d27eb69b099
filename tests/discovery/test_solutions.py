"""Solutions kept: those of the solver, and no load case is solved twice in a row."""

from __future__ import annotations

import pickle
from collections.abc import Sequence
from concurrent.futures import Executor
from dataclasses import replace

import numpy as np
import pytest

from doe_kc.axle.model import Axle
from doe_kc.discovery import solutions
from doe_kc.discovery.solutions import AXLE_CACHE, Solutions
from doe_kc.solver.lane_march import LANES
from doe_kc.solver.result import Solution
from doe_kc.solver.suite import branch_inputs, solve
from tests.discovery.cases import LOAD_CASES, nominal


@pytest.fixture
def solved(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """Ids of the load cases that were solved."""
    done: list[str] = []

    def counted(axle: Axle, cases: Sequence[str], *, lanes: bool, pool: Executor | None) -> Solution:
        done.extend(cases)
        return solve(axle, cases, lanes=lanes, pool=pool)

    monkeypatch.setattr(solutions, "solve", counted)
    return done


def stretched(axle: Axle, name: str, gain: float) -> Axle:
    case = replace(axle.load_cases[name], gain=gain)
    return replace(axle, load_cases={**axle.load_cases, name: case})


def same(one: Solution, other: Solution) -> bool:
    assert list(one.cases) == list(other.cases)
    pairs = [
        (b.y, c.y)
        for name in one.cases
        for b, c in zip(one.cases[name].branches, other.cases[name].branches, strict=True)
    ]
    assert one.static is not None and other.static is not None
    return np.array_equal(one.static.y, other.static.y) and all(np.array_equal(a, b) for a, b in pairs)


def test_a_solution_is_the_solver_s_and_is_not_computed_again(solved: list[str]) -> None:
    kept = Solutions()
    first, again = kept(nominal()), kept(nominal())
    assert sorted(solved) == sorted(LOAD_CASES)
    assert same(first, again)
    assert same(first, solve(nominal(), list(nominal().load_cases), lanes=True))


def test_load_cases_side_by_side_are_the_same_to_the_last_digit() -> None:
    assert same(Solutions(threads=3)(nominal()), Solutions()(nominal()))


def test_several_threads_share_the_load_cases(monkeypatch: pytest.MonkeyPatch) -> None:
    kept, shared = Solutions(threads=2), list[int]()
    assert Solutions().pool is None and kept.pool is not None
    whole = kept.pool.map
    monkeypatch.setattr(
        kept.pool, "map", lambda f, groups: shared.extend(map(len, groups)) or whole(f, groups)
    )
    kept(nominal())
    branches = sum(len(branch_inputs(c, loop=False)) for c in nominal().load_cases.values())
    assert sum(shared) == branches and max(shared) <= LANES


def test_another_process_has_one_thread_until_it_is_told_otherwise() -> None:
    sent = pickle.loads(pickle.dumps(Solutions(threads=2)))
    assert sent.pool is None
    sent.threads = 3
    assert sent.pool is not None and sent.pool is sent.pool
    sent.threads = 1
    assert sent.pool is None


def test_another_input_of_one_load_case_solves_that_alone(solved: list[str]) -> None:
    kept = Solutions()
    kept(nominal())
    solved.clear()
    other = stretched(nominal(), "steer", 1.1)
    found = kept(other)
    assert solved == ["steer"]
    assert same(found, solve(other, list(other.load_cases), lanes=True))
    assert same(kept(nominal()), solve(nominal(), list(nominal().load_cases), lanes=True))


def test_another_value_solves_everything(solved: list[str]) -> None:
    kept = Solutions()
    kept(nominal())
    other = nominal().changed({"tyre.static_load": nominal().values["tyre.static_load"] + 50.0})
    assert same(kept(other), solve(other, list(other.load_cases), lanes=True))
    assert sorted(solved) == sorted([*LOAD_CASES, *LOAD_CASES])


def test_old_solutions_are_given_up(solved: list[str]) -> None:
    kept, load = Solutions(), nominal().values["tyre.static_load"]
    for k in range(AXLE_CACHE + 1):
        kept(nominal().changed({"tyre.static_load": load + k}))
    solved.clear()
    kept(nominal())
    assert sorted(solved) == sorted(LOAD_CASES)


def test_another_process_begins_with_none(solved: list[str]) -> None:
    kept = Solutions()
    kept(nominal())
    other = pickle.loads(pickle.dumps(kept))
    solved.clear()
    other(nominal())
    assert sorted(solved) == sorted(LOAD_CASES)
