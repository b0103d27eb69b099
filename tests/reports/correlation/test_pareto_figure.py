"""The picture of a front."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from doe_kc.correlation.front import VIOLATION, Front
from doe_kc.ground.errors import InputError
from doe_kc.reports.correlation.pareto_figure import most_in_conflict, pareto_figure, write_pareto_figure


def front(designs: int = 12, *, feasible: bool = True) -> Front:
    """brake against vertical in conflict, static the same everywhere."""
    share = np.linspace(0.0, 1.0, designs)
    values = np.column_stack([0.1 + share, np.full(designs, 0.2), 1.1 - share])
    names = ("brake", "static", "vertical" if feasible else VIOLATION)
    return Front(
        names, np.arange(designs) + 7, values, -values.sum(axis=1), feasible, designs // 2 if designs else -1
    )


def test_finds_the_pair_in_conflict() -> None:
    i, j, rho = most_in_conflict(front().values)
    assert (i, j) == (0, 2)
    assert rho == pytest.approx(-1.0)


def test_an_objective_that_hardly_differs_is_in_no_conflict() -> None:
    values = front().values
    values[:, 1] += 1e-6 * values[:, 2]
    assert most_in_conflict(values)[:2] == (0, 2)


def test_draws_every_design_and_names_best_and_knee() -> None:
    fig = pareto_figure(front(), study="test")
    left, right = fig.panels
    assert left.x.ticks(9).words == ("Brake force", "Static", "Vertical motion")
    words = fig.keys[0].labels
    assert words[0].endswith("evaluation 8") and words[1].endswith("evaluation 14")
    assert len(left.lines) == 11 + 2
    assert "Brake force" in right.x_label.text and "Vertical motion" in right.y_label.text
    assert fig.outside == []


def test_says_when_nothing_is_feasible() -> None:
    fig = pareto_figure(front(feasible=False), study="test")
    assert "none of which is feasible" in fig.heading


@pytest.mark.parametrize("designs", [1, 2])
def test_draws_a_front_of_few(designs: int, tmp_path: Path) -> None:
    paths = write_pareto_figure(front(designs), tmp_path, study="test")
    assert [p.name for p in paths] == ["pareto_front.png"]
    assert all(p.stat().st_size > 1000 for p in paths)


def test_refuses_an_empty_front() -> None:
    with pytest.raises(InputError, match="front is empty"):
        pareto_figure(front(0), study="test")
