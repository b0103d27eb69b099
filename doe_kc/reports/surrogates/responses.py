"""Pictures of what a surrogate predicts: slices along the strongest variables, surfaces over two of them."""

from __future__ import annotations

import numpy as np
from contourpy import contour_generator
from matplotlib.collections import LineCollection, PolyCollection

from doe_kc.ground.typing import FloatArray
from doe_kc.load_cases import case_label
from doe_kc.reports.drawing.panel import Panel
from doe_kc.reports.drawing.panel_axis import ticks
from doe_kc.reports.drawing.sheet import Sheet, sheet
from doe_kc.reports.drawing.style import COLOUR_CYCLE, PALETTE
from doe_kc.surrogate_models.influence import nominal_point
from doe_kc.surrogate_models.report import SurrogateReport
from doe_kc.surrogate_models.validation import NOMINAL_WIDTH

SLICE_PANELS, SURFACE_PANELS = 3, 5
"""Columns of small multiples."""
SLICES = 5
"""Variables of a panel, those of the largest shares."""
SLICE_POINTS, SURFACE_POINTS = 21, 25
LEVELS = 5
"""Contour lines of a surface."""
LEAST_LABELLED = 8
"""Points of a contour line that has room for its value."""
SURFACE_LOW, SURFACE_HIGH = np.array([0.93, 0.96, 0.99]), np.array([0.34, 0.58, 0.80])
"""Colours of a surface's lowest and highest value; black numbers are legible on both."""


def strongest(report: SurrogateReport, j: int, count: int) -> np.ndarray:
    """Places of the variables of the largest shares of characteristic j, the largest first."""
    return np.argsort(-report.shares[:, j], kind="stable")[:count]


