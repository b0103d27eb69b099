"""Pictures of a surrogate study: predicted against true, and quality of every model."""

from __future__ import annotations

from functools import partial
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from doe_kc.pictures import PNG, PictureFormat
from doe_kc.reporting.names import case_label
from doe_kc.reporting.plain_axes import draw_plain_axes
from doe_kc.reporting.series import draw_series
from doe_kc.reporting.style import CYCLE, PALETTE, figure, label, ticks
from doe_kc.reporting.surrogate_tables import left_out_predictions, left_out_sd
from doe_kc.surrogates.models import SURROGATES
from doe_kc.surrogates.report import SurrogateReport
from doe_kc.surrogates.validation import NOMINAL, WIDTH
from doe_kc.typing import FloatArray

PANELS = 5
"""Columns of small multiples."""
MARKERS = "osD^vPX"
LEAST = 1e-5
"""1 - Q2 at which the axis of the quality ends."""


def predicted_against_true(report: SurrogateReport, *, study: str) -> Figure:
    """One panel a characteristic: left-out predictions with their calibrated 95 % intervals."""
    count = len(report.designs.characteristics)
    rows = -(-count // PANELS)
    height = 1.2 + 2.05 * rows
    margins = {"left": 0.075, "right": 0.985, "wspace": 0.5, "hspace": 0.62}
    margins |= {"bottom": 0.6 / height, "top": 1.0 - 1.15 / height}
    fig, axes = figure(rows, PANELS, size=(11.69, height), share_x=False, margins=margins)
    predicted, sd = left_out_predictions(report), left_out_sd(report)
    for j, ax in enumerate(axes.flat[:count]):
        _panel(ax, report, j, predicted[:, j], sd[:, j])
    for ax in axes.flat[count:]:
        ax.set_visible(False)
    for ax in axes[:, 0]:
        label(ax, None, "predicted")
    for ax in axes.flat[max(0, count - PANELS) : count]:
        label(ax, "true value", None)
    title = f"Left-out predictions with 95 % intervals against the true solver: {study}"
    if report.targets:
        title += "\n(dashed, or arrow where the designs do not reach it: measured)"
    fig.suptitle(title, y=1.0 - 0.1 / height, va="top", fontsize=11, parse_math=False)
    draw_plain_axes(fig)
    return fig


def _panel(ax: Axes, report: SurrogateReport, j: int, predicted: FloatArray, sd: FloatArray) -> None:
    entry, true = report.designs.characteristics[j], report.designs.y[:, j]
    name = report.fitted.chosen[j]
    bars = WIDTH * sd
    ax.errorbar(true, predicted, yerr=bars, fmt="none", ecolor=PALETTE["sky"], elinewidth=0.6, zorder=1)
    ax.plot(true, predicted, "o", ms=2.2, mew=0, color=PALETTE["blue"], zorder=2)
    low, high = float(min(true.min(), predicted.min())), float(max(true.max(), predicted.max()))
    pad = 0.05 * (high - low) or 0.05 * abs(high) or 1.0
    limits = (low - pad, high + pad)
    if entry.id in report.targets:
        _target(ax, report.targets[entry.id], limits)
    ax.plot(limits, limits, color=PALETTE["black"], lw=0.7, zorder=1.5)
    ax.set_xlim(*limits)
    ax.set_ylim(*limits)
    for axis in (ax.xaxis, ax.yaxis):
        axis.set_major_locator(ticks(4))
    q2 = report.fitted.models[name].quality.q2[j]
    how = f"{name}, Q² {q2:.4f}" if np.isfinite(q2) else "never changes"
    heads = f"{case_label(entry.load_case)}\n{entry.label} [{entry.unit}]\n{how}"
    ax.set_title(heads, fontsize=6.5, y=1.0, parse_math=False)


def _target(ax: Axes, value: float, limits: tuple[float, float]) -> None:
    """The measured value as a dashed line, or an arrow to the side where the designs do not reach it."""
    color = PALETTE["vermillion"]
    if limits[0] <= value <= limits[1]:
        ax.axvline(value, color=color, lw=0.9, ls="--", zorder=3)
        return
    right = value > limits[1]
    text, x = (f"{value:.3g} →", 0.97) if right else (f"← {value:.3g}", 0.03)
    ha = "right" if right else "left"
    y = 0.08 if right else 0.92
    ax.text(x, y, text, transform=ax.transAxes, ha=ha, va="center", color=color, fontsize=7)


def model_quality(report: SurrogateReport, *, study: str) -> Figure:
    """Unexplained share of every model, and coverage of the chosen ones before and after calibration."""
    entries = report.designs.characteristics
    height = 1.9 + 0.235 * len(entries)
    margins = {"left": 0.36, "right": 0.98, "wspace": 0.06}
    margins |= {"bottom": 0.95 / height, "top": 1.0 - 0.65 / height}
    fig, axes = figure(1, 2, size=(8.27, height), share_x=False, width_ratios=(2.0, 1.0), margins=margins)
    quality, coverage = axes[0]
    places = np.arange(len(entries), dtype=float)
    _missed(quality, report, places)
    _coverage(coverage, report, places)
    quality.set_yticks(places)
    quality.set_yticklabels([f"{case_label(c.load_case)}: {c.label}" for c in entries], fontsize=6.5)
    coverage.set_yticks(places)
    coverage.set_yticklabels([])
    for ax in (quality, coverage):
        ax.set_ylim(len(entries) - 0.4, -0.6)
        ax.legend(
            loc="upper center",
            bbox_to_anchor=(0.5, -0.5 / (height - 1.6)),
            ncols=3,
            fontsize=6.5,
            frameon=False,
        )
    fig.suptitle(f"Quality of the surrogates: {study}", fontsize=11, parse_math=False)
    return fig


def _missed(ax: Axes, report: SurrogateReport, places: FloatArray) -> None:
    chosen = np.array(report.fitted.chosen)
    for k, (name, judged) in enumerate(report.fitted.models.items()):
        missed = np.clip(1.0 - judged.quality.q2, LEAST, None)
        color = CYCLE[k % len(CYCLE)]
        marker = MARKERS[k % len(MARKERS)]
        ax.plot(missed, places, marker, ms=3.5, mfc="none", mew=0.8, color=color)
        used = np.where(chosen == name, missed, np.nan)
        ax.plot(used, places, marker, ms=4.5, mew=0, color=color, label=SURROGATES[name].label)
    ax.set_xscale("log")
    label(ax, "1 − Q², variance not explained (filled: model in use)", None)


def _coverage(ax: Axes, report: SurrogateReport, places: FloatArray) -> None:
    models = report.fitted.models
    before = report.fitted.of_chosen({k: m.quality.coverage for k, m in models.items()})
    after = report.fitted.of_chosen({k: m.covered for k, m in models.items()})
    ax.axvline(100.0 * NOMINAL, color=PALETTE["black"], lw=0.8)
    ax.hlines(places, 100.0 * before, 100.0 * after, color=PALETTE["grey"], lw=0.7)
    ax.plot(
        100.0 * before, places, "D", ms=3.5, mfc="none", mew=0.8, color=PALETTE["vermillion"], label="raw"
    )
    ax.plot(100.0 * after, places, "o", ms=4.0, mew=0, color=PALETTE["blue"], label="calibrated")
    low = min(80.0, 100.0 * float(min(before.min(), after.min())) - 3.0)
    ax.set_xlim(low, 101.0)
    ax.set_xticks([t for t in range(0, 101, 10 if low > 50.0 else 20) if t >= low])
    label(ax, "in the 95 % interval / %", None)


def write_surrogate_figures(
    report: SurrogateReport,
    folder: Path,
    *,
    study: str,
    workers: int | None = None,
    pictures: PictureFormat = PNG,
) -> list[Path]:
    """Pictures `predicted_against_true` and `model_quality`; returns their paths.

    Raises RunError when the folder cannot be written.
    """
    jobs = [
        (folder / "predicted_against_true", partial(predicted_against_true, report, study=study)),
        (folder / "model_quality", partial(model_quality, report, study=study)),
    ]
    return draw_series(jobs, workers, pictures=pictures)
