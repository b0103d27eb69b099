"""Loop widths of every load case and response, measured and modelled: the table and its picture."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from doe_kc.correlation.result import Correlation
from doe_kc.curves import (
    RESPONSE_LABELS,
    RESPONSE_UNITS,
    RIG_RESPONSES,
    SIDE_WORDS,
    SIDES,
    CaseCurves,
    response_name,
)
from doe_kc.ground.numbers import number, sd_format
from doe_kc.ground.typing import FloatArray
from doe_kc.load_cases import case_label
from doe_kc.measurement import Measurement
from doe_kc.reports.correlation.curves import BAND_SDS, CaseView, case_views, has_loop
from doe_kc.reports.drawing import style
from doe_kc.reports.drawing.panel import Panel
from doe_kc.reports.drawing.panel_axis import ticks
from doe_kc.reports.drawing.sheet import Sheet, sheet
from doe_kc.reports.table import Column, SheetLayout, Table

INNER = 0.5
"""Share of the amplitude within which a loop's width is averaged: at its ends both branches meet."""
HYSTERESIS_MARGINS = {
    "left": 0.062,
    "right": 0.992,
    "top": 0.9,
    "bottom": 0.075,
    "wspace": 0.52,
    "hspace": 0.4,
}
LEAST_RANGE = 5.0
"""Standard deviations that an axis reaches at least: noise does not fill a panel."""
MEASURED_COLOURS = (style.PALETTE["black"], style.PALETTE["grey"])


@dataclass(frozen=True)
class LoopWidth:
    """Mean half-width of a loop over the inner half of its sweep, (falling - rising) / 2, in `unit`; nan for
    what there is not. sd: of the measured one, from its noise."""

    load_case: str
    response: str
    side: str
    measured: float
    sd: float
    baseline: float
    final: float

    @property
    def unit(self) -> str:
        """Of the response."""
        return RESPONSE_UNITS[self.response]

    @property
    def visible(self) -> bool:
        """Whether the measured loop is wider than its noise explains."""
        return abs(self.measured) > BAND_SDS * self.sd


def loop_widths(correlation: Correlation, measurement: Measurement) -> list[LoopWidth]:
    """A row a measured load case, response and wheel."""
    return [
        _width(view, response, side, measurement)
        for view in case_views(correlation, measurement)
        if view.measured is not None
        for response in RIG_RESPONSES
        for side in range(len(SIDES))
    ]


def inner_mean(case: CaseCurves | None, response: str, side: int) -> float:
    """Mean half-width over the inner half of the sweep; nan without the curve."""
    if case is None or response not in case.half_width:
        return math.nan
    return float(inner_weights(case.input) @ case.half_width[response][side])


def inner_weights(inputs: FloatArray) -> FloatArray:
    """(n,) that average a curve over the inner half of its inputs."""
    inside = np.abs(inputs) <= INNER * np.abs(inputs).max()
    return np.asarray(inside / inside.sum())


def _width(view: CaseView, response: str, side: int, measurement: Measurement) -> LoopWidth:
    case = view.measured
    assert case is not None
    noise = measurement.noise.get(view.load_case, {}).get(response)
    sd = math.nan
    if noise is not None:
        weights = inner_weights(case.input)
        sd = float(np.sqrt(weights @ noise.half_width_covariance(side=side) @ weights))
    models = (inner_mean(c, response, side) for c in (view.baseline, view.final))
    return LoopWidth(view.load_case, response, SIDES[side], inner_mean(case, response, side), sd, *models)


HYSTERESIS_COLUMNS: tuple[Column[LoopWidth], ...] = (
    Column("load_case", "Load case", lambda r: r.load_case, width=28,
           words=lambda r: case_label(r.load_case)),
    Column("response", "Response", lambda r: r.response, width=32,
           words=lambda r: RESPONSE_LABELS[r.response]),
    Column("side", "Wheel", lambda r: r.side, width=8, words=lambda r: SIDE_WORDS[r.side]),
    Column("unit", "Unit", lambda r: r.unit, width=8),
    Column("measured", "Measured", lambda r: r.measured, lambda r: sd_format(r.sd), 12),
    Column("sd", "sd", lambda r: r.sd, lambda r: sd_format(r.sd), 12),
    Column("baseline", "Baseline", lambda r: r.baseline, lambda r: sd_format(r.sd), 12),
    Column("final", "Final", lambda r: r.final, lambda r: sd_format(r.sd), 12),
    Column("visible", "Beyond noise", lambda r: r.visible, width=13),
)  # fmt: skip


def hysteresis_table(rows: Sequence[LoopWidth]) -> Table[LoopWidth]:
    """Half-widths of the loops."""
    return Table(
        "Hysteresis",
        "Half-width of the loop, mean over the inner half of the sweep: (input falling - input rising) / 2. "
        f"Grey: within ±{BAND_SDS:g} sd of none.",
        HYSTERESIS_COLUMNS,
        rows,
        muted=lambda r: not r.visible,
        sheet=SheetLayout(frozen="measured"),
    )


