"""Measured, baseline and final curves of every load case (thesis, Appendix E)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from doe_kc.correlation.result import Correlation
from doe_kc.curves import RESPONSE_LABELS, RIG_RESPONSES, CaseCurves
from doe_kc.ground.typing import FloatArray
from doe_kc.load_cases import CASE_ORDER, case_label
from doe_kc.measurement import Measurement
from doe_kc.reports.drawing import style
from doe_kc.reports.drawing.panel import Dash, Panel
from doe_kc.reports.drawing.panel_axis import ticks
from doe_kc.reports.drawing.sheet import Sheet, sheet
from doe_kc.reports.names import input_label, response_axis, without_remark
from doe_kc.targets.comparison import same_input

BAND_SDS = 2.0
"""Standard deviations of the measured mean curve that its band shows."""
MEASURED_COLOUR = style.PALETTE["black"]
CURVES_MARGINS = {
    "left": 0.058,
    "right": 0.988,
    "top": 0.89,
    "bottom": 0.075,
    "wspace": 0.34,
    "hspace": 0.28,
}
CURVES_ACROSS = 4


@dataclass(frozen=True)
class CaseView:
    """One load case; None or empty for what there is not. sd, half_width_sd: response -> (2, n) of the
    measured mean and half-width curves."""

    load_case: str
    measured: CaseCurves | None
    baseline: CaseCurves | None
    final: CaseCurves | None
    sd: Mapping[str, FloatArray]
    half_width_sd: Mapping[str, FloatArray] = field(default_factory=dict)

    @property
    def any(self) -> CaseCurves:
        """One of the curves, for input and unit."""
        return next(c for c in (self.final, self.measured, self.baseline) if c is not None)

    @property
    def input_label(self) -> str:
        """Name and unit of the input."""
        return input_label(self.load_case, self.any.input_unit)


def case_views(correlation: Correlation, measurement: Measurement | None) -> list[CaseView]:
    """Every load case that model or rig has; measured curves over another input are left out."""
    ours = [
        e.outcome.curves.cases if e.outcome.curves else {} for e in (correlation.baseline, correlation.best)
    ]
    rig = measurement.curves.cases if measurement is not None else {}
    views = []
    for case in CASE_ORDER:
        before, after = (c.get(case) for c in ours)
        measured = rig.get(case)
        if measured is not None and after is not None and not same_input(after, measured):
            measured = None
        if any(c is not None for c in (before, after, measured)):
            known = measurement if measured is not None else None
            sd = known.curve_sd(case) if known is not None else {}
            half = half_width_sd(known, case) if known is not None else {}
            views.append(CaseView(case, measured, before, after, sd, half))
    return views


def half_width_sd(measurement: Measurement, load_case: str) -> dict[str, FloatArray]:
    """Response -> (2, n) standard deviations of its half-width curves, left and right, in its unit."""
    return {
        name: np.array([np.sqrt(np.diag(model.half_width_covariance(side=s))) for s in (0, 1)])
        for name, model in measurement.noise.get(load_case, {}).items()
    }


def has_loop(case: CaseCurves, response: str) -> bool:
    """Whether the branches of a model differ, as with friction."""
    return bool(np.any(case.half_width[response]))


def curve_figure(view: CaseView, study: str) -> Sheet:
    """All responses of both wheels over the input; angles and wheel centre are changes from static."""
    page, panels = sheet(2, CURVES_ACROSS, size=style.A4_LANDSCAPE, share_x=False, margins=CURVES_MARGINS)
    for panel, response in zip(panels.flat, RIG_RESPONSES, strict=False):
        _panel(panel, view, response)
        panel.set_labels(without_remark(view.input_label), response_axis(response))
        panel.set_title(RESPONSE_LABELS[response])
        panel.x.set_locator(ticks(5))
        panel.y.set_locator(ticks(7))
    legend = page.panels.pop().box
    page.add_legend(_handles(view), 1, 7.5, ("left", "top"), (legend.left - 10.0, legend.top))
    page.set_heading(f"{case_label(view.load_case)}: {study}", 0.965)
    return page


def _panel(panel: Panel, view: CaseView, response: str) -> None:
    for side in (1, 0):
        if view.measured is not None:
            _measured(panel, view, response, side)
        models: list[tuple[CaseCurves | None, str, Dash]]
        models = [(view.baseline, style.BASELINE_COLOUR, "--"), (view.final, style.FINAL_COLOUR, "-")]
        for case, colour, dash in models:
            if case is None or response not in case.mean:
                continue
            mean, half = case.mean[response][side], case.half_width[response][side]
            panel.plot(case.input, mean, dash, color=colour, **_weight(side))
            if has_loop(case, response):
                for sign in (-1, 1):
                    panel.plot(
                        case.input, mean + sign * half, ":", color=colour, lw=0.6 if side else 0.9, zorder=3
                    )


def _weight(side: int) -> dict[str, Any]:
    """The right wheel stands back."""
    return {"lw": 0.8, "alpha": 0.55} if side else {"lw": 1.5, "alpha": 1.0}


def _measured(panel: Panel, view: CaseView, response: str, side: int) -> None:
    case = view.measured
    if case is None or response not in case.mean:
        return
    mean, half = case.mean[response][side], case.half_width[response][side]
    sd = view.sd.get(response, np.zeros((2, mean.size)))[side]
    face = "none" if side else MEASURED_COLOUR
    panel.fill_between(
        case.input, mean - BAND_SDS * sd, mean + BAND_SDS * sd, color="#BBBBBB", alpha=0.7, lw=0, zorder=0
    )
    for sign in (-1, 1):
        panel.plot(case.input, mean + sign * half, color=style.PALETTE["grey"], lw=0.4 if side else 0.7)
    step = max(1, mean.size // 20)
    panel.plot(
        case.input[::step], mean[::step], "", marker="o", color=MEASURED_COLOUR, mfc=face, ms=2.6, mew=0.5
    )


def _handles(view: CaseView) -> list[Line2D | Patch]:
    dots: dict[str, Any] = {"color": MEASURED_COLOUR, "ls": "", "marker": "o", "ms": 3}
    out: list[Line2D | Patch] = []
    if view.measured is not None:
        out += [
            Line2D([], [], **dots, label="measured mean, left wheel"),
            Line2D([], [], **dots, mfc="none", label="measured mean, right wheel"),
            Line2D(
                [], [], color=style.PALETTE["grey"], lw=0.7, label="its branches, input rising and falling"
            ),
            Patch(color="#BBBBBB", label=f"its ±{BAND_SDS:g} sd"),
        ]
    for case, colour, dash, name in (
        (view.baseline, style.BASELINE_COLOUR, "--", "baseline"),
        (view.final, style.FINAL_COLOUR, "-", "final"),
    ):
        if case is not None:
            out += [
                Line2D([], [], color=colour, ls=dash, lw=1.5, label=f"{name}, left wheel"),
                Line2D([], [], color=colour, ls=dash, lw=0.8, alpha=0.55, label=f"{name}, right wheel"),
            ]
            if any(has_loop(case, response) for response in case.half_width):
                words = "   its branches, with friction"
                out.append(Line2D([], [], color=colour, ls=":", lw=0.9, label=words))
    return out
