"""The pictures of a correlation, drawn side by side."""

from __future__ import annotations

from functools import partial
from itertools import groupby
from pathlib import Path

import numpy as np
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from doe_kc.correlation.result import Correlation
from doe_kc.ground.numbers import signed
from doe_kc.ground.picture_format import PNG, PictureFormat
from doe_kc.measurement import Measurement
from doe_kc.reports.axle.point_moves import correlation_view
from doe_kc.reports.axle.views import axle_figure
from doe_kc.reports.correlation.convergence import convergence_figure
from doe_kc.reports.correlation.curves import case_views, curve_figure
from doe_kc.reports.correlation.dna import dna_figure
from doe_kc.reports.correlation.parameters import ParameterRow, parameter_rows
from doe_kc.reports.drawing import style
from doe_kc.reports.drawing.panel import Panel
from doe_kc.reports.drawing.series import Job, draw_series
from doe_kc.reports.drawing.sheet import Sheet, sheet
from doe_kc.reports.hysteresis import hysteresis_figure

SINGLE = 30
"""Variables that stand in one column; more are split over two."""
BAR_ROW = 0.2
SEEN, UNSEEN, BOUND = style.PALETTE["blue"], "#B9BEC3", style.PALETTE["vermillion"]


def parameter_figure(correlation: Correlation, study: str) -> Sheet:
    """Bar from baseline to final between lower and upper bound, whisker ± sd of the final value; beside it
    the change."""
    rows = [r for r in parameter_rows(correlation) if r.role == "variable"]
    parts = _columns(_lines(rows))
    columns, deep = len(parts), max(map(len, parts))
    height = BAR_ROW * deep + 1.6
    margins = {
        "left": 0.105 if columns == 2 else 0.2,
        "right": 0.845 if columns == 2 else 0.82,
        "wspace": 1.1,
    }
    margins |= {"top": 1 - 0.72 / height, "bottom": 0.85 / height}
    page, panels = sheet(1, columns, size=(8.27, height), margins=margins)
    for panel, part in zip(panels[0], parts, strict=True):
        _column(panel, part, deep)
    _legend(page, correlation.posterior is not None)
    page.set_heading(f"Parameter changes: {study}", 1 - 0.15 / height)
    page.write(
        0.5, 1 - 0.42 / height, "numbers: final minus baseline, ± standard deviation", 7.5, "center", "top",
        color="#555555",
    )  # fmt: skip
    return page


def _lines(rows: list[ParameterRow]) -> list[ParameterRow | str]:
    out: list[ParameterRow | str] = []
    for group, members in groupby(rows, key=lambda r: r.group):
        out += [group, *members]
    return out


def _columns(lines: list[ParameterRow | str]) -> list[list[ParameterRow | str]]:
    """One column or two; a group that goes on in the second one is named there again."""
    if len(lines) <= SINGLE:
        return [lines]
    deep = -(-len(lines) // 2)
    first, second = lines[:deep], lines[deep:]
    if isinstance(first[-1], str):
        return [first[:-1], [first[-1], *second]]
    top = second[0]
    return [first, second if isinstance(top, str) else [top.group, *second]]


def _column(panel: Panel, lines: list[ParameterRow | str], deep: int) -> None:
    panel.x.set_limits(-0.02, 1.02)
    panel.y.set_limits(deep, 0)
    panel.x.set_ticks([0.0, 0.5, 1.0], ["lower", "middle", "upper"])
    panel.y.set_ticks([], [])
    panel.spines["left"] = False
    panel.set_labels("place between the bounds", None)
    for y, line in enumerate(lines):
        if isinstance(line, str):
            panel.text(
                -0.04, y + 0.55, line.capitalize(), size=7.2, weight="bold", across="right", along="center"
            )
        else:
            _bar(panel, y + 0.5, line)


def _bar(panel: Panel, y: float, row: ParameterRow) -> None:
    panel.bars(y, 0.0, 1.0, 0.6, ["#F1F3F4"], zorder=0)
    hidden = row.visible is False
    colour = UNSEEN if hidden else SEEN
    low, high = sorted((row.start, row.place))
    panel.bars(
        y, low, high, 0.52, ["white" if hidden else colour], edgecolors=colour, linewidths=0.5,
        hatch="/////" if hidden else None, zorder=2,
    )  # fmt: skip
    if np.isfinite(row.spread):
        ends = np.clip([row.place - row.spread, row.place + row.spread], 0, 1)
        panel.plot(ends, [y, y], color="#444444", lw=0.7, zorder=3)
    panel.plot([row.start, row.start], [y - 0.36, y + 0.36], color="black", lw=0.8, zorder=3)
    panel.plot(row.place, y, "", marker="o", color=colour, ms=2.8, zorder=4)
    if row.at_bound:
        mark = ">" if row.at_bound == "upper" else "<"
        panel.plot(row.place, y, "", marker=mark, color=BOUND, ms=5.5, clip=False, zorder=5)
    _texts(panel, y, row, "#777777" if hidden else "black")


def _texts(panel: Panel, y: float, row: ParameterRow, colour: str) -> None:
    panel.text(-0.04, y, row.path, size=6.2, across="right", along="center", color=colour)
    unit = "" if row.unit == "-" else f" {row.unit}"
    words = f"{signed(row.change, row.sd)}{unit}"
    panel.text(1.05, y, words, size=6.2, along="center", color=colour)


def _legend(page: Sheet, known: bool) -> None:
    handles: list[Line2D | Patch] = [
        Line2D([], [], color="black", ls="", marker="|", ms=7, label="baseline"),
        Line2D([], [], color=SEEN, ls="", marker="o", ms=3.5, label="final"),
        Line2D([], [], color=BOUND, ls="", marker=">", ms=5.5, label="at its bound"),
    ]
    if known:
        handles += [
            Line2D([], [], color="#444444", lw=0.8, label="± standard deviation"),
            Patch(fc="white", ec=UNSEEN, hatch="/////", label="not visible in these measurements"),
        ]
    page.add_legend(handles, 5)


def write_correlation_figures(
    correlation: Correlation,
    measurement: Measurement | None,
    folder: Path,
    *,
    study: str,
    workers: int | None = None,
    pictures: PictureFormat = PNG,
) -> list[Path]:
    """Pictures `correlation_dna`, `_parameters`, `_axle`, `_convergence`, one `curves_<load case>` each and,
    with records, `hysteresis`.

    Raises RunError when the folder cannot be written.
    """
    jobs: list[Job] = [
        (folder / "correlation_dna", partial(dna_figure, correlation, study)),
        (folder / "correlation_parameters", partial(parameter_figure, correlation, study)),
        (folder / "correlation_axle", partial(axle_figure, correlation_view(correlation, study))),
        (folder / "correlation_convergence", partial(convergence_figure, correlation, study)),
    ]
    views = case_views(correlation, measurement)
    jobs += [(folder / f"curves_{view.load_case}", partial(curve_figure, view, study)) for view in views]
    measured = [view for view in views if view.measured is not None]
    if measured:
        jobs.append((folder / "hysteresis", partial(hysteresis_figure, measured, study)))
    return draw_series(jobs, workers, pictures=pictures)
