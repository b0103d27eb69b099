"""Pictures of a surrogate study: predicted against true, and quality of every model."""

from __future__ import annotations

from functools import partial
from pathlib import Path

import numpy as np
from matplotlib.lines import Line2D

from doe_kc.ground.picture_format import PNG, PictureFormat
from doe_kc.ground.typing import FloatArray
from doe_kc.load_cases import case_label
from doe_kc.reports.drawing.panel import Panel
from doe_kc.reports.drawing.panel_axis import ticks
from doe_kc.reports.drawing.series import draw_series
from doe_kc.reports.drawing.sheet import Sheet, sheet
from doe_kc.reports.drawing.style import COLOUR_CYCLE, MARKERS, PALETTE
from doe_kc.reports.drawing.words import POINTS
from doe_kc.reports.surrogates.learning import learning_curves
from doe_kc.reports.surrogates.responses import response_surfaces, slices
from doe_kc.reports.surrogates.tables import left_out_predictions, left_out_sd
from doe_kc.surrogate_models.models import SURROGATES
from doe_kc.surrogate_models.report import SurrogateReport
from doe_kc.surrogate_models.validation import NOMINAL, NOMINAL_WIDTH

SURROGATE_PANELS = 5
"""Columns of small multiples."""
QUALITY_AXIS_END = 1e-5
"""1 - Q2 at which the axis of the quality ends."""


