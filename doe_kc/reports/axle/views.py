"""The axle drawn from three sides: hardpoints, members and wheel, with an arrow for each move."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from typing import Any, Literal

import numpy as np
from matplotlib.lines import Line2D
from matplotlib.patches import Circle, FancyArrowPatch

from doe_kc.axle.geometry import point
from doe_kc.axle.members import drawn_points, members_of
from doe_kc.axle.model import Axle
from doe_kc.ground.numbers import signed
from doe_kc.ground.typing import FloatArray
from doe_kc.reports.axle.point_moves import SHOWN_MOVE, AxleView
from doe_kc.reports.drawing import style
from doe_kc.reports.drawing.panel import PageBox, Panel
from doe_kc.reports.drawing.panel_axis import ticks
from doe_kc.reports.drawing.sheet import Sheet
from doe_kc.reports.drawing.words import POINTS

ACROSS = ("SFF", "SFR", "RIB")
"""Points of a McPherson axle from which sub-frame and rack reach over to the other side."""
MEMBER_COLOURS: Mapping[str, str] = {
    "lower arm": style.PALETTE["blue"],
    "strut": style.PALETTE["black"],
    "spring": style.PALETTE["green"],
    "tie rod": style.PALETTE["vermillion"],
    "knuckle": style.PALETTE["purple"],
    "sub-frame": style.PALETTE["grey"],
    "damper": style.PALETTE["black"],
    "upper arm": style.PALETTE["sky"],
    "arm": style.PALETTE["blue"],
    "axle": style.PALETTE["purple"],
}
"""Of parts that most axles have; others follow in the order of `OTHER_COLOURS`."""
BROWN = "#8C5A2B"
"""Arrows are orange."""
DARK_YELLOW = "#A68A00"
"""The palette's own yellow is not seen as a thin line on white."""
OTHER_COLOURS = (
    *(style.PALETTE[name] for name in ("blue", "vermillion", "sky")),
    BROWN,
    DARK_YELLOW,
)
TRIM = "#C9CED3"
BORDER = 60.0
"""mm of free space about the axle in each view, and of what reaches over to the other side."""
LEFT_EDGE, RIGHT_EDGE, BETWEEN_ACROSS = 56.0, 18.0, 50.0
HEAD_ROOM, BETWEEN_UP, KEY_ROOM = 66.0, 62.0, 96.0
"""Points about the views: numbers, labels, titles and the key."""
TABLE_LINE, TABLE_PLACES = 13.0, (0.0, 34.0, 87.0, 140.0)
"""Points."""
NAME_PLACES = (
    (3.0, 3.0), (3.0, -8.0), (-3.0, 3.0), (-3.0, -8.0),
    *((side * across, up) for across, up in ((9.0, 8.0), (9.0, -13.0), (13.0, 0.0), (4.0, 15.0), (4.0, -20.0),
      (16.0, 14.0), (16.0, -19.0), (24.0, 2.0), (24.0, -8.0), (24.0, 22.0), (24.0, -27.0))
      for side in (1.0, -1.0)),
)  # fmt: skip
"""Points from a hardpoint to its name, tried in turn."""
NEAR_NAMES = 4
"""Of these places, from which on a line leads to the name."""
POINT_REACH = 2.0
"""Points about a hardpoint that no name covers."""
NAME_SIZE = 5.5
"""Points of a hardpoint's name."""
AXIS_WORDS_OF = ("X (rearwards +) [mm]", "Y (right +) [mm]", "Z (up +) [mm]")

Box = tuple[float, float, float, float]
"""Left, low, right and high edge, points of the page."""
View = Literal["side", "top", "rear"]
PLANES: Mapping[View, tuple[int, int]] = {"side": (0, 2), "top": (0, 1), "rear": (1, 2)}
"""Axes across and up: seen from the left, from above, and from behind."""


