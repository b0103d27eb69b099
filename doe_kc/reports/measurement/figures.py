"""Pictures of a reduced rig measurement: loop, branches, trend and gradient, one sheet per load case."""

from __future__ import annotations

from functools import partial
from pathlib import Path

import numpy as np
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from doe_kc.characteristics import CHARACTERISTICS
from doe_kc.characteristics.reduction import LEFT_WHEEL
from doe_kc.curves import RESPONSE_UNITS, RIG_RESPONSES, SIDES
from doe_kc.ground.numbers import with_sd
from doe_kc.ground.picture_format import PNG, PictureFormat
from doe_kc.ground.typing import FloatArray
from doe_kc.measurement import Gradient, Measurement
from doe_kc.reports.drawing.panel import Panel
from doe_kc.reports.drawing.panel_axis import ticks
from doe_kc.reports.drawing.series import draw_series
from doe_kc.reports.drawing.sheet import Sheet, sheet
from doe_kc.reports.drawing.style import A4, PALETTE
from doe_kc.reports.names import input_label, response_axis, without_remark

SIDE_TITLES = ("Left wheel", "Right wheel")
LOOP_COLOUR = PALETTE["grey"]
UNLOAD_COLOUR = PALETTE["blue"]
LOAD_COLOUR = PALETTE["orange"]
TREND_COLOUR = PALETTE["black"]
GRADIENT_COLOUR = PALETTE["vermillion"]
RESIDUAL_COLOURS = (PALETTE["blue"], PALETTE["vermillion"])
ABSCISSA_WORDS = {"wheel_travel": "of wheel travel", "pad_travel": "of pad travel"}
WINDOW_COLOUR = "#EAF3EA"
RIG_MARGINS = {"left": 0.09, "right": 0.988, "top": 0.948, "bottom": 0.078, "wspace": 0.355, "hspace": 0.12}


def rig_figure(measurement: Measurement, load_case: str) -> Sheet:
    """A4 sheet of one load case: a row per response; left wheel, right wheel, residual about the trend, or
    of several cars each car minus their mean.

    Raises KeyError when the load case was not measured.
    """
    case = measurement.curves.cases[load_case]
    run = measurement.runs[load_case][0]
    present = [r for r in RIG_RESPONSES if r in case.mean]
    page, panels = sheet(len(present), 3, size=A4, width_ratios=(1.0, 1.0, 0.9), margins=RIG_MARGINS)
    gradients = {(g.response, g.side): g for g in measurement.gradients if g.load_case == load_case}
    for row, response in zip(panels, present, strict=True):
        other = _characteristic(measurement, load_case, response)
        for side, name in enumerate(SIDES):
            _panel(row[side], measurement, load_case, response, side)
            _gradient(row[side], gradients[response, name], other if side == LEFT_WHEEL else "")
        _residual(row[2], measurement, load_case, response)
        _same_scale(row[0], row[1], notes=2 if other else 1)
        row[0].set_labels(None, response_axis(response))
        words = "difference" if measurement.cars else "residual"
        row[2].set_labels(None, f"{words} [{RESPONSE_UNITS[response]}]")
    for panel in panels.flat:
        panel.y.set_locator(ticks(5))
    for panel in panels[-1]:
        panel.set_labels(without_remark(input_label(load_case, case.input_unit)), None)
    last = "Cars minus mean" if measurement.cars else "Samples minus trend"
    for panel, title in zip(panels[0], (*SIDE_TITLES, last), strict=True):
        panel.set_title(title)
    page.set_heading(f"{measurement.manifest.name}: {run.record.case.label}", 0.985)
    page.add_legend(_legend(len(measurement.runs[load_case]), len(measurement.cars)), 4)
    return page


def write_rig_figures(
    measurement: Measurement, folder: Path, *, workers: int | None = None, pictures: PictureFormat = PNG
) -> list[Path]:
    """`rig_<load case>`, a picture of every measured load case; returns the paths.

    Raises RunError when the folder cannot be written.
    """
    return draw_series(
        [
            (folder / f"rig_{case}", partial(rig_figure, measurement, case))
            for case in measurement.curves.cases
        ],
        workers,
        pictures=pictures,
    )


def _panel(panel: Panel, measurement: Measurement, load_case: str, response: str, side: int) -> None:
    run = measurement.runs[load_case][0]
    case = measurement.curves.cases[load_case]
    if measurement.cars:
        for car in measurement.cars:
            panel.plot(
                case.input, car.curves.cases[load_case].mean[response][side], color=LOOP_COLOUR, lw=0.7
            )
    else:
        samples = _changes(measurement, load_case, response, side)
        panel.plot(run.record.input, samples, color=LOOP_COLOUR, lw=0.7)
    half = case.half_width[response][side]
    mean = case.mean[response][side]
    panel.plot(case.input, mean + half, color=UNLOAD_COLOUR, lw=0.9)
    panel.plot(case.input, mean - half, color=LOAD_COLOUR, lw=0.9)
    if not measurement.cars:
        fit = measurement.trends[load_case][response][side]
        panel.plot(case.input, fit(case.input), dash="--", color=TREND_COLOUR, lw=0.8)


