"""Pictures of a tolerance study: distributions with limits, contributions, what to tighten."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from pathlib import Path

import numpy as np
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from doe_kc.ground.picture_format import PNG, PictureFormat
from doe_kc.ground.typing import FloatArray
from doe_kc.load_cases import case_label
from doe_kc.production_scatter.result import CharacteristicScatter, Tolerance
from doe_kc.reports.drawing.panel import Panel
from doe_kc.reports.drawing.panel_axis import ticks
from doe_kc.reports.drawing.series import Job, draw_series
from doe_kc.reports.drawing.sheet import Sheet, sheet
from doe_kc.reports.drawing.style import COLOUR_CYCLE, PALETTE
from doe_kc.reports.tolerance.bands import band_sheet
from doe_kc.reports.tolerance.words import ranked_tightenings

DISTRIBUTION_PANELS = 4
"""Columns of small multiples."""
CAR_FILL, CAR_EDGE = PALETTE["sky"], PALETTE["blue"]
LIMIT_COLOUR = PALETTE["black"]
OUTSIDE_FILL = "#FBDDB3"
"""Behind what is beyond a requirement, as in the workbooks."""
MEASURED_CAR_COLOURS = tuple(COLOUR_CYCLE[i] for i in (1, 2, 4, 3))
"""Of the measured cars, in turn."""
FIRST_COLOUR, TOTAL_COLOUR = PALETTE["sky"], PALETTE["blue"]
INTERVAL_FILL = "#E4E8EC"
MOST_CONTRIBUTORS = 8
MOST_TIGHTENED = 30
SHOWN_OUT = 4.5
"""Standard deviations from the mean to which a distribution is drawn at most."""


def distributions(tolerance: Tolerance, *, study: str) -> Sheet:
    """One panel a characteristic: the cars, the normal curve of first order, limits, measured cars."""
    count = len(tolerance.scatters)
    rows = -(-count // DISTRIBUTION_PANELS)
    height = 1.35 + 1.72 * rows
    margins = {"left": 0.03, "right": 0.985, "wspace": 0.14, "hspace": 0.86}
    margins |= {"bottom": 0.85 / height, "top": 1.0 - 0.95 / height}
    page, panels = sheet(rows, DISTRIBUTION_PANELS, size=(11.69, height), share_x=False, margins=margins)
    for k, panel in enumerate(panels.flat[:count]):
        _distribution(panel, tolerance, tolerance.scatters[k], tolerance.values[:, k])
    del page.panels[count:]
    page.set_heading(f"Production scatter of {tolerance.n} cars: {study}", 1.0 - 0.12 / height)
    page.add_legend(_distribution_handles(tolerance), 4, 7.5)
    return page


def _distribution(
    panel: Panel, tolerance: Tolerance, scatter: CharacteristicScatter, values: FloatArray
) -> None:
    m = scatter.moments
    entry = scatter.entry
    if m.sd > 0.0:
        bins = min(40, max(12, int(np.sqrt(len(values)))))
        inside = values[np.abs(values - m.mean) <= SHOWN_OUT * m.sd]
        density, edges = np.histogram(inside, bins)
        heights = density / (len(values) * np.diff(edges))
        x = np.repeat(edges, 2)[1:-1]
        panel.fill_between(x, np.zeros_like(x), np.repeat(heights, 2), color=CAR_FILL, alpha=0.55)
        panel.plot(x, np.repeat(heights, 2), color=CAR_EDGE, lw=0.7)
        grid = np.linspace(m.mean - SHOWN_OUT * m.sd, m.mean + SHOWN_OUT * m.sd, 160)
        sd = scatter.first_order_sd
        if sd > 0.0:
            curve = np.exp(-0.5 * ((grid - scatter.nominal) / sd) ** 2) / (sd * np.sqrt(2.0 * np.pi))
            panel.plot(grid, curve, "--", color=PALETTE["black"], lw=0.8)
        panel.x.set_limits(*_x_limits(scatter, edges))
        panel.y.set_limits(0.0, 1.3 * float(heights.max()))
    _limits(panel, scatter)
    for k, car in enumerate(tolerance.cars):
        if car.name in scatter.measured:
            _measured(panel, scatter.measured[car.name][0], k)
    panel.vline(scatter.nominal, ":", color=PALETTE["black"], lw=0.9)
    panel.numbers["y"] = False
    panel.marks["y"] = panel.grid["y"] = panel.spines["left"] = False
    panel.x.set_locator(ticks(4))
    out = "" if scatter.outside is None else f", {100.0 * scatter.outside.share:.1f} % outside"
    heads = f"{case_label(entry.load_case)}\n{entry.label}\nsd {m.sd:.3g} {entry.unit}{out}"
    panel.set_title(heads, size=6.5)
    panel.set_labels(f"{entry.unit}", None, 6.5)


def _x_limits(scatter: CharacteristicScatter, edges: FloatArray) -> tuple[float, float]:
    """The cars, and limits as far as they are not far away."""
    m, low, high = scatter.moments, float(edges[0]), float(edges[-1])
    wanted = [v for v, _ in scatter.measured.values()]
    if scatter.requirement is not None:
        wanted += [v for v in (scatter.requirement.low, scatter.requirement.high) if np.isfinite(v)]
    for value in wanted:
        if abs(value - m.mean) <= 6.0 * m.sd:
            low, high = min(low, value), max(high, value)
    pad = 0.05 * (high - low)
    return low - pad, high + pad


def _limits(panel: Panel, scatter: CharacteristicScatter) -> None:
    requirement = scatter.requirement
    if requirement is None or scatter.moments.sd == 0.0:
        return
    start, end = panel.x.limits
    if requirement.low > start:
        panel.vspan(start, min(requirement.low, end), color=OUTSIDE_FILL, zorder=0)
    if requirement.high < end:
        panel.vspan(max(requirement.high, start), end, color=OUTSIDE_FILL, zorder=0)
    for value in (requirement.low, requirement.high):
        if start < value < end:
            panel.vline(value, color=LIMIT_COLOUR, lw=1.0)


def _measured(panel: Panel, value: float, k: int) -> None:
    """A line, or an arrow to the side on which the k-th car lies beyond the panel."""
    start, end = panel.x.limits
    color = _car_colour(k)
    if start <= value <= end:
        panel.vline(value, color=color, lw=1.4, zorder=4)
        return
    right = value > end
    text = f"{value:.3g} →" if right else f"← {value:.3g}"
    panel.text(
        0.98 if right else 0.02, 0.93 - 0.16 * k, text, scales=("panel", "panel"), size=6.5, color=color,
        across="right" if right else "left", along="top", backing="white",
    )  # fmt: skip


def _distribution_handles(tolerance: Tolerance) -> list[Line2D | Patch]:
    out: list[Line2D | Patch] = [
        Patch(facecolor=CAR_FILL, edgecolor=CAR_EDGE, alpha=0.55, label="cars, by the true solver"),
        Line2D([], [], color=PALETTE["black"], ls="--", lw=0.8, label="by slopes alone"),
        Line2D([], [], color=PALETTE["black"], ls=":", lw=0.9, label="unchanged axle"),
    ]
    if tolerance.required:
        out += [
            Line2D([], [], color=LIMIT_COLOUR, lw=1.0, label="requirement"),
            Patch(color=OUTSIDE_FILL, label="outside"),
        ]
    return out + measured_handles(tolerance)


def _car_colour(k: int) -> str:
    return MEASURED_CAR_COLOURS[k % len(MEASURED_CAR_COLOURS)]


def measured_handles(tolerance: Tolerance) -> list[Line2D | Patch]:
    """Lines of the measured cars for a legend."""
    return [
        Line2D(
            [],
            [],
            color=MEASURED_CAR_COLOURS[k % len(MEASURED_CAR_COLOURS)],
            lw=1.4,
            label=f"measured: {c.name}",
        )
        for k, c in enumerate(tolerance.cars)
    ]


def contributions(tolerance: Tolerance, *, study: str) -> Sheet:
    """One panel a characteristic: the parameters that contribute most, first order and total."""
    count = len(tolerance.scatters)
    columns = 3
    rows = -(-count // columns)
    height = 1.2 + 1.72 * rows
    margins = {"left": 0.1, "right": 0.985, "wspace": 0.42, "hspace": 0.5}
    margins |= {"bottom": 0.75 / height, "top": 1.0 - 0.8 / height}
    page, panels = sheet(rows, columns, size=(8.27, height), margins=margins)
    for k, panel in enumerate(panels.flat[:count]):
        _contribution(panel, tolerance, k)
    del page.panels[count:]
    for panel in page.panels[-columns:]:
        panel.numbers["x"] = True
        panel.set_labels("share of the variance [%]", None)
    handles: list[Line2D | Patch] = [
        Patch(color=FIRST_COLOUR, label=f"first order ({tolerance.first_order.source})"),
        Patch(color=TOTAL_COLOUR, label="total, from the cars"),
    ]
    page.add_legend(handles, 2, 7.5)
    page.set_heading(f"What the scatter comes from: {study}", 1 - 0.12 / height)
    return page


def _contribution(panel: Panel, tolerance: Tolerance, k: int) -> None:
    first, total = 100.0 * tolerance.first_shares[:, k], 100.0 * tolerance.totals.shares[:, k]
    size = np.maximum(np.abs(first), np.abs(total))
    chosen = np.argsort(-size, kind="stable")[:MOST_CONTRIBUTORS]
    chosen = chosen[size[chosen] >= 0.5]
    places = np.arange(chosen.size, dtype=float)
    if chosen.size:
        panel.bars(places - 0.2, 0.0, first[chosen], 0.36, [FIRST_COLOUR] * chosen.size)
        panel.bars(places + 0.2, 0.0, total[chosen], 0.36, [TOTAL_COLOUR] * chosen.size)
    for y, i in zip(places, chosen, strict=True):
        end = max(first[i], total[i], 0.0)
        panel.text(end, float(y), f"{max(0.0, total[i]):.0f}", shift=(2.5, 0.0), size=5.5, along="center")
    panel.vline(0.0, color=PALETTE["black"], lw=0.6)
    panel.x.set_limits(min(-4.0, 1.1 * float(min(first.min(), total.min()))), 112.0)
    panel.x.set_ticks([0, 25, 50, 75, 100], ["0", "25", "50", "75", "100"])
    panel.y.set_limits(MOST_CONTRIBUTORS - 0.4, -0.6)
    panel.y.set_ticks(places, [tolerance.model.scatters[i].parameter.path for i in chosen])
    panel.number_size["y"] = 6.0
    entry = tolerance.characteristics[k]
    panel.set_title(f"{case_label(entry.load_case)}\n{entry.label}", size=7.0)


def tightening_bars(tolerance: Tolerance, *, study: str) -> Sheet:
    """Cars outside any requirement, and requirements that a car misses, with the scatter of one parameter
    halved or doubled."""
    ranked = ranked_tightenings(tolerance)[:MOST_TIGHTENED]
    height = 1.7 + 0.22 * len(ranked)
    now = tolerance.any_outside
    halved, doubled = [t.any_outside for t in ranked], [t.doubled for t in ranked]
    moving = any(s.count != now.count for s in (*halved, *doubled))
    margins = {"left": 0.24, "right": 0.97, "bottom": 0.95 / height, "top": 1 - 0.6 / height, "wspace": 0.08}
    page, panels = sheet(1, 1 + moving, size=(8.27, height), share_x=False, margins=margins)
    if moving:
        shares = panels[0, 0]
        shares.vspan(100.0 * now.low, 100.0 * now.high, color=INTERVAL_FILL, zorder=0)
        _pairs(shares, 100.0 * now.share, *([100.0 * s.share for s in of] for of in (halved, doubled)))
        shares.set_labels("cars outside any requirement [%]", None)
    missed = panels[0, -1]
    _pairs(missed, tolerance.missed, [t.missed for t in ranked], [t.missed_doubled for t in ranked])
    missed.set_labels(f"requirements that a car misses, of {len(tolerance.required)}", None)
    words = [
        f"{t.scatter.parameter.path}  (sd {t.scatter.sd:.3g} {t.scatter.parameter.unit})" for t in ranked
    ]
    for k, panel in enumerate(panels.flat):
        names = [w.replace(" -)", ")") if k == 0 else "" for w in words]
        panel.y.set_ticks(np.arange(len(ranked), dtype=float), names)
        panel.y.set_limits(len(ranked) - 0.4, -0.6)
        panel.x.set_locator(ticks(5))
    handles: list[Line2D | Patch] = [
        Line2D([], [], ls="", marker="o", ms=4.5, mew=0, color=PALETTE["blue"], label="scatter halved"),
        Line2D([], [], ls="", marker="D", ms=4.0, mfc="none", color=PALETTE["vermillion"], label="doubled"),
        Line2D([], [], color=PALETTE["black"], lw=0.9, label="now"),
        *([Patch(color=INTERVAL_FILL, label="95 % interval of now")] if moving else []),
    ]
    page.add_legend(handles, 4, 7.5)
    page.set_heading(f"Which scatter to tighten, and which may grow: {study}", 1 - 0.15 / height)
    return page


def _pairs(panel: Panel, now: float, halved: Sequence[float], doubled: Sequence[float]) -> None:
    places = np.arange(len(halved), dtype=float)
    panel.vline(now, color=PALETTE["black"], lw=0.9)
    panel.segments(halved, places, doubled, places, colors=PALETTE["grey"], linewidths=0.8, zorder=2)
    panel.plot(halved, places, "", marker="o", ms=4.5, mew=0, color=PALETTE["blue"])
    panel.plot(doubled, places, "", marker="D", ms=4.0, mew=0.9, mfc="none", color=PALETTE["vermillion"])


def write_tolerance_figures(
    tolerance: Tolerance,
    folder: Path,
    *,
    study: str,
    workers: int | None = None,
    pictures: PictureFormat = PNG,
) -> list[Path]:
    """Pictures `distributions`, `contributions`, `band_<load case>`, and `tightening` where there are
    requirements; returns their paths. Raises RunError when the folder cannot be written."""
    jobs: list[Job] = [
        (folder / "distributions", partial(distributions, tolerance, study=study)),
        (folder / "contributions", partial(contributions, tolerance, study=study)),
    ]
    if tolerance.required:
        jobs.append((folder / "tightening", partial(tightening_bars, tolerance, study=study)))
    looks = measured_handles(tolerance)
    for band in tolerance.bands:
        draw = partial(band_sheet, band, tolerance.cars, looks, study=study)
        jobs.append((folder / f"band_{band.load_case}", draw))
    return draw_series(jobs, workers, pictures=pictures)
