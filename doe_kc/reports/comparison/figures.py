"""Model against measurement, one figure a load case."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from doe_kc.curves import RESPONSE_LABELS, RESPONSE_NAMES, RESPONSE_UNITS, RIG_RESPONSES, SIDES, response_name
from doe_kc.ground.picture_format import PNG, PictureFormat
from doe_kc.load_cases import LOAD_CASES
from doe_kc.reports.drawing import style
from doe_kc.reports.drawing.panel import Dash, PageBox, Panel
from doe_kc.reports.drawing.panel_axis import ticks
from doe_kc.reports.drawing.series import draw_series
from doe_kc.reports.drawing.sheet import Sheet, sheet
from doe_kc.reports.names import input_label, response_axis
from doe_kc.targets.comparison import Comparison, same_input

SIDE_COLOURS = (style.PALETTE["blue"], style.PALETTE["vermillion"])
SIDE_NAMES = ("left", "right")
SIDE_DASHES: tuple[Dash, Dash] = ("-", "--")
MODEL_WIDTHS = (1.5, 1.1)
LOOP_WIDTH = 0.5
NOISE_BAND = 2.0
"""Standard deviations of the measured mean curve that its band shows."""
COMPARISON_MARGINS = {
    "left": 0.06,
    "right": 0.988,
    "top": 0.92,
    "bottom": 0.062,
    "wspace": 0.27,
    "hspace": 0.36,
}


def comparison_figure(comparison: Comparison, load_case: str) -> Sheet:
    """Responses of both wheels over the input: measured (dots, branches, noise), model (lines).

    Angles and wheel centre are changes from static.
    """
    measured = comparison.measured.cases[load_case]
    case = LOAD_CASES[load_case]
    page, panels = sheet(3, 3, size=style.A4_LANDSCAPE, share_x=False, margins=COMPARISON_MARGINS)
    present = [r for r in RIG_RESPONSES if r in measured.mean]
    for panel, response in zip(panels.flat, present, strict=False):
        _draw(panel, comparison, load_case, response)
        panel.set_labels(input_label(load_case, measured.input_unit), response_axis(response))
        panel.set_title(RESPONSE_LABELS[response])
        panel.x.set_locator(ticks(5))
        panel.y.set_locator(ticks(7))
    table, legend = page.panels[7:]
    del page.panels[len(present) :]
    _table(page, table.box, comparison, load_case)
    page.add_legend(
        _handles(comparison, load_case), 1, 7.5, ("left", "top"), (legend.box.left, legend.box.top)
    )
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


def _draw(panel: Panel, comparison: Comparison, load_case: str, response: str) -> None:
    """Right over left, so that both are seen where they coincide: the right wheel is drawn finer."""
    model, measured = comparison.model.cases[load_case], comparison.measured.cases[load_case]
    sd = comparison.curve_sd.get(load_case, {}).get(response)
    for side, colour in enumerate(SIDE_COLOURS):
        mean, half = measured.mean[response][side], measured.half_width[response][side]
        look: dict[str, Any] = {"color": colour, "lw": LOOP_WIDTH, "alpha": 0.6}
        for sign in (-1, 1):
            panel.plot(measured.input, mean + sign * half, **look)
        if sd is not None:
            band = NOISE_BAND * sd[side]
            panel.fill_between(measured.input, mean - band, mean + band, color=colour, alpha=0.18, zorder=0)
        face = "none" if side else colour
        panel.plot(measured.input[::2], mean[::2], "", marker="o", color=colour, mfc=face, mew=0.6, ms=2.4)
        line: dict[str, Any] = {"color": colour, "lw": MODEL_WIDTHS[side], "zorder": 3 + side}
        panel.plot(model.input, model.mean[response][side], SIDE_DASHES[side], **line)
        loop = np.abs(model.half_width[response][side])
        if loop.max() > 0:
            for sign in (-1, 1):
                panel.plot(model.input, model.mean[response][side] + sign * loop, ":", color=colour, lw=0.8)


def _handles(comparison: Comparison, load_case: str) -> list[Line2D | Patch]:
    out: list[Line2D | Patch] = []
    loops = any(np.any(half) for half in comparison.model.cases[load_case].half_width.values())
    for side, (colour, name) in enumerate(zip(SIDE_COLOURS, SIDE_NAMES, strict=True)):
        dots: dict[str, Any] = {"ls": "", "marker": "o", "ms": 3.5, "mfc": "none" if side else colour}
        out += [
            Line2D([], [], color=colour, label=f"measured, {name} wheel (mean of branches)", **dots),
            Line2D([], [], color=colour, lw=LOOP_WIDTH, alpha=0.6, label="   its branches"),
        ]
        if comparison.curve_sd:
            out.append(Patch(color=colour, alpha=0.18, lw=0, label=f"   ± {NOISE_BAND:g} sd of its noise"))
        model = f"model, {name} wheel"
        out.append(Line2D([], [], color=colour, ls=SIDE_DASHES[side], lw=MODEL_WIDTHS[side], label=model))
        if loops:
            out.append(Line2D([], [], color=colour, ls=":", lw=0.8, label="   its branches, with friction"))
    return out


def _table(page: Sheet, box: PageBox, comparison: Comparison, load_case: str) -> None:
    """Characteristics of the load case, which are the left wheel's, and the RMS of the curves of both."""
    rows = [r for r in comparison.characteristics if r.entry.load_case == load_case]
    gradients = {f"{r.entry.label} [{r.entry.unit}]": r for r in rows if r.entry.kind == "gradient"}
    wide = max(map(len, (*gradients, *RESPONSE_NAMES.values()))) + 7
    lines = [f"{'Left wheel':<{wide}}{'model':>10}{'target':>10}"]
    for name, row in gradients.items():
        mark = "" if row.inside else " *"
        lines.append(f"{name:<{wide}}{row.value:>10.4g}{row.target:>10.4g}{mark}")
    if any(not row.inside for row in gradients.values()):
        lines.append("* outside the interval of equations 5.1 and 5.2")
    lines += ["", f"{'RMS, model minus measured':<{wide}}{'left':>10}{'right':>10}"]
    rms = {(c.response, c.side): c.rms for c in comparison.curves if c.load_case == load_case}
    for response in [r for r in RIG_RESPONSES if (r, "L") in rms]:
        name = f"{response_name(response)} [{RESPONSE_UNITS[response]}]"
        lines.append(f"{name:<{wide}}" + "".join(f"{rms[response, side]:>10.3g}" for side in SIDES))
    words = "\n".join(lines)
    page.write(box.left / page.width, box.top / page.height, words, 6.0, along="top", family="monospace")
