"""Loops of friction and hysteresis before and after a discovery: widths by load case, and their picture."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from doe_kc.curves import RESPONSE_UNITS, SIDE_WORDS, SIDES, response_name
from doe_kc.discovery.result import Discovery
from doe_kc.ground.numbers import at_sd, with_sd
from doe_kc.ground.typing import FloatArray
from doe_kc.load_cases import case_label
from doe_kc.reports.correlation.curves import BAND_SDS
from doe_kc.reports.discovery.curves import ModelView, model_views
from doe_kc.reports.discovery.gaps import MODEL_COLOURS
from doe_kc.reports.discovery.words import MODEL_LABELS, model_head
from doe_kc.reports.drawing.panel import Dash, Panel
from doe_kc.reports.drawing.panel_axis import ticks
from doe_kc.reports.drawing.sheet import Sheet, sheet
from doe_kc.reports.hysteresis import inner_weights
from doe_kc.reports.names import without_remark
from doe_kc.reports.table import Column, PageCell, PageLayout, Table

VISIBLE_SDS = 3.5
"""Standard deviations from which the widest loop of a load case is one: the widest of fourteen curves without
a loop passes it in 0.7 % of the load cases."""
LOOPS_DRAWN = 4
LOOP_HEIGHT, LOOP_WIDTH = 2.75, 2.75
"""Inches of a panel with its names."""
LOOP_MARGINS = {"top": 0.8, "bottom": 0.31, "wspace": 0.42}
LOOP_EDGES = 0.62, 0.12
"""Inches left and right of all panels."""


@dataclass(frozen=True)
class LoopPair:
    """The loop of one wheel that stands out most in its load case: mean half-widths over the inner half of
    the sweep, (input falling - rising) / 2, in the response's unit.

    sd: of the measured one. before, after: of the model as handed in and of the one handed over.
    model: of the one handed over, by the names of `Gap`.
    """

    view: ModelView
    side: int
    measured: float
    sd: float
    before: float
    after: float
    model: str

    @property
    def prominence(self) -> float:
        """The widest of the three as a multiple of the noise."""
        return max(map(abs, (self.measured, self.before, self.after))) / self.sd

    @property
    def wheel(self) -> str:
        """Left or right."""
        return SIDE_WORDS[SIDES[self.side]]

    @property
    def unit(self) -> str:
        """Of the response."""
        return RESPONSE_UNITS[self.view.response]


def loop_pairs(discovery: Discovery) -> list[LoopPair]:
    """A load case each that has a loop, measured or modelled, in the order of the records."""
    sds = {
        (c.load_case, c.response, c.side): float(np.linalg.norm(c.root.T @ inner_weights(c.input)))
        for c in discovery.search.tuned.model.likelihood.curves
        if c.branches == "half_width"
    }
    model = "with_effect" if discovery.fitted.model.members else "tuned"
    widest: dict[str, LoopPair] = {}
    for view in model_views(discovery).values():
        if view.branches != "half_width":
            continue
        for side in range(len(SIDES)):
            sd = sds.get((view.load_case, view.response, side), 0.0)
            if sd > 0.0:
                pair = _pair(view, side, sd, model)
                best = widest.get(view.load_case)
                if best is None or pair.prominence > best.prominence:
                    widest[view.load_case] = pair
    return [pair for pair in widest.values() if pair.prominence > VISIBLE_SDS]


def _pair(view: ModelView, side: int, sd: float, model: str) -> LoopPair:
    weights = inner_weights(view.input)
    each = (view.measured, view.models["nominal"], view.models[model])
    measured, before, after = (float(weights @ curves[side]) for curves in each)
    return LoopPair(view, side, measured, sd, before, after, model)


def loop_table(pairs: Sequence[LoopPair]) -> Table[LoopPair]:
    """Half-widths by load case, measured, before and after."""
    last = model_head("with_effect" if any(p.model == "with_effect" for p in pairs) else "tuned")
    columns: tuple[Column[LoopPair], ...] = (
        Column("load_case", "Load case", lambda p: p.view.load_case, 
              words=lambda p: case_label(p.view.load_case), page=PageCell(style="first")),
        Column("response", "Widest loop", lambda p: p.view.response,
               page=PageCell(text=lambda p: f"{response_name(p.view.response)}, {p.wheel}")),
        Column("unit", "Unit", lambda p: p.unit, page=PageCell()),
        Column("measured", "Measured half-width ± sd", lambda p: p.measured, "0.000",
               page=PageCell(text=lambda p: with_sd(p.measured, p.sd), strong=lambda p: True)),
        Column("before", model_head("nominal"), lambda p: p.before, "0.000",
               page=PageCell(text=lambda p: at_sd(p.before, p.sd))),
        Column("after", last, lambda p: p.after, "0.000",
               page=PageCell(text=lambda p: at_sd(p.after, p.sd))),
    )  # fmt: skip
    layout = PageLayout[LoopPair]("loops-table", "Loops")
    return Table("Loops", "Half-widths of the loops by load case.", columns, pairs, page=layout)


def loop_figure(pairs: Sequence[LoopPair]) -> Sheet:
    """The most prominent loops beside each other, each about the mean of its two branches."""
    drawn = sorted(pairs, key=lambda p: -p.prominence)[:LOOPS_DRAWN]
    width = LOOP_WIDTH * len(drawn) + sum(LOOP_EDGES)
    margins = {**LOOP_MARGINS, "left": LOOP_EDGES[0] / width, "right": 1.0 - LOOP_EDGES[1] / width}
    page, panels = sheet(1, len(drawn), size=(width, LOOP_HEIGHT), share_x=False, margins=margins)
    for panel, pair in zip(panels[0], drawn, strict=True):
        _draw(panel, pair)
    page.add_legend(_loop_handles(drawn), 4 if len(drawn) > 1 else 2, 7.0)
    return page


def _draw(panel: Panel, pair: LoopPair) -> None:
    view, side = pair.view, pair.side
    measured, band = view.measured[side], BAND_SDS * view.sd[side]
    for sign in (1.0, -1.0):
        panel.fill_between(
            view.input, sign * measured - band, sign * measured + band, color="#BBBBBB", alpha=0.6, lw=0
        )
    panel.hline(0.0, color="#8A9199", lw=0.5, zorder=1)
    for model, dash in _looks(pair).items():
        panel.plot(*_closed(view.input, view.models[model][side]), dash, color=MODEL_COLOURS[model], lw=1.3)
    panel.plot(*_closed(view.input, measured), "", marker="o", color="black", ms=1.8, mew=0.0, zorder=4)
    panel.set_title(f"{case_label(view.load_case)}, {pair.wheel} wheel", size=8.0)
    panel.set_labels(
        without_remark(view.input_label), f"{response_name(view.response)} about the mean [{pair.unit}]", 7.0
    )
    panel.x.set_locator(ticks(4))
    panel.y.set_locator(ticks(5))


def _looks(pair: LoopPair) -> dict[str, Dash]:
    return {"nominal": (0, (2, 1.5)), pair.model: "-"}


def _closed(inputs: FloatArray, half: FloatArray) -> tuple[FloatArray, FloatArray]:
    """The loop of a half-width: the falling branch, and back on the rising one."""
    return np.concatenate([inputs[::-1], inputs]), np.concatenate([half[::-1], -half])


def _loop_handles(pairs: Sequence[LoopPair]) -> list[Line2D | Patch]:
    return [
        Line2D([], [], color="black", ls="", marker="o", ms=3, label="measured"),
        Patch(color="#BBBBBB", alpha=0.6, lw=0.0, label=f"±{BAND_SDS:g} standard deviations of its noise"),
        *(
            Line2D([], [], color=MODEL_COLOURS[model], ls=dash, lw=1.3, label=MODEL_LABELS[model])
            for model, dash in _looks(pairs[0]).items()
        ),
    ]
