"""Model against measurement, one figure a load case."""

from __future__ import annotations

from functools import partial
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from doe_kc.comparison.compare import Comparison, same_input
from doe_kc.curves import RESPONSE_LABELS, RESPONSE_UNITS, RIG_RESPONSES, CaseCurves
from doe_kc.pictures import PNG, PictureFormat
from doe_kc.reporting import style
from doe_kc.reporting.names import RESPONSE_NAMES, input_label, response_axis, response_name
from doe_kc.reporting.plain_axes import draw_plain_axes
from doe_kc.reporting.series import draw_series
from doe_kc.solver.load_cases import LOAD_CASES

SIDE_COLOURS = (style.PALETTE["blue"], style.PALETTE["vermillion"])
SIDE_NAMES = ("left", "right")
MARGINS = {"left": 0.06, "right": 0.988, "top": 0.92, "bottom": 0.062, "wspace": 0.27, "hspace": 0.36}


def comparison_figure(comparison: Comparison, load_case: str) -> Figure:
    """Responses of both wheels over the input: measured (dots, band = both branches), model (lines).

    Angles and wheel centre are changes from static.
    """
    model = comparison.model.cases[load_case]
    measured = comparison.measured.cases[load_case]
    case = LOAD_CASES[load_case]
    fig, axes = style.figure(3, 3, size=style.A4_LANDSCAPE, share_x=False, margins=MARGINS)
    panels = list(axes.flat)
    for ax, response in zip(panels, RIG_RESPONSES, strict=False):
        _draw(ax, model, measured, response)
        style.label(ax, None, response_axis(response))
        ax.set_title(RESPONSE_LABELS[response], fontsize=9, y=1.0)
        ax.xaxis.set_major_locator(style.ticks(5))
        ax.yaxis.set_major_locator(style.ticks(7))
        ax.set_xlabel(input_label(load_case, measured.input_unit))
    _table(panels[7], comparison, load_case)
    _legend(panels[8])
    fig.suptitle(
        f"{case.label}: {comparison.model.source} against {comparison.measured.source}",
        fontsize=11,
        y=0.985,
        parse_math=False,
    )
    draw_plain_axes(fig)
    return fig


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


def _draw(ax: Axes, model: CaseCurves, measured: CaseCurves, response: str) -> None:
    for side, colour in enumerate(SIDE_COLOURS):
        mean, half = measured.mean[response][side], np.abs(measured.half_width[response][side])
        ax.fill_between(measured.input, mean - half, mean + half, color=colour, alpha=0.2, lw=0)
        ax.plot(measured.input[::2], mean[::2], ".", color=colour, ms=3)
        ax.plot(model.input, model.mean[response][side], color=colour)
        loop = np.abs(model.half_width[response][side])
        if loop.max() > 0:
            for sign in (-1, 1):
                ax.plot(model.input, model.mean[response][side] + sign * loop, ":", color=colour, lw=0.8)


def _legend(ax: Axes) -> None:
    ax.axis("off")
    for side, colour in enumerate(SIDE_COLOURS):
        ax.plot([], [], ".", color=colour, label=f"measured, {SIDE_NAMES[side]} wheel (mean of branches)")
        ax.fill_between([], [], [], color=colour, alpha=0.2, lw=0, label="   between its branches")
        ax.plot([], [], color=colour, label=f"model, {SIDE_NAMES[side]} wheel")
    ax.legend(loc="upper left", fontsize=8)


def _table(ax: Axes, comparison: Comparison, load_case: str) -> None:
    """Characteristics of the load case, and the RMS of its curves on the left wheel."""
    ax.axis("off")
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
    ax.text(0, 1, "\n".join(lines), family="monospace", fontsize=6, va="top", transform=ax.transAxes)
