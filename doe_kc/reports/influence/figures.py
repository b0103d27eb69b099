"""Pictures of an influence study: the whole matrix as a heat map, and the ten strongest of each column."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
from itertools import groupby
from pathlib import Path

import numpy as np
from matplotlib.collections import QuadMesh
from matplotlib.colors import Colormap, LinearSegmentedColormap

from doe_kc.characteristics import Characteristic
from doe_kc.ground.picture_format import PNG, PictureFormat
from doe_kc.ground.typing import FloatArray
from doe_kc.load_cases import case_label
from doe_kc.parameter_influence.global_sensitivity import GlobalSensitivity
from doe_kc.parameter_influence.study import Influence
from doe_kc.reports.drawing.color_scale import STRIPS, draw_color_scale
from doe_kc.reports.drawing.panel import PageBox, Panel
from doe_kc.reports.drawing.series import Job, draw_series
from doe_kc.reports.drawing.sheet import Sheet, sheet
from doe_kc.reports.drawing.style import PALETTE
from doe_kc.reports.drawing.words import POINTS, text_width
from doe_kc.reports.influence.global_figures import global_bars
from doe_kc.reports.influence.layout import Layout, group_steps, layout, step_text
from doe_kc.reports.table import NEGATIVE_FILL, NEUTRAL_FILL, POSITIVE_FILL

ANNOTATE = 5.0
"""Percent from which a cell shows its number."""
STRONGEST_COUNT = 10
INFLUENCE_PANELS = 3
"""Columns of small multiples."""
CELL_HEIGHT, CELL_WIDTH = 0.165, 0.36
"""Inches of a cell of the heat map."""
LINE_COLOUR = PALETTE["black"]
INFLUENCE_GAP = 6.0
"""Points between the heat map and what is beside it."""
INFLUENCE_HEAD = 0.9 * POINTS
"""Of the heat map: the title of the page, how to read it and the names of the load cases."""
INFLUENCE_KEY = (0.18 * POINTS, 48.0)
"""Width of the colour scale, and of its numbers and name, points."""


def diverging() -> Colormap:
    """Blue, white, orange: the colours of the workbook."""
    colors = [f"#{c}" for c in (NEGATIVE_FILL, NEUTRAL_FILL, POSITIVE_FILL)]
    return LinearSegmentedColormap.from_list("influence", colors)


def influence_heat_map(influence: Influence, *, study: str) -> Sheet:
    """Percent of each column's largest entry, colours fixed at -100 to 100, numbers from 5 % on."""
    at = layout(influence)
    values = np.where(np.isfinite(influence.absolute), influence.percent, np.nan)
    values = values[np.ix_(at.rows, at.columns)]
    size = (max(8.0, 3.2 + CELL_WIDTH * len(at.columns)), max(5.0, 3.0 + CELL_HEIGHT * len(at.rows)))
    columns = [_name(influence.characteristics[j]) for j in at.columns]
    usual = group_steps(influence)
    rows = [_row_name(influence, i, usual) for i in at.rows]
    page = Sheet(size)
    left = max(text_width(name, 7.0) for name in rows) + 2.0 * INFLUENCE_GAP
    bottom = max(text_width(name, 7.0) for name in columns) + 2.0 * INFLUENCE_GAP
    wide, tall = (
        page.width - left - 2.0 * INFLUENCE_GAP - sum(INFLUENCE_KEY),
        page.height - bottom - INFLUENCE_HEAD,
    )
    panel = page.add_panel(PageBox(left, bottom, wide, tall))
    _matrix(panel, values)
    panel.x.set_ticks(np.arange(len(columns)) + 0.5, columns)
    panel.y.set_ticks(np.arange(len(rows)) + 0.5, rows)
    panel.number_angle["x"] = 90.0
    _case_names(panel, influence, at)
    _lines(panel, influence, at)
    _scale(
        page.add_panel(
            PageBox(left + wide + INFLUENCE_GAP, bottom + 0.3 * tall, INFLUENCE_KEY[0], 0.4 * tall)
        )
    )
    page.set_heading(
        f"Parameter influence, percent of each column's largest entry: {study}", 1 - 5 / page.height
    )
    page.write(
        0.5, 1 - 22 / page.height, _reading(usual), 7.0, "center", "top", color="#555555",
    )  # fmt: skip
    return page


def _row_name(influence: Influence, i: int, usual: Mapping[str, str]) -> str:
    """Path, with its step where that is not the usual one of its group."""
    parameter, step = influence.parameters[i], step_text(influence, i)
    return parameter.path if usual.get(parameter.group) == step else f"{parameter.path} ({step})"


def _reading(usual: Mapping[str, str]) -> str:
    """How large the steps are, and what a blank means."""
    steps = ", ".join(f"{group.lower()} {words}" for group, words in usual.items())
    return (
        f"One parameter at a time, raised and lowered by its step: {f'{steps}, ' if steps else ''}"
        f"others as beside their name.\nBlank: below {ANNOTATE:g} %. Grey: no equilibrium with the step."
    )