def predicted_against_true(report: SurrogateReport, *, study: str) -> Sheet:
    """One panel a characteristic: left-out predictions with their calibrated 95 % intervals."""
    count = len(report.designs.characteristics)
    rows = -(-count // SURROGATE_PANELS)
    height = 1.2 + 2.05 * rows
    margins = {"left": 0.075, "right": 0.985, "wspace": 0.5, "hspace": 0.62}
    margins |= {"bottom": 0.6 / height, "top": 1.0 - 1.15 / height}
    page, panels = sheet(rows, SURROGATE_PANELS, size=(11.69, height), share_x=False, margins=margins)
    predicted, sd = left_out_predictions(report), left_out_sd(report)
    for j, panel in enumerate(panels.flat[:count]):
        _panel(panel, report, j, predicted[:, j], sd[:, j])
    del page.panels[count:]
    for panel in panels[:, 0]:
        panel.set_labels(None, "predicted")
    for panel in page.panels[-SURROGATE_PANELS:]:
        panel.set_labels("true value", None)
    title = f"Left-out predictions with 95 % intervals against the true solver: {study}"
    if report.targets:
        title += "\n(dashed, or arrow where the designs do not reach it: measured)"
    page.set_heading(title, 1.0 - 0.1 / height)
    return page


def _panel(panel: Panel, report: SurrogateReport, j: int, predicted: FloatArray, sd: FloatArray) -> None:
    entry, true = report.designs.characteristics[j], report.designs.y[:, j]
    name = report.fitted.chosen[j]
    bars = NOMINAL_WIDTH * sd
    panel.segments(
        true, predicted - bars, true, predicted + bars, colors=PALETTE["sky"], linewidths=0.6, zorder=1
    )
    panel.plot(true, predicted, "", marker="o", ms=2.2, mew=0, color=PALETTE["blue"], zorder=2)
    low, high = float(min(true.min(), predicted.min())), float(max(true.max(), predicted.max()))
    pad = 0.05 * (high - low) or 0.05 * abs(high) or 1.0
    limits = (low - pad, high + pad)
    if entry.id in report.targets:
        _target(panel, report.targets[entry.id], limits)
    panel.plot(limits, limits, color=PALETTE["black"], lw=0.7, zorder=1.5)
    for axis in (panel.x, panel.y):
        axis.set_limits(*limits)
        axis.set_locator(ticks(4))
    q2 = report.fitted.models[name].quality.q2[j]
    how = f"{name}, Q² {q2:.4f}" if np.isfinite(q2) else "never changes"
    heads = f"{case_label(entry.load_case)}\n{entry.label} [{entry.unit}]\n{how}"
    panel.set_title(heads, size=6.5)


def residuals(report: SurrogateReport, *, study: str) -> Sheet:
    """One panel a characteristic: left-out error of each design over its true value.

    Beside a spread of hundreds of its errors the interval of `predicted_against_true` cannot be seen.
    """
    entries = report.designs.characteristics
    rows = -(-len(entries) // SURROGATE_PANELS)
    height = 1.2 + 2.05 * rows
    margins = {"left": 0.075, "right": 0.985, "wspace": 0.5, "hspace": 0.62}
    margins |= {"bottom": 0.6 / height, "top": 1.0 - 1.15 / height}
    page, panels = sheet(rows, SURROGATE_PANELS, size=(11.69, height), share_x=False, margins=margins)
    predicted, sd = left_out_predictions(report), left_out_sd(report)
    for j, panel in enumerate(panels.flat[: len(entries)]):
        _residual_panel(panel, report, j, predicted[:, j] - report.designs.y[:, j], NOMINAL_WIDTH * sd[:, j])
    del page.panels[len(entries) :]
    for panel in panels[:, 0]:
        panel.set_labels(None, "predicted − true")
    for panel in page.panels[-SURROGATE_PANELS:]:
        panel.set_labels("true value", None)
    page.set_heading(f"Left-out errors with 95 % intervals: {study}", 1.0 - 0.1 / height)
    return page


def _residual_panel(
    panel: Panel, report: SurrogateReport, j: int, error: FloatArray, bars: FloatArray
) -> None:
    entry, true = report.designs.characteristics[j], report.designs.y[:, j]
    color = PALETTE["sky"]
    panel.segments(true, error - bars, true, error + bars, colors=color, linewidths=0.6, zorder=1)
    panel.plot(true, error, "", marker="o", ms=2.2, mew=0, color=PALETTE["blue"], zorder=2)
    pad = 0.05 * float(np.ptp(true)) or 0.05 * float(np.abs(true).max()) or 1.0
    limits = (float(true.min()) - pad, float(true.max()) + pad)
    high = 1.08 * float(np.max(np.abs(error) + bars)) or 1.0
    panel.plot(limits, (0.0, 0.0), color=PALETTE["black"], lw=0.7, zorder=1.5)
    panel.x.set_limits(*limits)
    panel.y.set_limits(-high, high)
    for axis in (panel.x, panel.y):
        axis.set_locator(ticks(4))
    share = float((np.abs(error) <= bars).mean())
    heads = f"{case_label(entry.load_case)}\n{entry.label} [{entry.unit}]\n{100.0 * share:.0f} % inside"
    panel.set_title(heads, size=6.5)


def _target(panel: Panel, value: float, limits: tuple[float, float]) -> None:
    """The measured value as a dashed line, or an arrow to the side where the designs do not reach it."""
    color = PALETTE["vermillion"]
    if limits[0] <= value <= limits[1]:
        panel.vline(value, "--", color=color, lw=0.9, zorder=3)
        return
    right = value > limits[1]
    text, x = (f"{value:.3g} →", 0.97) if right else (f"← {value:.3g}", 0.03)
    panel.text(
        x, 0.08 if right else 0.92, text, scales=("panel", "panel"), size=7.0, color=color,
        across="right" if right else "left", along="center",
    )  # fmt: skip


def model_quality(report: SurrogateReport, *, study: str) -> Sheet:
    """Unexplained share of every model, and coverage of the chosen ones before and after calibration."""
    entries = report.designs.characteristics
    height = 1.9 + 0.235 * len(entries)
    margins = {"left": 0.36, "right": 0.98, "wspace": 0.06}
    margins |= {"bottom": 0.95 / height, "top": 1.0 - 0.65 / height}
    page, panels = sheet(1, 2, size=(8.27, height), share_x=False, width_ratios=(2.0, 1.0), margins=margins)
    quality, coverage = panels[0]
    places = np.arange(len(entries), dtype=float)
    handles = (_missed(quality, report, places), _coverage(coverage, report, places))
    quality.y.set_ticks(places, [f"{case_label(c.load_case)}: {c.label}" for c in entries])
    quality.number_size["y"] = 6.5
    coverage.y.set_ticks(places, [""] * places.size)
    for panel, shown in zip(panels[0], handles, strict=True):
        panel.y.set_limits(len(entries) - 0.4, -0.6)
        at = (panel.box.left + panel.box.width / 2.0, panel.box.bottom - 0.5 * POINTS)
        page.add_legend(shown, 2, 6.5, ("center", "top"), at)
    page.set_heading(f"Quality of the surrogates: {study}", 1 - 0.15 / height)
    return page


def _missed(panel: Panel, report: SurrogateReport, places: FloatArray) -> list[Line2D]:
    """The lines of the legend."""
    panel.x.set_logarithmic()
    chosen = np.array(report.fitted.chosen)
    handles = []
    for k, (name, judged) in enumerate(report.fitted.models.items()):
        missed = np.clip(1.0 - judged.quality.q2, QUALITY_AXIS_END, None)
        color = COLOUR_CYCLE[k % len(COLOUR_CYCLE)]
        marker = MARKERS[k % len(MARKERS)]
        panel.plot(missed, places, "", marker=marker, ms=3.5, mfc="none", mew=0.8, color=color)
        used = np.where(chosen == name, missed, np.nan)
        words = SURROGATES[name].label
        handles.append(panel.plot(used, places, "", marker=marker, ms=4.5, mew=0, color=color, label=words))
    panel.set_labels("1 − Q², variance not explained (filled: model in use)", None)
    return handles


def _coverage(panel: Panel, report: SurrogateReport, places: FloatArray) -> list[Line2D]:
    """The lines of the legend."""
    models = report.fitted.models
    before = 100.0 * report.fitted.of_chosen({k: m.quality.coverage for k, m in models.items()})
    after = 100.0 * report.fitted.of_chosen({k: m.covered for k, m in models.items()})
    panel.vline(100.0 * NOMINAL, color=PALETTE["black"], lw=0.8)
    panel.segments(before, places, after, places, colors=PALETTE["grey"], linewidths=0.7, zorder=2)
    raw, calibrated = PALETTE["vermillion"], PALETTE["blue"]
    handles = [
        panel.plot(before, places, "", marker="D", ms=3.5, mfc="none", mew=0.8, color=raw, label="raw"),
        panel.plot(after, places, "", marker="o", ms=4.0, mew=0, color=calibrated, label="calibrated"),
    ]
    low = min(80.0, float(min(before.min(), after.min())) - 3.0)
    panel.x.set_limits(low, 101.0)
    at = [t for t in range(0, 101, 10 if low > 50.0 else 20) if t >= low]
    panel.x.set_ticks(at, [str(t) for t in at])
    panel.set_labels("in the 95 % interval [%]", None)
    return handles


def write_surrogate_figures(
    report: SurrogateReport,
    folder: Path,
    *,
    study: str,
    workers: int | None = None,
    pictures: PictureFormat = PNG,
) -> list[Path]:
    """Pictures `predicted_against_true`, `residuals`, `model_quality`, `slices`, `response_surfaces` and
    `learning_curve`; returns their paths.

    Raises RunError when the folder cannot be written.
    """
    jobs = [
        (folder / "predicted_against_true", partial(predicted_against_true, report, study=study)),
        (folder / "residuals", partial(residuals, report, study=study)),
        (folder / "model_quality", partial(model_quality, report, study=study)),
        (folder / "slices", partial(slices, report, study=study)),
        (folder / "response_surfaces", partial(response_surfaces, report, study=study)),
    ]
    if report.curve is not None:
        draw = partial(learning_curves, report, report.curve, study=study)
        jobs.append((folder / "learning_curve", draw))
    return draw_series(jobs, workers, pictures=pictures)
