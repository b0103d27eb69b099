"""Load cases side by side: each as it is alone, whatever is beside it and whoever computes it."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from doe_kc.axle import Axle
from doe_kc.load_cases.vertical import Vertical
from doe_kc.solver import batch_library, lane_march, suite
from doe_kc.solver.compiled import MarchLibrary
from doe_kc.solver.elimination import EliminationOrder
from doe_kc.solver.equilibria import March, MarchProblem
from doe_kc.solver.kernel import Kernel
from doe_kc.solver.library import find_compiler
from doe_kc.solver.march import march_of
from doe_kc.solver.result import Solution
from doe_kc.solver.suite import solve
from tests.reference import nominal
from tests.solver.test_batch_suite import EFFECTS_OF

pytestmark = pytest.mark.skipif(find_compiler() is None, reason="no C compiler here")
FRICTIONAL = EFFECTS_OF["mcpherson_front", True]
CLOSE = 1e-7


@pytest.fixture
def alone(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """A number for every march that was done alone after all."""
    done: list[int] = []

    def counted(k: Kernel, library: MarchLibrary | None, problem: MarchProblem) -> March:
        done.append(len(problem.s))
        return march_of(k, library, problem)

    monkeypatch.setattr(suite, "march_of", counted)
    return done


def assert_close(found: Solution, expected: Solution) -> None:
    """To rounding, every state, output and friction state, and what lies inside steps."""
    assert list(found.cases) == list(expected.cases)
    for name, case in found.cases.items():
        for one, other in zip(case.branches, expected.cases[name].branches, strict=True):
            assert (one.name, len(one.y)) == (other.name, len(other.y))
            for a, b in ((one.x, other.x), (one.y, other.y), (one.z, other.z)):
                np.testing.assert_allclose(a, b, rtol=CLOSE, atol=CLOSE * max(1.0, np.abs(b).max(initial=0)))
            if other.path.between is None:
                assert one.path.between is None
                continue
            assert one.path.between is not None
            np.testing.assert_array_equal(one.path.between.step, other.path.between.step)
            np.testing.assert_array_equal(one.path.between.share, other.path.between.share)
            np.testing.assert_allclose(one.path.between.z, other.path.between.z, rtol=CLOSE, atol=CLOSE)


def assert_same(found: Solution, expected: Solution) -> None:
    """To the last digit, of the load cases that both have."""
    for name, case in found.cases.items():
        for one, other in zip(case.branches, expected.cases[name].branches, strict=True):
            np.testing.assert_array_equal(one.y, other.y)
            np.testing.assert_array_equal(one.z, other.z)


@pytest.mark.parametrize("kind", list(EFFECTS_OF))
def test_they_are_what_each_is_alone(kind: tuple[str, bool], alone: list[int]) -> None:
    axle = EFFECTS_OF[kind]
    beside = solve(axle, lanes=True)
    assert not alone
    assert_close(beside, solve(axle))
    assert alone


def test_nothing_hangs_on_what_is_beside() -> None:
    whole = solve(FRICTIONAL, lanes=True)
    for cases in (["roll"], ["steer", "lateral", "vertical"]):
        assert_same(solve(FRICTIONAL, cases, lanes=True), whole)
    with ThreadPoolExecutor(2) as pool:
        assert_same(solve(FRICTIONAL, lanes=True, pool=pool), whole)


def test_a_lane_that_is_free_takes_up_the_next_load_case(monkeypatch: pytest.MonkeyPatch) -> None:
    """So that all take fewer rounds than the longest four and then the others, none of whom begins sooner."""
    whole, rounds = batch_library._march_by, 0

    def counted(*arguments: Any) -> batch_library.BatchMarch:
        nonlocal rounds
        march = whole(*arguments)
        rounds += int(march.counts[0])
        return march

    monkeypatch.setattr(batch_library, "_march_by", counted)
    longest_first = sorted(FRICTIONAL.load_cases, key=lambda name: -FRICTIONAL.load_cases[name].steps)
    solve(FRICTIONAL, lanes=True)
    together, rounds = rounds, 0
    for cases in (longest_first[: lane_march.LANES], longest_first[lane_march.LANES :]):
        solve(FRICTIONAL, cases, lanes=True)
    assert together < 0.9 * rounds


def test_held_wheel_centres_go_beside_held_pads(alone: list[int]) -> None:
    axle = nominal()
    held = replace(axle, load_cases={**axle.load_cases, "vertical": Vertical(60.0, 16, control="wheel")})
    beside = solve(held, lanes=True)
    assert not alone
    assert_close(beside, solve(held))


def test_more_equilibria_inside_steps_than_there_was_room_for(monkeypatch: pytest.MonkeyPatch) -> None:
    expected = solve(FRICTIONAL, ["vertical", "steer"], lanes=True)
    monkeypatch.setattr(batch_library, "SUBSTEPS", 1)
    found = solve(FRICTIONAL, ["vertical", "steer"], lanes=True)
    assert_same(found, expected)
    for name, case in found.cases.items():
        for one, other in zip(case.branches, expected.cases[name].branches, strict=True):
            assert one.path.between is not None and other.path.between is not None
            np.testing.assert_array_equal(one.path.between.x, other.path.between.x)
    assert any(len(b.path.between.x) > len(b.path.x) for b in case.branches if b.path.between is not None)


def refused(axle: Axle, monkeypatch: pytest.MonkeyPatch) -> Solution:
    def singular(*_: object) -> EliminationOrder:
        raise np.linalg.LinAlgError("singular")

    monkeypatch.setattr(lane_march, "paired_order", singular)
    return solve(axle, lanes=True)


def test_what_has_no_order_of_elimination_is_solved_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    assert_same(refused(FRICTIONAL, monkeypatch), solve(FRICTIONAL))


def test_counts_are_of_each_load_case_alone() -> None:
    beside, alone = solve(FRICTIONAL, lanes=True), solve(FRICTIONAL)
    np.testing.assert_allclose(beside.counts, alone.counts, rtol=0.05)
