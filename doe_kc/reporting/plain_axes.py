"""Axes of a sheet of many panels as lines and texts.

Matplotlib keeps a dozen objects for each tick and updates them several times a drawing: 20 ms a panel,
four times what its curves take. Here grid, frame and tick marks of a panel are two collections of lines and
its numbers are plain texts; locators and formatters stay Matplotlib's own.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.text import Text

from doe_kc.reporting.style import DPI
from doe_kc.typing import FloatArray

POINTS = 72.0
"""Points an inch."""
TICK, PAD = 3.5, 3.5
"""Points: length of a tick mark, and from its end to the number (Matplotlib's own)."""
LABEL_PAD = 4.0
"""Points between numbers and the axis label (Matplotlib's own)."""
NUMBER_SIZE = 7.0
"""Points of a number where `tick_params(labelsize=...)` sets none."""
FRAME, FRAME_WIDTH = "#000000", 0.8
GRID, GRID_WIDTH = "#DDDDDD", 0.5
GRID_ORDER, FRAME_ORDER = 0.5, 2.5

Segment = tuple[tuple[float, float], tuple[float, float]]


def draw_plain_axes(fig: Figure) -> None:
    """Replace the drawing of every visible axis of a finished figure; limits, ticks and labels are kept.

    The last step of a figure with fixed margins: panels neither move nor change their limits afterwards.
    Minor ticks, ticks on top or right and turned numbers are not drawn.
    """
    width, height = fig.get_size_inches() * POINTS
    for ax in fig.axes:
        if ax.axison and ax.get_visible():
            box = ax.get_position()
            _plain(ax, box.width * width, box.height * height)


def _plain(ax: Axes, width: float, height: float) -> None:
    """width, height: of the panel in points."""
    x, x_words = _ticks(ax, ax.xaxis)
    y, y_words = _ticks(ax, ax.yaxis)
    show_x, show_y = ax.xaxis.get_tick_params(), ax.yaxis.get_tick_params()
    frame: list[Segment] = [((0.0, 0.0), (1.0, 0.0)), ((0.0, 0.0), (0.0, 1.0))]
    if show_x.get("bottom", True):
        frame += [((t, 0.0), (t, -TICK / height)) for t in x]
    if show_y.get("left", True):
        frame += [((0.0, t), (-TICK / width, t)) for t in y]
    grid: list[Segment] = [((t, 0.0), (t, 1.0)) for t in x] + [((0.0, t), (1.0, t)) for t in y]
    ax.set_axis_off()
    _lines(ax, grid, GRID, GRID_WIDTH, GRID_ORDER)
    _lines(ax, frame, FRAME, FRAME_WIDTH, FRAME_ORDER)

    below = left = TICK + PAD
    if show_x.get("labelbottom", True):
        size = _size(show_x)
        for t, word in zip(x, x_words, strict=True):
            _text(ax, t, -below / height, word, size, "center", "top")
        _offset(ax, ax.xaxis, (1.0, -(below + 1.2 * size) / height), size, "right", "top")
        below += 1.2 * size
    if show_y.get("labelleft", True):
        size = _size(show_y)
        made = [
            _text(ax, -left / width, t, w, size, "right", "center") for t, w in zip(y, y_words, strict=True)
        ]
        _offset(ax, ax.yaxis, (0.0, 1.0 + 2.0 / height), size, "left", "bottom")
        left += _widest(made)
    _label(ax.xaxis, ax, 0.5, -(below + LABEL_PAD) / height, 0.0)
    _label(ax.yaxis, ax, -(left + LABEL_PAD) / width, 0.5, 90.0)


def _ticks(ax: Axes, axis: Axis) -> tuple[FloatArray, list[str]]:
    """Places of an axis's ticks within its limits, as shares of its length, and what is written there."""
    horizontal = axis is ax.xaxis
    low, high = sorted(ax.get_xlim() if horizontal else ax.get_ylim())
    at = np.asarray(axis.get_majorticklocs(), dtype=float)
    words = axis.get_major_formatter().format_ticks(list(at))
    slack = 1e-10 * (high - low)
    inside = (at >= low - slack) & (at <= high + slack)
    pairs = np.zeros((at.size, 2))
    other = ax.get_ylim()[0] if horizontal else ax.get_xlim()[0]
    pairs[:, 0], pairs[:, 1] = (at, other) if horizontal else (other, at)
    shares = (ax.transScale + ax.transLimits).transform(pairs)[:, 0 if horizontal else 1]
    return shares[inside], [w for w, kept in zip(words, inside, strict=True) if kept]


def _size(parameters: dict[str, object]) -> float:
    return float(str(parameters.get("labelsize", NUMBER_SIZE)))


def _lines(ax: Axes, segments: Sequence[Segment], color: str, width: float, order: float) -> None:
    lines = LineCollection(segments, colors=color, linewidths=width, zorder=order, clip_on=False)
    lines.set_transform(ax.transAxes)
    ax.add_collection(lines, autolim=False)


def _text(ax: Axes, x: float, y: float, word: str, size: float, across: str, along: str) -> Text:
    return ax.text(x, y, word, fontsize=size, ha=across, va=along, transform=ax.transAxes)


def _offset(ax: Axes, axis: Axis, at: tuple[float, float], size: float, across: str, along: str) -> None:
    """The factor or offset that a formatter takes out of large and close numbers."""
    word = axis.get_major_formatter().get_offset()
    if word:
        _text(ax, *at, word, size, across, along)


def _widest(texts: Sequence[Text]) -> float:
    """Points of the widest text; only the longest ones are measured."""
    most = max((len(t.get_text()) for t in texts), default=0)
    longest = [t for t in texts if len(t.get_text()) >= most - 1]
    return max((t.get_window_extent().width * POINTS / DPI for t in longest), default=0.0)


def _label(axis: Axis, ax: Axes, x: float, y: float, rotation: float) -> None:
    own = axis.get_label()
    own.set_visible(False)  # neither drawn nor placed any more, yet what `get_xlabel` tells
    if own.get_text():
        along = "bottom" if rotation else "top"
        ax.text(
            x, y, own.get_text(), fontsize=own.get_fontsize(), rotation=rotation, ha="center",
            va=along, rotation_mode="anchor" if rotation else "default", transform=ax.transAxes,
        )  # fmt: skip