def axle_figure(view: AxleView) -> Sheet:
    """Side, top and rear view of the left side in one scale, and a table of the moves.

    The right side is the mirror image, but for what the axle file says of it alone.
    """
    low, high = view_extent(view.before)
    span = high - low
    width = style.A4[0] * POINTS
    scale = (width - LEFT_EDGE - BETWEEN_ACROSS - RIGHT_EDGE) / (span[0] + span[1])
    height = HEAD_ROOM + scale * (span[2] + span[1]) + BETWEEN_UP + KEY_ROOM
    page = Sheet((style.A4[0], height / POINTS))
    middle, top = LEFT_EDGE + scale * span[0] + BETWEEN_ACROSS, height - HEAD_ROOM
    for name, (across, up) in PLANES.items():
        box = PageBox(
            LEFT_EDGE if across == 0 else middle,
            top - scale * span[2] if up == 2 else KEY_ROOM,
            scale * span[across],
            scale * span[up],
        )
        panel = page.add_panel(box)
        panel.x.set_limits(low[across], high[across])
        panel.y.set_limits(low[up], high[up])
        panel.x.set_locator(ticks(5))
        panel.y.set_locator(ticks(6))
        panel.set_labels(AXIS_WORDS_OF[across], AXIS_WORDS_OF[up])
        panel.set_title({"side": "From the left", "top": "From above", "rear": "From behind"}[name])
        draw_view(panel, view, name)
    if view.after is not None:
        _table(page, view, middle, KEY_ROOM + scale * span[1])
    page.add_legend(view_handles(view), columns=3, size=7.5)
    page.set_heading(view.title, 1.0 - 18.0 / height)
    return page


def view_extent(axle: Axle) -> tuple[FloatArray, FloatArray]:
    """(3,) lowest and highest place of what is drawn, mm."""
    points = np.array([point(axle, name) for name in drawn_points(axle)])
    wheel, radius = point(axle, "WLC"), float(point(axle, "WLC")[2])
    low = np.minimum(points.min(axis=0), [wheel[0] - radius, wheel[1], 0.0]) - BORDER
    high = np.maximum(points.max(axis=0), [wheel[0] + radius, wheel[1], wheel[2] + radius]) + BORDER
    low[2] = -BORDER / 2.0
    return low, high


def draw_view(panel: Panel, view: AxleView, name: View) -> None:
    across, up = PLANES[name]
    axle = view.before
    if up == 2:
        panel.hline(0.0, color=TRIM, lw=1.2, zorder=0)
    members = members_of(axle)
    colours = member_colours(members)
    for member, lines in members.items():
        ends = np.array([[point(axle, a), point(axle, b)] for a, b in lines])
        panel.segments(
            ends[:, 0, across], ends[:, 0, up], ends[:, 1, across], ends[:, 1, up],
            colors=colours[member], zorder=2, linewidths=1.2,
        )  # fmt: skip
    across_from = [a for a in ACROSS if a in drawn_points(axle)]
    if name != "side" and across_from:
        start = np.array([point(axle, a) for a in across_from])
        end = start + np.array([0.0, BORDER, 0.0])
        panel.segments(
            start[:, across], start[:, up], end[:, across], end[:, up],
            colors=TRIM, zorder=1, linewidths=1.2, linestyles=":",
        )  # fmt: skip
    _wheel(panel, point(axle, "WLC"), name)
    _moves(panel, view, across, up)
    _names(panel, view, across, up)


def _wheel(panel: Panel, centre: FloatArray, name: View) -> None:
    radius = float(centre[2])
    line: dict[str, Any] = {"color": "#555555", "lw": 1.0, "zorder": 1}
    if name == "side":
        panel.add(Circle((centre[0], centre[2]), radius, fill=False, **line))
    elif name == "top":
        panel.plot([centre[0] - radius, centre[0] + radius], [centre[1], centre[1]], **line)
    else:
        panel.plot([centre[1], centre[1]], [centre[2] - radius, centre[2] + radius], **line)


def _moves(panel: Panel, view: AxleView, across: int, up: int) -> None:
    factor, colour = view.factor, style.PALETTE["orange"]
    for m in view.moves:
        x, y = float(m.place[across]), float(m.place[up])
        panel.plot(x, y, "", marker="o", color="black", mfc="white", ms=2.8, mew=0.7, zorder=6)
        if m.distance < SHOWN_MOVE:
            continue
        end_x, end_y = x + factor * float(m.move[across]), y + factor * float(m.move[up])
        arrow = FancyArrowPatch(
            (x, y), (end_x, end_y), arrowstyle="-|>", mutation_scale=5.0, lw=1.2, zorder=5,
            shrinkA=0.0, shrinkB=0.0, color=colour,
        )  # fmt: skip
        panel.add(arrow, clip=False)
        half = np.nan_to_num(factor * m.sd)
        panel.plot(
            [end_x - half[across], end_x + half[across]], [end_y, end_y], color=colour, lw=0.6, zorder=4
        )
        panel.plot([end_x, end_x], [end_y - half[up], end_y + half[up]], color=colour, lw=0.6, zorder=4)


