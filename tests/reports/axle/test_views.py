"""The axle drawn: one scale in all views, moves where they belong, nothing cut off."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from matplotlib.patches import FancyArrowPatch

from doe_kc.axle import with_values
from doe_kc.axle_file import read_axle
from doe_kc.reports.axle.point_moves import LONGEST_ARROW, AxleView
from doe_kc.reports.axle.views import PLANES, axle_figure, name_boxes
from doe_kc.reports.drawing import style

EXAMPLE = Path(__file__).parents[3] / "examples" / "front_axle" / "axle.toml"
SD = {f"LWB.{axis}": 0.3 for axis in "xyz"}


@pytest.fixture(scope="module")
def moved() -> AxleView:
    axle = read_axle(EXAMPLE)
    return AxleView("Car", axle, with_values(axle, {"LWB.x": axle.values["LWB.x@L"] + 2.0}), SD)


def test_every_view_has_the_same_scale(moved: AxleView) -> None:
    page = axle_figure(moved)
    assert len(page.panels) == len(PLANES)
    scales = [
        length / (end - start)
        for panel in page.panels
        for length, (start, end) in (
            (panel.box.width, panel.x.limits),
            (panel.box.height, panel.y.limits),
        )
    ]
    assert scales == pytest.approx([scales[0]] * 6)


def test_the_arrow_is_the_move_times_the_factor(moved: AxleView) -> None:
    only = next(m for m in moved.moves if m.distance > 0.0)
    assert only.name == "LWB" and only.move == pytest.approx([2.0, 0.0, 0.0])
    assert moved.factor == 50 and moved.factor * only.distance <= LONGEST_ARROW
    page = axle_figure(moved)
    side = page.panels[0]
    (arrow,) = [a for a in side.areas if isinstance(a, FancyArrowPatch)]
    start, end = arrow._posA_posB
    assert np.subtract(end, start) == pytest.approx([100.0, 0.0])


def test_a_move_across_the_view_has_no_length_in_it(moved: AxleView) -> None:
    rear = axle_figure(moved).panels[2]
    (arrow,) = [a for a in rear.areas if isinstance(a, FancyArrowPatch)]
    start, end = arrow._posA_posB
    assert np.subtract(end, start) == pytest.approx([0.0, 0.0])


def test_moves_stand_in_the_table_with_their_standard_deviations(moved: AxleView) -> None:
    words = [w.text for w in axle_figure(moved).words]
    assert "+2.00 ± 0.30" in words
    assert "move, 50 times as long as it is" in words


def test_an_axle_alone_has_neither_arrows_nor_table() -> None:
    page = axle_figure(AxleView("Car", read_axle(EXAMPLE)))
    assert not [a for panel in page.panels for a in panel.areas if isinstance(a, FancyArrowPatch)]
    assert not [w for w in page.words if "move" in w.text]


@pytest.mark.parametrize("form", ["png", "svg"])
def test_nothing_reaches_beyond_the_page(moved: AxleView, tmp_path: Path, form: style.PictureFormat) -> None:
    page = axle_figure(moved)
    assert page.outside == []
    assert style.save(page, tmp_path / "axle", form).stat().st_size > 10_000


def test_names_of_points_close_together_cover_neither_each_other_nor_a_point() -> None:
    points = [(100.0, 100.0), (101.0, 102.0), (99.0, 104.0), (104.0, 99.0), (102.0, 103.0), (98.0, 98.0),
              (300.0, 100.0)]  # fmt: skip
    named = name_boxes(points, ["LFO", "TLO", "SLO", "LWS", "DLO", "ARB", "UPS"])
    boxes = [box for box, _ in named]
    for i, a in enumerate(boxes):
        assert not any(a[0] < b[2] and b[0] < a[2] and a[1] < b[3] and b[1] < a[3] for b in boxes[:i])
        assert not any(a[0] < x < a[2] and a[1] < y < a[3] for x, y in points)
    assert [far for _, far in named].count(True) >= 1
    assert not named[-1][1], "a point alone has its name beside it"
