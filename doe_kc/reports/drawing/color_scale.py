"""The key of a heat map: its colours over the values that they stand for."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.collections import PolyCollection
from matplotlib.typing import ColorType

from doe_kc.ground.typing import FloatArray
from doe_kc.reports.drawing.panel import Panel

STRIPS = 256
"""Of a gradual scale."""


def draw_color_scale(
    panel: Panel, edges: FloatArray, colors: Sequence[ColorType] | FloatArray, *, upright: bool = False
) -> None:
    """Fill `panel` with strips between `edges`, (n + 1,) in its own units, of `colors`, n; across it, or from
    below when upright. The other axis has neither ticks nor a meaning."""
    low, high, zero, one = edges[:-1], edges[1:], np.zeros(edges.size - 1), np.ones(edges.size - 1)
    corners = np.stack([[low, zero], [high, zero], [high, one], [low, one]]).transpose(2, 0, 1)
    along, other = (panel.y, panel.x) if upright else (panel.x, panel.y)
    strips = PolyCollection(
        list(corners[:, :, ::-1] if upright else corners),
        facecolors=colors,
        linewidths=0.0,
        antialiaseds=False,
    )
    panel.add(strips)
    along.set_limits(edges[0], edges[-1])
    other.set_limits(0.0, 1.0)
    other.set_ticks([], [])
    panel.grid = {"x": False, "y": False}
    panel.spines = {"left": False, "bottom": False}


def outline(panel: Panel) -> None:
    """A thin frame on all four sides."""
    panel.plot(
        [0, 1, 1, 0, 0], [0, 0, 1, 1, 0], scales=("panel", "panel"), clip=False, color="black", lw=0.8,
        zorder=2.5,
    )  # fmt: skip