def _names(panel: Panel, view: AxleView, across: int, up: int) -> None:
    """Each beside its point; further off with a line to it."""
    places = [(float(m.place[across]), float(m.place[up])) for m in view.moves]
    names = [m.name for m in view.moves]
    boxes = name_boxes([panel.place(x, y) for x, y in places], names)
    unit = np.subtract(panel.place(1.0, 1.0), panel.place(0.0, 0.0))
    for name, (x, y), (box, far) in zip(names, places, boxes, strict=True):
        at = panel.place(x, y)
        panel.text(x, y, name, shift=(box[0] - at[0], box[1] - at[1]), size=NAME_SIZE, color="#333333")
        if far:
            edge = box[0] if box[0] > at[0] else box[2]
            end = np.array([edge - at[0], (box[1] + box[3]) / 2.0 - at[1]]) / unit
            panel.plot([x, x + end[0]], [y, y + end[1]], color="#9AA1A8", lw=0.4, zorder=3)


def name_boxes(points: list[tuple[float, float]], names: list[str]) -> list[tuple[Box, bool]]:
    """Where each point's name lies, and whether that is away from it: the place that covers least of other
    names and points. points: on the page."""
    taken = [(x - POINT_REACH, y - POINT_REACH, x + POINT_REACH, y + POINT_REACH) for x, y in points]
    out = []
    for (x, y), name in zip(points, names, strict=True):
        wide, high = 0.68 * NAME_SIZE * len(name), 1.1 * NAME_SIZE
        corners = [(x + (dx if dx > 0 else dx - wide), y + dy) for dx, dy in NAME_PLACES]
        boxes = [(left, low, left + wide, low + high) for left, low in corners]
        best = int(np.argmin([sum(_common_area(box, other) for other in taken) for box in boxes]))
        taken.append(boxes[best])
        out.append((boxes[best], best >= NEAR_NAMES))
    return out


def _common_area(a: Box, b: Box) -> float:
    across, up = min(a[2], b[2]) - max(a[0], b[0]), min(a[3], b[3]) - max(a[1], b[1])
    return max(0.0, across) * max(0.0, up)


def _table(page: Sheet, view: AxleView, x: float, y: float) -> None:
    """x, y: points of its upper left corner."""
    rows: list[tuple[str, ...]] = [("Δ ± sd", "ΔX [mm]", "ΔY [mm]", "ΔZ [mm]")]
    shown = sorted((m for m in view.moves if m.distance >= SHOWN_MOVE), key=lambda m: -m.distance)
    for m in shown:
        moves = (signed(float(move), float(sd)) for move, sd in zip(m.move, m.sd, strict=True))
        rows.append((m.name, *moves))
    if not shown:
        rows = [(f"No point moved by {SHOWN_MOVE:g} mm or more.",)]
    for k, row in enumerate(rows):
        height = (y - k * TABLE_LINE) / page.height
        look: dict[str, Any] = {"size": 7.0, "weight": "bold"} if k == 0 and shown else {"size": 6.3}
        for place, words in zip(TABLE_PLACES, row, strict=False):
            page.write((x + place) / page.width, height, words, along="top", **look)


def member_colours(members: Collection[str]) -> dict[str, str]:
    """A colour for each part."""
    others = iter(OTHER_COLOURS * (1 + len(members) // len(OTHER_COLOURS)))
    return {name: MEMBER_COLOURS.get(name) or next(others) for name in members}


def view_handles(view: AxleView) -> list[Line2D]:
    out = [
        Line2D([], [], color=c, lw=1.5, label=name)
        for name, c in member_colours(members_of(view.before)).items()
    ]
    out.append(Line2D([], [], color="#555555", lw=1.2, label="wheel (plane and rolling radius)"))
    if view.after is not None:
        colour = style.PALETTE["orange"]
        out.append(Line2D([], [], color=colour, lw=1.5, label=f"move, {view.factor} times as long as it is"))
        out.append(Line2D([], [], color=colour, lw=0.6, label="± standard deviation, in the same scale"))
    return out
