"""The axle from three sides beside each other in one scale, for a page that has little room."""

from __future__ import annotations

from doe_kc.reports.axle.point_moves import AxleView
from doe_kc.reports.axle.views import AXIS_WORDS_OF, PLANES, View, draw_view, view_extent, view_handles
from doe_kc.reports.drawing import style
from doe_kc.reports.drawing.panel import PageBox
from doe_kc.reports.drawing.panel_axis import ticks
from doe_kc.reports.drawing.sheet import Sheet
from doe_kc.reports.drawing.words import POINTS

STRIP_VIEWS: tuple[View, ...] = ("side", "rear", "top")
STRIP_TITLES = {"side": "From the left", "rear": "From behind", "top": "From above"}
STRIP_LEFT, STRIP_BETWEEN, STRIP_HEAD, STRIP_FOOT = 38.0, 44.0, 18.0, 32.0
"""Points: left of the first view, between two, above and below them, where numbers and labels are."""
KEY_LEFT, KEY_BELOW, KEY_TALL, KEY_LINE = 34.0, 28.0, 94.0, 10.0
"""Points left of the last view, and below it, where the key begins; least height of the key, of a line."""


def strip_height(view: AxleView, width: float) -> float:
    """Points that a strip of this width takes."""
    low, high = view_extent(view.before)
    scale = _strip_scale(view, width)
    views = scale * float(high[2] - low[2]) + STRIP_FOOT
    key = max(KEY_TALL, KEY_LINE * len(view_handles(view)))
    return STRIP_HEAD + max(views, scale * float(high[1] - low[1]) + KEY_BELOW + key)


def strip_width(view: AxleView, height: float) -> float:
    """Points of width that a strip of this height takes."""
    low, high = view_extent(view.before)
    scale = (height - STRIP_HEAD - STRIP_FOOT) / float(high[2] - low[2])
    return scale * _across(view) + STRIP_LEFT + STRIP_BETWEEN * (len(STRIP_VIEWS) - 1)


def _strip_scale(view: AxleView, width: float) -> float:
    """Points of a mm."""
    return (width - STRIP_LEFT - STRIP_BETWEEN * (len(STRIP_VIEWS) - 1)) / _across(view)


def _across(view: AxleView) -> float:
    """mm of all views together."""
    low, high = view_extent(view.before)
    return float(sum((high - low)[PLANES[name][0]] for name in STRIP_VIEWS))


def draw_strip(page: Sheet, view: AxleView, left: float, bottom: float, width: float) -> None:
    """left, bottom, width: points of the page."""
    low, high = view_extent(view.before)
    scale = _strip_scale(view, width)
    top = bottom + strip_height(view, width) - STRIP_HEAD
    start, end = left + STRIP_LEFT, top
    for name in STRIP_VIEWS:
        across, up = PLANES[name]
        wide, tall = (scale * float(high[axis] - low[axis]) for axis in (across, up))
        panel = page.add_panel(PageBox(start, top - tall, wide, tall))
        panel.x.set_limits(low[across], high[across])
        panel.y.set_limits(low[up], high[up])
        panel.x.set_locator(ticks(4))
        panel.y.set_locator(ticks(5))
        panel.number_size = {"x": 6.0, "y": 6.0}
        panel.set_labels(AXIS_WORDS_OF[across], AXIS_WORDS_OF[up], size=6.5)
        panel.set_title(STRIP_TITLES[name], size=7.5)
        draw_view(panel, view, name)
        start, end = start + wide + STRIP_BETWEEN, top - tall
    place = (start - wide - STRIP_BETWEEN - KEY_LEFT, end - KEY_BELOW)
    page.add_legend(view_handles(view), columns=1, size=6.5, corner=("left", "top"), at=place)


def strip_figure(view: AxleView) -> Sheet:
    """The strip alone, as wide as an A4 page within its margins."""
    width = style.A4[0] * POINTS - 60.0
    page = Sheet((width / POINTS, strip_height(view, width) / POINTS))
    draw_strip(page, view, 0.0, 0.0, width - 4.0)
    return page
