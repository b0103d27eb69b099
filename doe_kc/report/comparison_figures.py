"""Model against measurement, one figure a load case."""

from __future__ import annotations

from functools import partial
from pathlib import Path

import numpy as np
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from doe_kc.curves import RESPONSE_LABELS, RESPONSE_UNITS, RIG_RESPONSES, CaseCurves
from doe_kc.ground.picture_format import PNG, PictureFormat
from doe_kc.load_cases import LOAD_CASES
from doe_kc.report import style
from doe_kc.report.names import RESPONSE_NAMES, input_label, response_axis, response_name
from doe_kc.report.panel import PageBox, Panel
from doe_kc.report.panel_axis import ticks
from doe_kc.report.series import draw_series
from doe_kc.report.sheet import Sheet, sheet
from doe_kc.targets.comparison.compare import Comparison, same_input

SIDE_COLOURS = (style.PALETTE["blue"], style.PALETTE["vermillion"])
SIDE_NAMES = ("left", "right")
COMPARISON_MARGINS = {
    "left": 0.06,
    "right": 0.988,
    "top": 0.92,
    "bottom": 0.062,
    "wspace": 0.27,
    "hspace": 0.36,
}


def comparison_figure(comparison: Comparison, load_case: str) -> Sheet:
    """Responses of both wheels over the input: measured (dots, band = both branches), model (lines).

    Angles and wheel centre are changes from static.
    """
    model = comparison.model.cases[load_case]
    measured = comparison.measured.cases[load_case]
    case = LOAD_CASES[load_case]
    page, panels = sheet(3, 3, size=style.A4_LANDSCAPE, share_x=False, margins=COMPARISON_MARGINS)
    for panel, response in zip(panels.flat, RIG_RESPONSES, strict=False):
        _draw(panel, model, measured, response)
        panel.set_labels(input_label(load_case, measured.input_unit), response_axis(response))
        panel.set_title(RESPONSE_LABELS[response])
        panel.x.set_locator(ticks(5))
        panel.y.set_locator(ticks(7))
    table, legend = page.panels[7:]
    del page.panels[7:]
    _table(page, table.box, comparison, load_case)
    page.add_legend(_handles(), 1, 8.0, ("left", "top"), (legend.box.left, legend.box.top))
    page.set_heading(f"{case.label}: {comparison.model.source} against {comparison.measured.source}", 0.985)
    return page


def write_comparison_figures(
    comparison: Comparison, folder: Path, *, workers: int | None = None, pictures: PictureFormat = PNG
) -> list[Path]:
    """A picture of every load case that both have; returns the paths. Raises RunError as `style.save`."""
    return draw_series(
        [
            (folder / f"compare_{case}", partial(comparison_figure, comparison, case))
            for case, measured in comparison.measured.cases.items()
            if case in comparison.model.cases and same_input(comparison.model.cases[case], measured)
        ],
        workers,
        pictures=pictures,
    )


def _draw(panel: Panel, model: CaseCurves, measured: CaseCurves, response: str) -> None:
    for side, colour in enumerate(SIDE_COLOURS):
        mean, half = measured.mean[response][side], np.abs(measured.half_width[response][side])
        panel.fill_between(measured.input, mean - half, mean + half, color=colour, alpha=0.2, lw=0)
        panel.plot(measured.input[::2], mean[::2], "", marker=".", color=colour, ms=3)
        panel.plot(model.input, model.mean[response][side], color=colour)
        loop = np.abs(model.half_width[response][side])
        if loop.max() > 0:
            for sign in (-1, 1):
                panel.plot(model.input, model.mean[response][side] + sign * loop, ":", color=colour, lw=0.8)


def _handles() -> list[Line2D | Patch]:
    out: list[Line2D | Patch] = []
    for colour, name in zip(SIDE_COLOURS, SIDE_NAMES, strict=True):
        dots = f"measured, {name} wheel (mean of branches)"
        out += [
            Line2D([], [], ls="", marker=".", color=colour, label=dots),
            Patch(color=colour, alpha=0.2, lw=0, label="   between its branches"),
            Line2D([], [], color=colour, lw=1.5, label=f"model, {name} wheel"),
        ]
    return out


def _table(page: Sheet, box: PageBox, comparison: Comparison, load_case: str) -> None:
    """Characteristics of the load case, and the RMS of its curves on the left wheel."""
    rows = [r for r in comparison.characteristics if r.entry.load_case == load_case]
    gradients = {f"{r.entry.label} [{r.entry.unit}]": r for r in rows if r.entry.kind == "gradient"}
    wide = max(map(len, (*gradients, *RESPONSE_NAMES.values()))) + 1
    lines = [f"{'Left wheel':<{wide}}{'model':>10}{'target':>10}"]
    for name, row in gradients.items():
        mark = "" if row.inside else " *"
        lines.append(f"{name:<{wide}}{row.value:>10.4g}{row.target:>10.4g}{mark}")
    lines += ["", "RMS of curve"]
    for curve in comparison.curves:
        if curve.load_case == load_case and curve.side == "L":
            unit = RESPONSE_UNITS[curve.response]
            lines.append(f"{response_name(curve.response):<{wide}}{curve.rms:>10.3g} {unit}")
    lines.append("* outside the constraint interval")
    page.write(
        box.left / page.width, box.top / page.height, "\n".join(lines), 6.0, along="top", family="monospace"
    )
