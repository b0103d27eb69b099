"""Panels map data to the page and write Matplotlib's numbers at their ticks."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from PIL import Image

from doe_kc.reports.drawing.panel import PageBox, Panel
from doe_kc.reports.drawing.panel_axis import STEPS, PanelAxis, ticks
from doe_kc.reports.drawing.sheet import sheet
from doe_kc.reports.drawing.style import save


def panel() -> Panel:
    return Panel(PageBox(100.0, 50.0, 200.0, 80.0), PanelAxis(), PanelAxis())


def test_data_are_mapped_linearly_with_a_margin_of_5_percent() -> None:
    one = panel()
    one.plot([0.0, 10.0], [-3.0, 3.0])
    assert one.x.limits == pytest.approx((-0.5, 10.5)) and one.y.limits == pytest.approx((-3.3, 3.3))
    assert one.place(5.0, 0.0) == pytest.approx((200.0, 90.0))
    one.y.set_limits(3.0, -3.0)
    assert one.place(-0.5, 3.0) == pytest.approx((100.0, 50.0))


def test_logarithmic_axes_map_decades_alike() -> None:
    one = panel()
    one.x.set_logarithmic()
    one.x.set_limits(0.1, 1000.0)
    one.y.set_symmetrical_logarithmic(10.0)
    one.y.set_limits(-1000.0, 1000.0)
    assert one.place(10.0, 0.0) == pytest.approx((200.0, 90.0))
    assert one.x.ticks(9).places.tolist() == [0.1, 1.0, 10.0, 100.0, 1000.0]
    assert one.x.ticks(9).minor.size == 4 * 8


@pytest.mark.parametrize(
    "limits", [(-0.2, 0.37), (3.0, -3.0), (1.23e6, 1.2301e6), (2e-7, 9e-7), (0.0, 8800.0)]
)
def test_numbers_are_those_of_matplotlib(limits: tuple[float, float]) -> None:
    axis = PanelAxis()
    axis.set_limits(*limits)
    axis.set_locator(ticks(5))
    found = axis.ticks(9)
    ax = Figure().subplots()
    ax.set_xlim(*limits)
    ax.xaxis.set_major_locator(MaxNLocator(5, steps=STEPS))
    low, high = sorted(limits)
    shown = [t for t in ax.get_xticklabels() if low <= t.get_position()[0] <= high]
    assert list(found.words) == [t.get_text() for t in shown] and len(shown) > 1
    assert found.remark == ax.xaxis.get_major_formatter().get_offset()
    assert (found.places >= low).all() and (found.places <= high).all()


def test_a_line_is_drawn_in_its_place_and_cut_at_the_edges(tmp_path: Path) -> None:
    page, panels = sheet(
        1, 1, size=(2.0, 2.0), margins={"left": 0.25, "right": 0.75, "bottom": 0.25, "top": 0.75}
    )
    panels[0, 0].plot([-5.0, 5.0], [0.0, 0.0], color="#FF0000", lw=3.0)
    panels[0, 0].x.set_limits(-1.0, 1.0)
    panels[0, 0].y.set_limits(1.0, -3.0)
    pixels = np.asarray(Image.open(save(page, tmp_path / "a")), dtype=int)
    red = (pixels[:, :, 0] > 200) & (pixels[:, :, 1] < 80) & (pixels[:, :, 2] < 80)
    rows, columns = np.nonzero(red)
    assert pixels.shape == (300, 300, 3)
    assert columns.min() >= 74 and columns.max() <= 225 and np.ptp(columns) >= 145
    assert rows.mean() == pytest.approx(300 - (75 + 150 * 0.25), abs=1.0)


def test_panels_that_share_their_axis_have_the_same_limits() -> None:
    _, panels = sheet(2, 1, margins={})
    panels[0, 0].plot([0.0, 1.0], [0.0, 1.0])
    panels[1, 0].plot([5.0, 10.0], [0.0, 9.0])
    assert panels[0, 0].x.limits == panels[1, 0].x.limits == pytest.approx((-0.5, 10.5))
    assert panels[0, 0].y.limits != panels[1, 0].y.limits
    assert not panels[0, 0].numbers["x"] and panels[1, 0].numbers["x"]


def test_one_bar_with_an_edge_reaches_the_pixels(tmp_path: Path) -> None:
    page, panels = sheet(1, 1, size=(2.0, 2.0), margins={})
    panels[0, 0].bars(0.0, 0.0, 1.0, 0.5, ["#0000FF"], edgecolors="#FF0000", linewidths=0.5)
    with Image.open(save(page, tmp_path / "bar")) as image:
        assert (np.asarray(image) == (0, 0, 255)).all(axis=2).any()