def _matrix(panel: Panel, values: FloatArray) -> None:
    """Fixed colours, and numbers from 5 % on; nan is grey."""
    rows, columns = values.shape
    edges = np.stack(np.meshgrid(np.arange(columns + 1), np.arange(rows + 1)), axis=-1)
    mesh = QuadMesh(
        edges, array=np.ma.masked_invalid(values), cmap=diverging(), linewidths=0.3, edgecolors="#E3E6E9"
    )
    mesh.set_clim(-100.0, 100.0)
    panel.add(mesh)
    panel.x.set_limits(0.0, columns)
    panel.y.set_limits(rows, 0.0)
    panel.background = "#D9DCDF"
    for parts in (panel.spines, panel.grid, panel.marks):
        parts.update(dict.fromkeys(parts, False))
    for i, j in np.argwhere(np.abs(np.nan_to_num(values)) >= ANNOTATE):
        panel.text(
            j + 0.5,
            i + 0.5,
            f"{values[i, j]:.0f}",
            size=5.5,
            color=LINE_COLOUR,
            across="center",
            along="center",
        )


def _scale(panel: Panel) -> None:
    draw_color_scale(
        panel,
        np.linspace(-100.0, 100.0, STRIPS + 1),
        diverging()(np.linspace(0.0, 1.0, STRIPS)),
        upright=True,
    )
    panel.right = True
    panel.set_labels(None, "percent of the column's largest")


def _name(entry: Characteristic) -> str:
    return f"{entry.label} [{entry.unit}]"


def _case_names(panel: Panel, influence: Influence, at: Layout) -> None:
    cases = [influence.characteristics[j].load_case for j in at.columns]
    start = 0
    for case, members in groupby(cases):
        count = len(list(members))
        words = case_label(case).replace(" ", "\n") if count < 3 else case_label(case).replace(", ", ",\n")
        panel.text(
            start + count / 2,
            0.0,
            words,
            shift=(0.0, INFLUENCE_GAP),
            size=7.0,
            across="center",
            along="bottom",
        )
        start += count


def _lines(panel: Panel, influence: Influence, at: Layout) -> None:
    cases = [influence.characteristics[j].load_case for j in at.columns]
    groups = [influence.parameters[i].group for i in at.rows]
    for k in range(1, len(cases)):
        if cases[k] != cases[k - 1]:
            panel.vline(k, color=LINE_COLOUR, lw=0.9)
    for k in range(1, len(groups)):
        if groups[k] != groups[k - 1]:
            panel.hline(k, color=LINE_COLOUR, lw=0.9)


def influence_bars(influence: Influence, *, study: str) -> Sheet:
    """The ten strongest parameters of each characteristic, signed; one small panel each."""
    at = layout(influence)
    rows = -(-len(at.columns) // INFLUENCE_PANELS)
    height = 0.8 + 1.85 * rows
    margins = {"left": 0.1, "right": 0.985, "wspace": 0.45, "hspace": 0.42}
    margins |= {"bottom": 0.5 / height, "top": 1 - 0.75 / height}
    page, panels = sheet(rows, INFLUENCE_PANELS, size=(8.27, height), margins=margins)
    for panel, j in zip(panels.flat, at.columns, strict=False):
        _bars(panel, influence, j)
    del page.panels[len(at.columns) :]
    for panel in page.panels[-INFLUENCE_PANELS:]:
        panel.numbers["x"] = True
        panel.set_labels("percent of the largest", None)
    page.set_heading(f"Strongest parameters of each characteristic: {study}", 1 - 0.1 / height)
    return page


def _bars(panel: Panel, influence: Influence, j: int) -> None:
    column = influence.percent[:, j]
    strongest = np.argsort(-np.abs(column), kind="stable")[:STRONGEST_COUNT]
    strongest = strongest[np.abs(column[strongest]) >= 0.5]
    entry = influence.characteristics[j]
    values = column[strongest]
    places = np.arange(values.size)
    if values.size:
        panel.bars(
            places, 0.0, values, 0.75, [f"#{POSITIVE_FILL if v > 0 else NEGATIVE_FILL}" for v in values]
        )
    for y, v in zip(places, values, strict=True):
        panel.text(
            v, float(y), f"{v:+.0f}", shift=(2.0 if v > 0 else -2.0, 0.0), size=5.5, along="center",
            across="left" if v > 0 else "right",
        )  # fmt: skip
    panel.vline(0.0, color=LINE_COLOUR, lw=0.6)
    panel.x.set_limits(-140.0, 140.0)
    panel.y.set_limits(STRONGEST_COUNT - 0.4, -0.6)
    panel.y.set_ticks(places, [influence.parameters[i].path for i in strongest])
    panel.number_size["y"] = 6.0
    panel.set_title(f"{case_label(entry.load_case)}\n{entry.label}", size=7.5)


def write_influence_figures(
    influence: Influence,
    folder: Path,
    *,
    study: str,
    workers: int | None = None,
    pictures: PictureFormat = PNG,
    overall: GlobalSensitivity | None = None,
) -> list[Path]:
    """Pictures `influence_heat_map` and `influence_top_ten`, with global sensitivities also
    `influence_global`; returns their paths.

    Raises RunError when the folder cannot be written.
    """
    jobs: list[Job] = [
        (folder / "influence_heat_map", partial(influence_heat_map, influence, study=study)),
        (folder / "influence_top_ten", partial(influence_bars, influence, study=study)),
    ]
    if overall is not None:
        jobs.append((folder / "influence_global", partial(global_bars, overall, study=study)))
    return draw_series(jobs, workers, pictures=pictures)
