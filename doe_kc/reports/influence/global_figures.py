"""The picture of global sensitivities: the strongest variables of each characteristic, by slopes and over the
ranges."""

from __future__ import annotations

import numpy as np
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from doe_kc.ground.typing import FloatArray
from doe_kc.parameter_influence.global_sensitivity import GlobalSensitivity, MethodResult
from doe_kc.reports.drawing.panel import Panel
from doe_kc.reports.drawing.sheet import Sheet, sheet
from doe_kc.reports.drawing.style import PALETTE
from doe_kc.reports.influence.global_tables import heading

DRAWN_FIRST = ("sobol", "morris", "pawn")
"""Which of several methods is drawn."""
GLOBAL_PANELS = 3
STRONGEST_DRAWN = 8
LOCAL_COLOUR, GLOBAL_COLOUR, ERROR_COLOUR = PALETTE["sky"], PALETTE["blue"], PALETTE["vermillion"]


def global_bars(result: GlobalSensitivity, *, study: str) -> Sheet:
    """One panel a characteristic: by slopes, and by the method with its 95 % intervals."""
    method = next(m for name in DRAWN_FIRST for m in result.methods if m.id == name)
    count = len(result.characteristics)
    rows = -(-count // GLOBAL_PANELS)
    height = 1.2 + 1.72 * rows
    margins = {"left": 0.13, "right": 0.985, "wspace": 0.56, "hspace": 0.5}
    margins |= {"bottom": 0.8 / height, "top": 1.0 - 0.8 / height}
    page, panels = sheet(rows, GLOBAL_PANELS, size=(8.27, height), share_x=False, margins=margins)
    for k, panel in enumerate(panels.flat[:count]):
        _panel(panel, result, method, k)
    del page.panels[count:]
    index = method.index(method.main)
    local = "slope times range" if method.id == "morris" else "share of the variance by slopes"
    handles: list[Line2D | Patch] = [
        Patch(color=LOCAL_COLOUR, label=f"{local}, unchanged axle"),
        Patch(color=GLOBAL_COLOUR, label=f"{method.label}: {index.label}, over the ranges"),
        Line2D([], [], color=ERROR_COLOUR, lw=1.2, label="its 95 % interval"),
    ]
    page.add_legend(handles, 3, 7.5)
    page.set_heading(f"Local and global influence, percent: {study}", 1 - 0.12 / height)
    return page


def _panel(panel: Panel, result: GlobalSensitivity, method: MethodResult, k: int) -> None:
    local, overall, error = _percents(result, method, k)
    chosen = np.argsort(-np.maximum(local, overall), kind="stable")[:STRONGEST_DRAWN]
    places = np.arange(chosen.size, dtype=float)
    panel.bars(places - 0.2, 0.0, local[chosen], 0.36, [LOCAL_COLOUR] * chosen.size)
    panel.bars(places + 0.2, 0.0, overall[chosen], 0.36, [GLOBAL_COLOUR] * chosen.size)
    low, high = overall[chosen] - error[chosen], overall[chosen] + error[chosen]
    panel.segments(low, places + 0.2, high, places + 0.2, colors=ERROR_COLOUR, linewidths=1.2, zorder=3)
    panel.vline(0.0, color=PALETTE["black"], lw=0.6)
    panel.x.set_limits(min(0.0, float(low.min())), 1.05 * max(100.0, float(high.max()), float(local.max())))
    panel.y.set_limits(STRONGEST_DRAWN - 0.4, -0.6)
    panel.y.set_ticks(places, [result.variables[i].path for i in chosen])
    panel.number_size["y"] = 6.0
    panel.set_title(heading(result.characteristics[k]), size=7.0)


def _percents(
    result: GlobalSensitivity, method: MethodResult, k: int
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """By slopes, by the method, and its error: percent of the variance, or of the largest mean effect."""
    main = method.index(method.main)
    if method.id == "morris":
        full = max(float(main.values[:, k].max()), 1e-300)
        local = np.abs(result.effects[:, k]) / full
        return 100.0 * local, 100.0 * main.values[:, k] / full, 100.0 * main.error[:, k] / full
    return 100.0 * result.shares[:, k], 100.0 * main.values[:, k], 100.0 * main.error[:, k]