def slices(report: SurrogateReport, *, study: str) -> Sheet:
    """One panel a characteristic: mean and 95 % band along each of the strongest variables, all others at
    the unchanged axle, over the place between the variable's bounds."""
    entries = report.designs.characteristics
    rows = -(-len(entries) // SLICE_PANELS)
    height = 1.3 + 2.1 * rows
    margins = {"left": 0.065, "right": 0.9, "wspace": 0.72, "hspace": 0.5}
    margins |= {"bottom": 0.6 / height, "top": 1.0 - 1.15 / height}
    page, panels = sheet(rows, SLICE_PANELS, size=(11.69, height), share_x=False, margins=margins)
    model, start = report.fitted.model, nominal_point(report.space)
    places = np.linspace(0.0, 1.0, SLICE_POINTS)
    used = sorted({int(k) for j in range(len(entries)) for k in strongest(report, j, SLICES)})
    points = np.tile(start, (len(used), SLICE_POINTS, 1))
    for i, k in enumerate(used):
        points[i, :, k] = places
    flat = points.reshape(-1, len(start))
    shape = (len(used), SLICE_POINTS, len(entries))
    mean, sd = model.predict(flat).reshape(shape), np.sqrt(model.variance(flat)).reshape(shape)
    for j, panel in enumerate(panels.flat[: len(entries)]):
        chosen = strongest(report, j, SLICES)
        lines = [used.index(int(k)) for k in chosen]
        names = [report.space.paths[k] for k in chosen]
        _slice_panel(panel, places, mean[lines, :, j], NOMINAL_WIDTH * sd[lines, :, j], names)
        panel.set_title(
            f"{case_label(entries[j].load_case)}: {entries[j].label} [{entries[j].unit}]", size=6.5
        )
    del page.panels[len(entries) :]
    for panel in page.panels[-SLICE_PANELS:]:
        panel.set_labels("place between the bounds", None)
    page.set_heading(
        f"Slices through the unchanged axle with 95 % bands: {study}\n"
        f"(each along the {SLICES} variables of the largest shares, all others held)",
        1.0 - 0.1 / height,
    )
    return page


def _slice_panel(
    panel: Panel, places: FloatArray, mean: FloatArray, half: FloatArray, names: list[str]
) -> None:
    for k, (line, width, name) in enumerate(zip(mean, half, names, strict=True)):
        color = COLOUR_CYCLE[k % len(COLOUR_CYCLE)]
        panel.fill_between(places, line - width, line + width, facecolor=color, alpha=0.18)
        panel.plot(places, line, color=color, lw=1.1)
        panel.text(
            1.03, 0.92 - 0.19 * k, name, scales=("panel", "panel"), size=6.5, color=color, along="center"
        )
    panel.x.set_limits(0.0, 1.0)
    for axis in (panel.x, panel.y):
        axis.set_locator(ticks(4))


def response_surfaces(report: SurrogateReport, *, study: str) -> Sheet:
    """One panel a characteristic: mean over its two strongest variables, absolute, all others at the
    unchanged axle; contour lines with their values."""
    entries, space = report.designs.characteristics, report.space
    rows = -(-len(entries) // SURFACE_PANELS)
    height = 1.3 + 2.45 * rows
    margins = {"left": 0.06, "right": 0.985, "wspace": 0.5, "hspace": 0.7}
    margins |= {"bottom": 0.6 / height, "top": 1.0 - 1.2 / height}
    page, panels = sheet(rows, SURFACE_PANELS, size=(11.69, height), share_x=False, margins=margins)
    model, start = report.fitted.model, nominal_point(space)
    places = np.linspace(0.0, 1.0, SURFACE_POINTS)
    across, along = np.meshgrid(places, places)
    for j, panel in enumerate(panels.flat[: len(entries)]):
        first, second = (int(k) for k in strongest(report, j, 2))
        points = np.tile(start, (across.size, 1))
        points[:, first], points[:, second] = across.ravel(), along.ravel()
        height_of = model.predict(points)[:, j].reshape(across.shape)
        x, y = (np.array([space.variables[k].value(u) for u in places]) for k in (first, second))
        _surface_panel(panel, x, y, height_of)
        names = [f"{space.variables[k].path} [{space.variables[k].unit}]" for k in (first, second)]
        panel.set_labels(*(n.removesuffix(" [-]") for n in names), size=6.5)
        at = [space.variables[k].value(float(start[k])) for k in (first, second)]
        panel.plot(at[:1], at[1:], "", marker="+", ms=6.0, mew=1.0, color=PALETTE["black"], zorder=4)
        panel.set_title(
            f"{case_label(entries[j].load_case)}\n{entries[j].label} [{entries[j].unit}]", size=6.5
        )
    del page.panels[len(entries) :]
    page.set_heading(
        f"Response over the two strongest variables: {study}\n"
        "(darker: larger; +: the unchanged axle, where all others are)",
        1.0 - 0.1 / height,
    )
    return page


def _surface_panel(panel: Panel, x: FloatArray, y: FloatArray, values: FloatArray) -> None:
    low, high = float(values.min()), float(values.max())
    span = high - low or 1.0
    cell = 0.25 * (values[:-1, :-1] + values[1:, :-1] + values[:-1, 1:] + values[1:, 1:])
    shade = ((cell - low) / span).ravel()[:, None]
    left, bottom = np.meshgrid(x[:-1], y[:-1])
    right, top = np.meshgrid(x[1:], y[1:])
    corners = np.stack([[left, bottom], [right, bottom], [right, top], [left, top]])
    cells = corners.transpose(2, 3, 0, 1).reshape(-1, 4, 2)
    colors = SURFACE_LOW + shade * (SURFACE_HIGH - SURFACE_LOW)
    panel.add(PolyCollection(list(cells), facecolors=colors, linewidths=0.0, antialiaseds=False))
    panel.x.set_limits(float(x[0]), float(x[-1]))
    panel.y.set_limits(float(y[0]), float(y[-1]))
    panel.grid = {"x": False, "y": False}
    for axis in (panel.x, panel.y):
        axis.set_locator(ticks(3))
    if high <= low:
        return
    lines = contour_generator(x, y, values)
    for level in ticks(LEVELS).tick_values(low, high):
        if not low < level < high:
            continue
        pieces = [np.asarray(piece) for piece in lines.lines(float(level))]
        panel.add(LineCollection(pieces, colors=PALETTE["black"], linewidths=0.6))
        longest = max(pieces, key=len)
        if len(longest) < LEAST_LABELLED:
            continue
        place = longest[len(longest) // 3]  # beside the middle, where the unchanged axle is
        panel.text(
            float(place[0]), float(place[1]), f"{level:.4g}", size=5.5, across="center", along="center"
        )
