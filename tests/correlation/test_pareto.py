"""The front of trade-offs: objectives by load case, dominance, knee, and the method on a conflict."""

from __future__ import annotations

import sys
from dataclasses import replace

import numpy as np
import pytest

from doe_kc.correlation.front import (
    VIOLATION,
    front_of,
    knee,
    non_dominated,
    objectives,
    relative_violation,
    weighted,
)
from doe_kc.correlation.loop import run_method
from doe_kc.correlation.methods._base import MethodSettings
from doe_kc.correlation.methods.pareto.infill import ModelledObjectives, spread_out
from doe_kc.correlation.methods.pareto.method import Pareto
from doe_kc.correlation.methods.pareto.nsga3 import nsga3, reference_directions
from doe_kc.correlation.modelled.archive import build_archive
from doe_kc.correlation.modelled.proposal import fit_outputs
from doe_kc.correlation.problem import Candidate, Evaluated
from doe_kc.ground.errors import InputError
from doe_kc.targets import Targets, rate
from tests.correlation.synthetic import Synthetic, answer, solver, synthetic


def judged(problem: Synthetic, count: int, width: float = 0.2) -> list[Evaluated]:
    """Designs about the truth, the truth first."""
    rng = np.random.default_rng(0)
    moves = width * rng.uniform(-1.0, 1.0, (count, problem.space.dimension))
    moves[0] = 0.0
    points = problem.space.snapped(problem.truth + moves)
    return [problem.judged(i, Candidate(p, "test"), answer(problem, p)) for i, p in enumerate(points)]


def conflict(problem: Synthetic) -> Targets:
    """One output with two targets, as if two load cases wanted it different; no constraints."""
    one = next(t for t in problem.targets.characteristics if t.entry.load_case == "brake" and t.objective)
    one = replace(one, constraint=None)
    other = replace(one, entry=replace(one.entry, load_case="vertical"), value=0.5 * one.value)
    return replace(problem.targets, characteristics=(one, other), curves=())


def test_objectives_add_up_to_the_rating_of_a_feasible_design() -> None:
    problem = synthetic(4)
    found = objectives(problem.targets)
    assert {"brake", "static", "vertical"} <= set(found.names)
    for design in judged(problem, 5):
        assert design.rating is not None
        total = found.values(design.rating).sum() - design.rating.constraints.sum()
        assert total == pytest.approx(-design.merit)
        assert (relative_violation(problem.targets, design.rating) == 0.0) == design.rating.feasible


def test_terms_of_one_load_case_are_traded_one_by_one() -> None:
    problem = synthetic(4, curves=False)
    brake = tuple(t for t in problem.targets.characteristics if t.entry.load_case == "brake")
    found = objectives(replace(problem.targets, characteristics=brake))
    assert found.names == tuple(t.entry.id for t in brake if t.objective)
    with pytest.raises(InputError, match=r"two objectives.*found 1"):
        objectives(replace(problem.targets, characteristics=brake[:1]))


def test_weighting_multiplies_an_objective_and_leaves_constraints() -> None:
    problem = synthetic(4)
    found = objectives(problem.targets)
    design = judged(problem, 2)[1]
    assert design.rating is not None and design.score is not None
    weight = np.arange(1.0, 1.0 + len(found.names))
    again = rate(weighted(problem.targets, found, weight), design.score)
    assert found.values(again) == pytest.approx(weight * found.values(design.rating))
    assert again.constraints == pytest.approx(design.rating.constraints)


def test_modelled_objectives_are_the_true_ones_where_the_surrogate_knows() -> None:
    problem = synthetic(4)
    designs = judged(problem, 25)
    archive = build_archive(problem.targets, designs)
    found = objectives(problem.targets)
    modelled = ModelledObjectives(problem.targets, found, archive, fit_outputs(archive, seed=0))
    values, violation = modelled.values(archive.points)
    true = np.array([found.values(e.rating) for e in archive.solved if e.rating])
    assert values == pytest.approx(true, abs=0.02)
    wanted = [relative_violation(problem.targets, e.rating) for e in archive.solved if e.rating]
    assert violation == pytest.approx(wanted, abs=0.02)


