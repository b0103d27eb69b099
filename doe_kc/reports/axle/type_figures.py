"""The axle types drawn: all of them at a slant on one page, and each from three sides with its points."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.lines import Line2D

from doe_kc.axle.geometry import point
from doe_kc.axle.members import members_of, shared_parts
from doe_kc.axle.model import Axle
from doe_kc.ground.picture_format import PNG, PictureFormat
from doe_kc.ground.typing import FloatArray
from doe_kc.reports.axle.point_moves import AxleView
from doe_kc.reports.axle.views import axle_figure, member_colours
from doe_kc.reports.drawing import style
from doe_kc.reports.drawing.panel import PageBox, Panel
from doe_kc.reports.drawing.series import Job, draw_series
from doe_kc.reports.drawing.sheet import Sheet
from doe_kc.reports.drawing.words import POINTS

SIGHT = np.array([1.0, 0.75, -0.55])
"""Direction in which the axles are looked at: from the left in front, from above."""
SIDE_SIGNS = np.array([[1.0, 1.0, 1.0], [1.0, -1.0, 1.0]])
"""Factors that make the left and the right side of the left."""
TYPE_COLUMNS = 2
EDGE, HEAD_ROOM, TITLE_ROOM, KEY_ROOM, CELL_HEIGHT = 12.0, 34.0, 16.0, 74.0, 168.0
"""Points about and between the drawings."""
FREE_SPACE = 1.05
"""-, a cell's size over that of what it shows."""
WHEEL_COLOUR = "#555555"


@dataclass(frozen=True)
class TypeExample:
    """An axle of a type. name: of the type, as an axle file gives it."""

    name: str
    label: str
    axle: Axle


def type_catalogue(examples: Sequence[TypeExample]) -> Sheet:
    """All types on one page, both sides at a slant, each fitted to its cell; parts by colour."""
    rows = -(-len(examples) // TYPE_COLUMNS)
    width = style.A4[0] * POINTS
    height = HEAD_ROOM + rows * (CELL_HEIGHT + TITLE_ROOM) + KEY_ROOM
    page = Sheet((style.A4[0], height / POINTS))
    cell = (width - EDGE) / TYPE_COLUMNS
    colours = member_colours(dict.fromkeys(m for e in examples for m in members_of(e.axle)))
    for k, example in enumerate(examples):
        row, column = divmod(k, TYPE_COLUMNS)
        floor = height - HEAD_ROOM - (row + 1) * (CELL_HEIGHT + TITLE_ROOM)
        panel = page.add_panel(PageBox(EDGE + column * cell, floor, cell - EDGE, CELL_HEIGHT))
        panel.set_title(f"{example.label}: {example.name}")
        for part in (panel.spines, panel.grid, panel.marks, panel.numbers):
            part.update(dict.fromkeys(part, False))
        _draw(panel, example.axle, colours)
    handles = [Line2D([], [], color=c, lw=1.5, label=name) for name, c in colours.items()]
    handles.append(Line2D([], [], color=WHEEL_COLOUR, lw=1.0, label="wheel (its rolling radius)"))
    page.add_legend(handles, columns=4, size=7.5)
    page.set_heading("Axle types, seen from the left in front", 1.0 - 16.0 / height)
    return page


def _draw(panel: Panel, axle: Axle, colours: Mapping[str, str]) -> None:
    rim = _rim(point(axle, "WLC"))
    members = {
        member: np.array([[point(axle, a), point(axle, b)] for a, b in ends])
        for member, ends in members_of(axle).items()
    }
    ends = np.vstack([pairs.reshape(-1, 3) for pairs in members.values()])
    _fit(panel, np.vstack([_seen(places * side) for places in (rim, ends) for side in SIDE_SIGNS]))
    for side in SIDE_SIGNS:
        wheel, hardpoints = _seen(rim * side), _seen(ends * side)
        panel.plot(wheel[:, 0], wheel[:, 1], color=WHEEL_COLOUR, lw=1.0, zorder=1)
        for member, pairs in members.items():
            _lines(panel, pairs * side, colours[member])
        look: dict[str, Any] = {"color": "black", "mfc": "white", "ms": 2.4, "mew": 0.6, "zorder": 3}
        panel.plot(hardpoints[:, 0], hardpoints[:, 1], marker="o", ls="", **look)
    for member in shared_parts(axle) & members.keys():
        places = members[member].reshape(-1, 3)
        innermost = places[np.argmax(places[:, 1])]
        _lines(panel, (innermost * SIDE_SIGNS)[np.newaxis], colours[member])


def _lines(panel: Panel, pairs: FloatArray, colour: str) -> None:
    """Of (n, 2, 3) ends in mm."""
    (x0, y0), (x1, y1) = _seen(pairs).transpose(1, 2, 0)
    panel.segments(x0, y0, x1, y1, colors=colour, zorder=2, linewidths=1.4)


def _seen(places: FloatArray) -> FloatArray:
    """(..., 2) of (..., 3) places in mm: to the right and up in the plane across the direction of sight."""
    sight = SIGHT / np.linalg.norm(SIGHT)
    right = np.cross(sight, [0.0, 0.0, 1.0])
    right /= np.linalg.norm(right)
    return np.stack([places @ right, places @ np.cross(right, sight)], axis=-1)


def _rim(centre: FloatArray) -> FloatArray:
    """(n, 3) points of a wheel that stands upright."""
    turn = np.linspace(0.0, 2.0 * np.pi, 73)
    circle = np.stack([np.cos(turn), np.zeros_like(turn), np.sin(turn)], axis=-1)
    return np.asarray(centre + centre[2] * circle)


def _fit(panel: Panel, shown: FloatArray) -> None:
    """Limits that hold all (n, 2) places in one scale for both directions."""
    low, high = shown.min(axis=0), shown.max(axis=0)
    size = np.array([panel.box.width, panel.box.height])
    middle, scale = (low + high) / 2.0, float(((high - low) * FREE_SPACE / size).max())
    for axis, at, length in zip((panel.x, panel.y), middle, scale * size, strict=True):
        axis.set_limits(at - length / 2.0, at + length / 2.0)


def write_type_figures(
    examples: Sequence[TypeExample], folder: Path, *, pictures: PictureFormat = PNG
) -> list[Path]:
    """`axle_types`, all on one page, and `<type>`, each from three sides; returns the paths.

    Raises RunError when the folder cannot be written.
    """
    jobs: list[Job] = [(folder / "axle_types", partial(type_catalogue, examples))]
    jobs += [(folder / e.name, partial(axle_figure, AxleView(e.label, e.axle))) for e in examples]
    return draw_series(jobs, pictures=pictures)
