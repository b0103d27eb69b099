"""The band of the cars' curves, one sheet a load case, with the measured cars drawn in."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from doe_kc.curves import SIDE_WORDS, SIDES
from doe_kc.ground.typing import FloatArray
from doe_kc.load_cases import case_label
from doe_kc.production_scatter.bands import CurveBand
from doe_kc.production_scatter.result import MeasuredCar
from doe_kc.reports.drawing.panel import Panel
from doe_kc.reports.drawing.panel_axis import ticks
from doe_kc.reports.drawing.sheet import Sheet, sheet
from doe_kc.reports.drawing.style import A4, PALETTE
from doe_kc.reports.names import input_label, response_axis, without_remark

BAND_MARGINS = {"left": 0.1, "right": 0.985, "top": 0.935, "bottom": 0.085, "wspace": 0.38, "hspace": 0.13}
BAND_FILLS = ("#CFE6F5", "#8FC4E8")
"""Of 95 % and of half of the cars."""


def band_sheet(
    band: CurveBand, cars: Sequence[MeasuredCar], looks: Sequence[Line2D | Patch], *, study: str
) -> Sheet:
    """A row a response: the left wheel's curve, and both wheels' distance from the unchanged axle, where a
    band too narrow beside the curve is seen. looks: of the cars, in their order."""
    present = list(band.percentiles)
    page, panels = sheet(len(present), 3, size=A4, width_ratios=(1.0, 1.0, 1.0), margins=BAND_MARGINS)
    colors = [str(look.get_color()) for look in looks if isinstance(look, Line2D)]
    for row, response in zip(panels, present, strict=True):
        _curves(row[0], band, cars, colors, response)
        for side in (0, 1):
            _deviations(row[1 + side], band, cars, colors, response, side)
        low = min(p.y.limits[0] for p in row[1:])
        high = max(p.y.limits[1] for p in row[1:])
        for panel in row[1:]:
            panel.y.set_limits(low, high)
        row[0].set_labels(None, response_axis(response))
    for panel in panels.flat:
        panel.y.set_locator(ticks(5))
    for panel in panels[-1]:
        panel.set_labels(without_remark(input_label(band.load_case, band.input_unit)), None)
    panels[0][0].set_title("Left")
    for side in (0, 1):
        panels[0][1 + side].set_title(f"{SIDE_WORDS[SIDES[side]].capitalize()}, minus unchanged")
    page.set_heading(f"{case_label(band.load_case)}, curves of the cars: {study}", 0.985)
    handles: list[Line2D | Patch] = [
        Patch(color=BAND_FILLS[0], label="95 % of the cars"),
        Patch(color=BAND_FILLS[1], label="half of the cars"),
        Line2D([], [], color=PALETTE["black"], lw=1.0, label="unchanged axle"),
        *looks,
    ]
    page.add_legend(handles, 4, 7.5)
    return page


def _curves(
    panel: Panel, band: CurveBand, cars: Sequence[MeasuredCar], colors: Sequence[str], response: str
) -> None:
    nominal = band.nominal[response][0]
    _fill(panel, band.input, band.percentiles[response][:, 0])
    panel.plot(band.input, nominal, color=PALETTE["black"], lw=0.9)
    for car, color in zip(cars, colors, strict=True):
        measured = _measured(band, car, response)
        if measured is not None:
            panel.plot(measured[0], measured[1][0], color=color, lw=1.0)


def _deviations(
    panel: Panel,
    band: CurveBand,
    cars: Sequence[MeasuredCar],
    colors: Sequence[str],
    response: str,
    side: int,
) -> None:
    nominal = band.nominal[response][side]
    _fill(panel, band.input, band.percentiles[response][:, side] - nominal)
    panel.hline(0.0, color=PALETTE["black"], lw=0.9)
    for car, color in zip(cars, colors, strict=True):
        measured = _measured(band, car, response)
        if measured is not None:
            own = np.interp(measured[0], band.input, nominal)
            panel.plot(measured[0], measured[1][side] - own, color=color, lw=1.0)


def _fill(panel: Panel, x: FloatArray, percentiles: FloatArray) -> None:
    look: dict[str, Any] = {"zorder": 0.8}
    panel.fill_between(x, percentiles[0], percentiles[-1], color=BAND_FILLS[0], **look)
    panel.fill_between(x, percentiles[1], percentiles[-2], color=BAND_FILLS[1], **{"zorder": 0.9})


def _measured(band: CurveBand, car: MeasuredCar, response: str) -> tuple[FloatArray, FloatArray] | None:
    """Input and (2, n) curve within the reach of the band; None where the car has none."""
    case = car.curves.cases.get(band.load_case)
    if case is None or response not in case.mean or case.input_unit != band.input_unit:
        return None
    reach = (case.input >= band.input[0]) & (case.input <= band.input[-1])
    return case.input[reach], np.asarray(case.mean[response])[:, reach]