def test_non_dominated_keeps_what_no_row_beats_and_one_of_equals() -> None:
    rows = np.array([[1.0, 3.0], [2.0, 2.0], [2.0, 2.0], [2.0, 3.0], [3.0, 1.0]])
    assert list(non_dominated(rows)) == [0, 1, 4]


def test_the_knee_is_where_the_front_bends() -> None:
    rows = np.array([[0.0, 100.0], [0.1, 10.0], [1.0, 0.0]])
    assert knee(rows) == 1
    assert knee(np.zeros((0, 2))) == -1


def test_the_front_holds_the_best_rating_first_and_drops_unbearable_losses() -> None:
    problem = synthetic(4)
    designs = judged(problem, 40, 0.05)[1:]
    front = front_of(problem.targets, designs)
    best = max(designs, key=lambda e: (bool(e.rating and e.rating.feasible), e.merit))
    assert front.feasible
    assert front.indices[0] == best.index
    assert front.values.sum(axis=1).max() <= 3.0 * front.values.sum(axis=1).min()
    frame = front.to_frame()
    assert list(frame.columns) == [*front.names, "rating", "knee"]
    assert frame["knee"].sum() == 1


def test_without_a_feasible_design_the_violation_is_one_more_objective() -> None:
    problem = synthetic(4)
    designs = [e for e in judged(problem, 20, 0.5) if e.rating and not e.rating.feasible]
    front = front_of(problem.targets, designs)
    assert not front.feasible
    assert front.names[-1] == VIOLATION
    assert front.values[:, -1].min() > 0.0
    assert len(front_of(problem.targets, []).indices) == 0


def test_infill_is_spread_over_the_front() -> None:
    rows = np.column_stack([np.linspace(0.0, 1.0, 11), np.linspace(1.0, 0.0, 11)])
    assert list(spread_out(rows, rows[[0]], 2)) == [10, 5]


@pytest.mark.parametrize("count", [2, 3, 8])
def test_reference_directions_sum_to_one(count: int) -> None:
    found = reference_directions(count)
    assert found.shape[1] == count
    assert 40 <= len(found) <= 200
    assert found.sum(axis=1) == pytest.approx(1.0)


def test_nsga3_finds_a_known_front_whatever_the_global_state_of_chance() -> None:
    """f = x, 1 - x on the line y = 0 is the front of (x + y, 1 - x + y)."""

    def judge(x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        return np.column_stack([x[:, 0] + x[:, 1], 1.0 - x[:, 0] + x[:, 1]]), np.zeros(len(x))

    directions = reference_directions(2)[::10]
    first = np.random.default_rng(0).random((len(directions), 2))
    runs = []
    for state in (1, 2):
        np.random.seed(state)  # noqa: NPY002 - pymoo must not use it
        runs.append(nsga3(judge, first, directions, np.zeros(2), np.ones(2), generations=60, seed=3))
    assert np.array_equal(*runs)
    assert runs[0][:, 1].max() < 0.05
    assert np.ptp(runs[0][:, 0]) > 0.9


def test_finds_the_ends_of_a_conflict() -> None:
    """One output with two targets: the front runs from the one to the other, all of the same loss sum."""
    problem = synthetic(4)
    problem = replace(problem, targets=conflict(problem))
    method = Pareto(problem, MethodSettings(seed=1, budget=45, first=15))
    run_method(problem, method, solver(problem), budget=45)
    front = method.front
    assert front.names == ("brake", "vertical")
    assert front.feasible and len(front.indices) >= 5
    assert front.values.min(axis=0) == pytest.approx([0.0, 0.0], abs=0.05 * front.values.max())


def test_says_how_to_get_pymoo(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "pymoo", None)
    with pytest.raises(InputError, match=r"pip install .doe-kc\[pareto\]"):
        Pareto(synthetic(4), MethodSettings(seed=1, budget=10))
