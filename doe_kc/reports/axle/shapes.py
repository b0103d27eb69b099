"""The axle in its deformed shape along a load case: at static and at both ends of the input."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.lines import Line2D

from doe_kc.axle.geometry import point
from doe_kc.axle.members import Member, members_of
from doe_kc.axle.model import Axle
from doe_kc.curves import SIDES
from doe_kc.ground.picture_format import PNG, PictureFormat
from doe_kc.ground.typing import FloatArray
from doe_kc.load_cases import case_label
from doe_kc.reports.axle.point_moves import ARROW_FACTORS, LONGEST_ARROW
from doe_kc.reports.drawing import style
from doe_kc.reports.drawing.panel import Dash, PageBox, Panel
from doe_kc.reports.drawing.panel_axis import ticks
from doe_kc.reports.drawing.series import draw_series
from doe_kc.reports.drawing.sheet import Sheet
from doe_kc.solver.result import CaseSolution, Solution
from doe_kc.solver.shape import Shape, shape_at

RIM = np.linspace(0.0, 2.0 * np.pi, 49)
"""Angles of the points by which a wheel is drawn."""
SHAPE_BORDER = 40.0
"""mm of free space about what is drawn."""
SHAPE_LEFT, SHAPE_BETWEEN, SHAPE_RIGHT, SHAPE_TOP, SHAPE_GAP, SHAPE_FOOT = 50.0, 54.0, 14.0, 60.0, 56.0, 40.0
"""Points: left of the views, between them across, right, above, between them up, and below."""
LOOKS: tuple[tuple[str, float, Dash], ...] = (
    ("#8A9199", 0.9, "-"),
    (style.PALETTE["vermillion"], 1.1, (0, (4, 2))),
    (style.PALETTE["blue"], 1.1, "-"),
)
"""Colour, width and dash of static, lowest and highest input."""
LISTED = ("WLC", "LWB", "ROB", "RIB", "LLF", "LLR", "UPB")
"""Hardpoints of a McPherson axle whose moves are listed, left side."""
LISTED_OF_TYPE = 12
"""So many of another type at most, the first of its file."""
LEGEND_AFTER = 10
"""Lines of the list that the legend leaves room for at least."""
LIST_LINE, LIST_PLACES = 10.5, (0.0, 62.0, 92.0, 122.0, 164.0, 194.0, 224.0)
"""Points."""


@dataclass(frozen=True)
class CaseShapes:
    """states: at static, lowest and highest input; inputs: of the last two, in `unit`. radius: of the rolling
    wheel, mm. members: lines between hardpoints."""

    load_case: str
    unit: str
    inputs: tuple[float, float]
    states: tuple[Shape, Shape, Shape]
    radius: float
    members: Mapping[str, tuple[Member, ...]]

    @property
    def factor(self) -> int:
        """By which moves are drawn longer than they are."""
        static, *ends = self.states
        longest = max(
            float(np.linalg.norm(end.points[name] - static.points[name]))
            for end in ends
            for name in end.points
        )
        fitting = [f for f in ARROW_FACTORS if f * longest <= LONGEST_ARROW]
        return fitting[-1] if fitting else 1


def case_shapes(axle: Axle, case: CaseSolution) -> CaseShapes:
    """Of a load case that was solved for the axle; with friction the ends of its last loop."""
    branches = {b.name: b for b in case.branches}
    low, high = ("unload", "load") if "load" in branches else ("neg", "pos")
    ends = [branches[name] for name in (low, high)]
    lowest, highest = (shape_at(axle, b, -1) for b in ends)
    states = (shape_at(axle, case.branches[0], 0), lowest, highest)
    inputs = (float(ends[0].input[-1]), float(ends[1].input[-1]))
    radius = float(point(axle, "WLC")[2])
    return CaseShapes(case.load_case.id, case.load_case.unit, inputs, states, radius, members_of(axle))


def shape_figure(shapes: CaseShapes, axle_name: str) -> Sheet:
    """From behind, from the left and from above, in one scale; moves longer by the factor that is said."""
    drawn = [_drawn(shapes, state) for state in shapes.states]
    everything = np.concatenate([np.concatenate(list(lines.values())) for lines in drawn])
    low, high = everything.min(axis=0) - SHAPE_BORDER, everything.max(axis=0) + SHAPE_BORDER
    span = high - low
    page = Sheet(style.A4_LANDSCAPE)
    scale = min(
        (page.width - SHAPE_LEFT - SHAPE_BETWEEN - SHAPE_RIGHT) / (span[1] + span[0]),
        (page.height - SHAPE_TOP - SHAPE_GAP - SHAPE_FOOT) / (span[2] + span[0]),
    )
    top, second = page.height - SHAPE_TOP, SHAPE_LEFT + scale * span[1] + SHAPE_BETWEEN
    middle = top - scale * span[2]
    views = (
        ("From behind", 1, 2, SHAPE_LEFT, middle),
        ("From the left", 0, 2, second, middle),
        ("From above, front up", 1, 0, SHAPE_LEFT, middle - SHAPE_GAP - scale * span[0]),
    )
    names = ("X (rearwards +) [mm]", "Y (right +) [mm]", "Z (up +) [mm]")
    for title, across, up, left, bottom in views:
        panel = page.add_panel(PageBox(left, bottom, scale * span[across], scale * span[up]))
        panel.x.set_limits(low[across], high[across])
        panel.y.set_limits(*((high[0], low[0]) if up == 0 else (low[up], high[up])))
        panel.x.set_locator(ticks(8 if across == 1 else 5))
        panel.y.set_locator(ticks(6))
        panel.set_labels(names[across], names[up], 7.0)
        panel.set_title(title, size=8.5)
        _draw(panel, drawn, across, up, sides=SIDES if across == 1 else SIDES[:1])
    lines = _list(page, shapes, second - 30.0, middle - SHAPE_GAP + 6.0)
    below = middle - SHAPE_GAP - LIST_LINE * max(lines, LEGEND_AFTER)
    page.add_legend(_handles(shapes), 1, 7.5, ("left", "top"), (second - 36.0, below))
    page.set_heading(f"{case_label(shapes.load_case)}, deformed shape: {axle_name}", 1 - 10.0 / page.height)
    said = "as they are" if shapes.factor == 1 else f"{shapes.factor} times as long as they are"
    page.write(
        0.5,
        1 - 27.0 / page.height,
        f"moves from static are drawn {said}",
        7.5,
        "center",
        "top",
        color="#555555",
    )
    return page


def _drawn(shapes: CaseShapes, state: Shape) -> dict[str, FloatArray]:
    """Lines of one state by `<member>@<side>`, (n, 3) mm each, moves exaggerated about static."""
    static, factor = shapes.states[0], shapes.factor
    now = {k: static.points[k] + factor * (p - static.points[k]) for k, p in state.points.items()}
    out = {}
    for side in SIDES:
        for member, lines in shapes.members.items():
            ends = [now[f"{name}@{side}"] for line in lines for name in line]
            out[f"{member}@{side}"] = np.array(ends)
        axis = static.spin[side] + factor * (state.spin[side] - static.spin[side])
        out[f"wheel@{side}"] = _rim(now[f"WLC@{side}"], axis, shapes.radius)
    return out


def _rim(centre: FloatArray, axis: FloatArray, radius: float) -> FloatArray:
    """(n, 3) points of the wheel's outline in its plane."""
    spin = axis / np.linalg.norm(axis)
    across = np.cross(spin, [0.0, 0.0, 1.0])
    across /= np.linalg.norm(across)
    up = np.cross(across, spin)
    return np.asarray(centre + radius * (np.cos(RIM)[:, None] * across + np.sin(RIM)[:, None] * up))


