"""Parameters that re-tuning had to bend, and where they go once the effect is in the model."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.lines import Line2D
from matplotlib.patches import FancyArrowPatch, Patch

from doe_kc.discovery.thresholds import RETURNS_FROM
from doe_kc.ground.numbers import decimals, short, unit_words, with_sd
from doe_kc.reports.discovery.gaps import MODEL_COLOURS
from doe_kc.reports.discovery.parameters import TunedParameter
from doe_kc.reports.drawing import style
from doe_kc.reports.drawing.panel import Panel
from doe_kc.reports.drawing.sheet import Sheet, sheet

PARAMETERS_SHOWN = 40
BIAS_ROW = 0.17
RETURNS, LEAVES, STILL_COLOUR = style.PALETTE["blue"], style.PALETTE["vermillion"], "#8A9199"
ARROWS = {
    RETURNS: "returns with the effect",
    LEAVES: "goes further off",
    STILL_COLOUR: "as far off as before",
}
"""What the colour of an arrow says."""
NEITHER = 0.1
"""Standard deviations of the prior by which a parameter must move for its arrow to have a colour."""


def moved_parameters(parameters: Sequence[TunedParameter]) -> list[TunedParameter]:
    """Those that are furthest off nominal in one of the two fits, the ones that return furthest first."""
    off = sorted((p for p in parameters if p.moved >= RETURNS_FROM), key=lambda p: -p.moved)
    return sorted(
        off[:PARAMETERS_SHOWN],
        key=lambda p: _away(p) if np.isfinite(p.with_effect_distance) else -p.moved,
    )


def _away(p: TunedParameter) -> float:
    """How much further from nominal the effect leaves it, sd of the prior."""
    return abs(p.with_effect_distance) - abs(p.tuned_distance)


def parameter_figure(parameters: Sequence[TunedParameter], study: str) -> Sheet:
    """An arrow a parameter, from the re-tuned model to the one with the effect, in sd of the prior."""
    rows = moved_parameters(parameters)
    height = BIAS_ROW * max(len(rows), 4) + 1.75
    margins = {"left": 0.15, "right": 0.62, "top": 1 - 0.75 / height, "bottom": 0.95 / height}
    page, panels = sheet(1, 1, size=(8.27, height), margins=margins)
    panel = panels[0, 0]
    reach = max(2.0, 1.08 * max((p.moved for p in rows), default=1.0))
    panel.x.set_limits(-reach, reach)
    panel.y.set_limits(max(len(rows), 1), 0)
    panel.vspan(-1, 1, color="#EEF1F3", zorder=0)
    panel.vline(0.0, color="black", lw=0.8, zorder=1)
    panel.grid["y"] = panel.marks["y"] = False
    panel.y.set_ticks([i + 0.5 for i in range(len(rows))], [p.path for p in rows])
    panel.number_size["y"] = 6.5
    panel.set_labels("distance from nominal, times production scatter", None)
    for y, p in enumerate(rows):
        _arrow(panel, y + 0.5, p)
    if rows:
        heads = "nominal, re-tuned, with the effect ± sd"
        panel.text(1.02, -0.35, heads, scales=("panel", "data"), size=6.5, color="#555555")
    else:
        panel.text(0, 0.5, "no parameter is off nominal", across="center", along="center")
    page.add_legend(_handles(rows), 4)
    count = f", the {len(rows)} of {len(parameters)} furthest off" if len(rows) == PARAMETERS_SHOWN else ""
    page.set_heading(f"Parameters before and after{count}: {study}", 1 - 0.12 / height)
    return page


def _arrow(panel: Panel, y: float, p: TunedParameter) -> None:
    start, end = p.tuned_distance, p.with_effect_distance
    panel.plot(start, y, "", marker="o", color=MODEL_COLOURS["tuned"], mfc="white", ms=4, mew=1.2, zorder=3)
    if np.isfinite(end):
        arrow = FancyArrowPatch(
            (start, y), (end, y), arrowstyle="-|>", color=arrow_colour(p), lw=1.1, mutation_scale=7,
            shrinkA=2, shrinkB=0, zorder=3,
        )  # fmt: skip
        panel.add(arrow, clip=False)
    panel.text(1.02, y, values_words(p), scales=("panel", "data"), size=6.2, along="center")


def values_words(p: TunedParameter) -> str:
    """The three values with their unit, the last with its standard deviation."""
    *before, last = (v for v in (p.nominal, p.tuned, p.with_effect) if np.isfinite(v))
    digits = decimals(p.sd)
    text = "  →  ".join(
        [*(short(v) if digits is None else f"{v:.{digits}f}" for v in before), with_sd(last, p.sd)]
    )
    return f"{text}{unit_words(p.unit)}"


def arrow_colour(p: TunedParameter) -> str:
    """Blue where the effect brings it back, red where further off."""
    change = _away(p)
    return STILL_COLOUR if abs(change) < NEITHER else RETURNS if change < 0 else LEAVES


def _handles(rows: Sequence[TunedParameter]) -> list[Line2D | Patch]:
    out: list[Line2D | Patch] = [
        Line2D([], [], color=MODEL_COLOURS["tuned"], ls="", marker="o", mfc="white", mew=1.2,
               label="re-tuned without an effect")
    ]  # fmt: skip
    if any(np.isfinite(p.with_effect_distance) for p in rows):
        drawn = {arrow_colour(p) for p in rows}
        out += [
            Line2D([], [], color=colour, marker=">", ms=4, lw=1.1, label=label)
            for colour, label in ARROWS.items()
            if colour in drawn
        ]
    return [*out, Patch(color="#E4E7EA", label="production scatter, ±1 standard deviation")]