def _changes(measurement: Measurement, load_case: str, response: str, side: int) -> FloatArray:
    """Raw samples of the main run, as change from static where the mean curve is one."""
    run = measurement.runs[load_case][0]
    own = run.mean(response)[side]
    at = int(np.argmin(np.abs(run.input)))
    samples: FloatArray = run.record.channels[response][side]
    return samples if response == "tyre_load" else samples - own[at]


def _gradient(panel: Panel, gradient: Gradient, characteristic: str) -> None:
    """characteristic: what the tables say of it where they take another abscissa, else empty."""
    window = np.array([-gradient.window, gradient.window])
    panel.vspan(window[0], window[1], color=WINDOW_COLOUR, zorder=0)
    panel.plot(window, gradient.intercept + gradient.value * window, color=GRADIENT_COLOUR, lw=1.6)
    scale, unit = _readable(gradient.unit)
    travel = " of pad travel" if gradient.load_case == "vertical" else ""
    words = f"{with_sd(scale * gradient.value, scale * gradient.sd)} {unit}{travel}"
    _note(panel, f"{words}\n{characteristic}" if characteristic else words, GRADIENT_COLOUR)


def _characteristic(measurement: Measurement, load_case: str, response: str) -> str:
    """Value and unit of the left wheel's characteristic that is over another abscissa than the input."""
    same = "pad_travel" if load_case == "vertical" else "input"
    for ident, estimate in measurement.characteristics.items():
        entry = CHARACTERISTICS[ident]
        of_panel = (entry.load_case, entry.response, entry.kind) == (load_case, response, "gradient")
        if of_panel and entry.abscissa not in ("input", same) and np.isfinite(estimate.value):
            return f"{with_sd(estimate.value, estimate.sd)} {entry.unit} {ABSCISSA_WORDS[entry.abscissa]}"
    return ""


def _readable(unit: str) -> tuple[float, str]:
    """Factor and unit that spare small numbers: per m and per kN, rates stay in N/mm."""
    for small, large in (("deg/mm", "deg/m"), ("mm/mm", "mm/m"), ("/N", "/kN")):
        if unit.endswith(small):
            return 1000.0, unit.removesuffix(small) + large
    return 1.0, unit


def _note(panel: Panel, content: str, color: str) -> None:
    """Small text inside the panel's top edge, readable over curves."""
    panel.text(
        0.5,
        0.98,
        content,
        scales=("panel", "panel"),
        size=6.5,
        across="center",
        along="top",
        color=color,
        backing="white",
    )


def _residual(panel: Panel, measurement: Measurement, load_case: str, response: str) -> None:
    if measurement.cars:
        _car_differences(panel, measurement, load_case, response)
        return
    run = measurement.runs[load_case][0]
    for side in (0, 1):
        fit = measurement.trends[load_case][response][side]
        samples = _changes(measurement, load_case, response, side)
        panel.plot(
            run.record.input,
            samples - fit(run.record.input),
            "",
            marker=".",
            ms=1.2,
            color=RESIDUAL_COLOURS[side],
            rasterized=True,
        )
    degrees = ", ".join(str(t.degree) for t in measurement.trends[load_case][response])
    _note(panel, f"trend degree {degrees}", TREND_COLOUR)
    panel.hline(0.0, color=TREND_COLOUR, lw=0.6)
    low, high = panel.y.limits
    panel.y.set_limits(low, high + 0.15 * (high - low))


def _car_differences(panel: Panel, measurement: Measurement, load_case: str, response: str) -> None:
    mean = measurement.curves.cases[load_case]
    for side in (0, 1):
        for car in measurement.cars:
            own = car.curves.cases[load_case].mean[response][side]
            panel.plot(mean.input, own - mean.mean[response][side], color=RESIDUAL_COLOURS[side], lw=0.9)
    panel.hline(0.0, color=TREND_COLOUR, lw=0.6)


def _same_scale(left: Panel, right: Panel, notes: int) -> None:
    """notes: lines of text in the top edge."""
    limits = [*left.y.limits, *right.y.limits]
    # Room for the note in the top edge.
    limits.append(max(limits) + (0.02 + 0.1 * notes) * (max(limits) - min(limits)))
    for panel in (left, right):
        panel.y.set_limits(min(limits), max(limits))


def _legend(runs: int, cars: int) -> list[Line2D | Patch]:
    """Of the mean of several cars without samples and trend."""
    of = f"mean of {cars} cars" if cars else _runs(runs)
    first = "each car" if cars else "main run, samples"
    last, mark, line = ("difference", "", "-") if cars else ("residual", ".", "")
    trend = [] if cars else [Line2D([], [], color=TREND_COLOUR, ls="--", label="polynomial trend")]
    return [
        Line2D([], [], color=LOOP_COLOUR, lw=1, label=first),
        Line2D([], [], color=UNLOAD_COLOUR, label=f"input falling, {of}"),
        Line2D([], [], color=LOAD_COLOUR, label=f"input rising, {of}"),
        *trend,
        Line2D([], [], color=GRADIENT_COLOUR, lw=1.6, label="gradient at static"),
        Patch(color=WINDOW_COLOUR, label="fit window"),
        *(
            Line2D([], [], color=colour, ls=line, marker=mark, label=f"{last} {side}")
            for colour, side in zip(RESIDUAL_COLOURS, ("left", "right"), strict=True)
        ),
    ]


def _runs(runs: int) -> str:
    return "one run" if runs == 1 else f"mean of {runs} runs"