def hysteresis_figure(views: Sequence[CaseView], study: str) -> Sheet:
    """A row a load case, a column a response: half-width of the loop over the input.

    Numbers: mean over the inner half of the sweep, left wheel, measured / final.
    """
    page, panels = sheet(
        len(views), len(RIG_RESPONSES), size=style.A4, share_x=True, margins=HYSTERESIS_MARGINS
    )
    for i, (row, view) in enumerate(zip(panels, views, strict=True)):
        for panel, response in zip(row, RIG_RESPONSES, strict=True):
            _loop(panel, view, response)
            if i == 0:
                words = f"{response_name(response)}\n[{RESPONSE_UNITS[response]}]"
                panel.text(
                    0.5, 1.0, words, scales=("panel", "panel"), shift=(0.0, 27.0), size=7.0, across="center"
                )
        first = row[0]
        first.text(0.0, 1.0, _row_title(view), scales=("panel", "panel"), shift=(-22.0, 13.0), size=7.0,
                   weight="bold")  # fmt: skip
    middle = panels[-1][len(RIG_RESPONSES) // 2]
    middle.set_labels("input, share of its amplitude", None, 7.0)
    page.write(
        0.5, 1 - 26.0 / page.height,
        "half of the difference between input falling and rising; numbers: mean over the inner half of the "
        "sweep, left wheel, measured / final",
        6.5, "center", "top", color="#555555",
    )  # fmt: skip
    page.add_legend(_handles(views), 4)
    page.set_heading(f"Loop widths, measured and modelled: {study}", 1 - 8.0 / page.height)
    return page


def _row_title(view: CaseView) -> str:
    case = view.any
    return f"{case_label(view.load_case)}, ±{round(np.abs(case.input).max(), 1):g} {case.input_unit}"


def _loop(panel: Panel, view: CaseView, response: str) -> None:
    panel.hline(0.0, color="#8A9199", lw=0.5, zorder=1)
    measured = view.measured
    if measured is not None:
        x = measured.input / np.abs(measured.input).max()
        sd = view.half_width_sd.get(response)
        for side in (1, 0):
            half = measured.half_width[response][side]
            if sd is not None and side == 0:
                band = BAND_SDS * sd[side]
                panel.fill_between(x, half - band, half + band, color="#BBBBBB", alpha=0.6, zorder=0)
                panel.y.include(LEAST_RANGE * np.array([-1.0, 1.0]) * float(np.median(sd[side])))
            panel.plot(x, half, color=MEASURED_COLOURS[side], lw=0.6 if side else 0.9)
    for case, colour in ((view.baseline, style.BASELINE_COLOUR), (view.final, style.FINAL_COLOUR)):
        if case is not None and response in case.half_width and has_loop(case, response):
            x = case.input / np.abs(case.input).max()
            left, right = case.half_width[response]
            panel.plot(x, right, "--", color=colour, lw=0.7, zorder=3)
            panel.plot(x, left, color=colour, lw=1.1, zorder=3)
    panel.text(
        0.5, 1.0, _numbers(view, response), scales=("panel", "panel"), shift=(0.0, 3.0), size=5.5,
        across="center",
    )  # fmt: skip
    panel.number_size = {"x": 5.5, "y": 5.5}
    panel.x.set_ticks([-1.0, 0.0, 1.0], ["-1", "0", "1"])
    panel.y.set_locator(ticks(3))


def _numbers(view: CaseView, response: str) -> str:
    """Measured and final mean of the left wheel, with a digit more than a point of the curve bears."""
    means = [inner_mean(case, response, 0) for case in (view.measured, view.final)]
    sd = view.half_width_sd.get(response)
    if sd is None or not np.median(sd[0]) > 0.0:
        return " / ".join(number(v) for v in means)
    digits = max(0, 1 - math.floor(math.log10(float(np.median(sd[0])))))
    return " / ".join(f"{round(v, digits) + 0.0:.{digits}f}" for v in means)


def _handles(views: Sequence[CaseView]) -> list[Line2D | Patch]:
    out: list[Line2D | Patch] = [
        Line2D([], [], color=MEASURED_COLOURS[0], lw=0.9, label="measured, left wheel"),
        Line2D([], [], color=MEASURED_COLOURS[1], lw=0.6, label="measured, right wheel"),
        Patch(color="#BBBBBB", alpha=0.6, lw=0.0, label=f"±{BAND_SDS:g} sd, left wheel"),
    ]
    for name, colour in (("baseline", style.BASELINE_COLOUR), ("final", style.FINAL_COLOUR)):
        cases = [getattr(v, name) for v in views]
        if any(c is not None and has_loop(c, r) for c in cases for r in (c.half_width if c else ())):
            out += [
                Line2D([], [], color=colour, lw=1.1, label=f"{name}, left wheel"),
                Line2D([], [], color=colour, lw=0.7, ls="--", label=f"{name}, right wheel"),
            ]
    return out