def _draw(
    panel: Panel, drawn: Sequence[Mapping[str, FloatArray]], across: int, up: int, *, sides: Sequence[str]
) -> None:
    for order, (lines, (colour, width, dash)) in enumerate(zip(drawn, LOOKS, strict=True), start=1):
        parts = [points for name, points in lines.items() if name[-1] in sides and name[:-2] != "wheel"]
        starts, ends = (np.concatenate([p[k::2] for p in parts]) for k in (0, 1))
        look: dict[str, Any] = {"colors": colour, "linewidths": width, "linestyles": [dash], "zorder": order}
        panel.segments(starts[:, across], starts[:, up], ends[:, across], ends[:, up], **look)
        for side in sides:
            rim = lines[f"wheel@{side}"]
            panel.plot(rim[:, across], rim[:, up], dash, color=colour, lw=width, zorder=order)


def _list(page: Sheet, shapes: CaseShapes, x: float, y: float) -> int:
    """Moves from static of the left side's points, as they are, and how many lines they take; x, y: points of
    the upper left corner."""
    static, low, high = shapes.states
    ends = [f"at {v:+g} {shapes.unit}" for v in shapes.inputs]
    head = [("left, mm", ends[0], "", "", ends[1], "", ""), ("", *"XYZ", *"XYZ")]
    rows = []
    listed = _listed(static)
    for name in listed:
        moves = [s.points[name] - static.points[name] for s in (low, high)]
        rows.append((name[:-2], *(f"{v + 0.0:.2f}" for v in np.concatenate(moves).round(2))))
    if (more := sum(name.endswith("@L") for name in static.points) - len(listed)) > 0:
        rows.append((f"and {more} more", *[""] * 6))
    for k, row in enumerate([*head, *rows]):
        height = (y - k * LIST_LINE) / page.height
        weight = "bold" if k < len(head) else "normal"
        for j, (place, words) in enumerate(zip(LIST_PLACES, row, strict=True)):
            left = j == 0 or k == 0
            at = (x + place + (0.0 if left else 24.0)) / page.width
            page.write(at, height, words, 6.3, "left" if left else "right", "top", weight=weight)
    return len(head) + len(rows)


def _listed(static: Shape) -> list[str]:
    names = [f"{listed}@L" for listed in LISTED]
    if all(name in static.points for name in names):
        return names
    return [name for name in static.points if name.endswith("@L")][:LISTED_OF_TYPE]


def _handles(shapes: CaseShapes) -> list[Line2D]:
    words = ["static", *(f"{v:+g} {shapes.unit}" for v in shapes.inputs)]
    return [
        Line2D([], [], color=colour, lw=width, ls=dash, label=name)
        for (colour, width, dash), name in zip(LOOKS, words, strict=True)
    ]


def write_shape_figures(
    axle: Axle, solution: Solution, folder: Path, *, pictures: PictureFormat = PNG
) -> list[Path]:
    """`shape_<load case>`, a picture of every load case that was solved; returns the paths.

    Raises RunError when the folder cannot be written.
    """
    jobs = [
        (folder / f"shape_{name}", partial(shape_figure, case_shapes(axle, case), axle.name))
        for name, case in solution.cases.items()
    ]
    return draw_series(jobs, pictures=pictures)
