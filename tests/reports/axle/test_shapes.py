"""Pictures of the deformed shape."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from doe_kc.axle_file import read_axle
from doe_kc.effects import apply_effect
from doe_kc.examples import example_folder
from doe_kc.reports.axle.shapes import (
    LISTED,
    LISTED_OF_TYPE,
    LOOKS,
    case_shapes,
    shape_figure,
    write_shape_figures,
)
from doe_kc.solver.suite import solve
from tests.reference import nominal


@pytest.mark.parametrize(("case", "factor"), [("vertical", 1), ("drive", 20)])
def test_moves_are_drawn_by_the_factor_that_is_said(case: str, factor: int) -> None:
    axle = nominal()
    shapes = case_shapes(axle, solve(axle, [case], compiled=False).cases[case])
    assert shapes.inputs == (-shapes.inputs[1], shapes.inputs[1]) and shapes.inputs[1] > 0
    assert shapes.factor == factor
    page = shape_figure(shapes, "S $x_1$")
    assert page.outside == [] and page.heading.endswith("S $x_1$")
    words = [w.text for w in page.words]
    assert any(("as they are" if factor == 1 else f"{factor} times as long") in w for w in words)
    assert set(LISTED) <= set(words)
    side = page.panels[1]
    assert len(side.lines) == len(LOOKS)
    wheels = [np.asarray(line.get_ydata(), dtype=float) for line in side.lines]
    static, _, high = shapes.states
    moved = high.points["WLC@L"][2] - static.points["WLC@L"][2]
    middles = [(w.max() + w.min()) / 2 for w in wheels]
    assert middles[2] - middles[0] == pytest.approx(factor * moved, abs=1e-6)


def test_with_friction_the_last_loop_is_drawn(tmp_path: Path) -> None:
    axle = apply_effect(nominal(), "steering_friction", {"force_N": 200.0}, source="test")
    solution = solve(axle, ["steer"], compiled=False)
    shapes = case_shapes(axle, solution.cases["steer"])
    assert shapes.inputs[0] < 0 < shapes.inputs[1]
    (path,) = write_shape_figures(axle, solution, tmp_path / "new")
    assert path.name == "shape_steer.png" and path.stat().st_size > 5000


def test_points_that_are_not_listed_are_counted() -> None:
    axle = read_axle(example_folder("five_link_rear") / "axle.toml")
    shapes = case_shapes(axle, solve(axle, ["drive"], compiled=False).cases["drive"])
    points = {name[:-2] for name in shapes.states[0].points if name.endswith("@L")}
    page = shape_figure(shapes, "S")
    words = [w.text for w in page.words]
    assert sum(w in points for w in words) == LISTED_OF_TYPE
    assert f"and {len(points) - LISTED_OF_TYPE} more" in words
    assert page.outside == []
