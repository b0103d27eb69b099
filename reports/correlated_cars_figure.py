"""Estimate beside truth, and how well the stated errors hold."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from axes import figure, label
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from recovery import STATED, Fit
from report_figures import legend, title
from scipy.stats import norm

from doe_kc.reports.drawing.style import PALETTE

SEEN, UNSEEN = PALETTE["blue"], PALETTE["grey"]


def recovery_figure(fits: Mapping[str, Fit], synthetic: Mapping[float, Sequence[Fit]]) -> Figure:
    """One panel a car, and the errors of the synthetic cars in stated standard deviations."""
    fig, axes = figure(1, len(fits) + 1, size=(3.9 * (len(fits) + 1), 4.3), share_x=False)
    for ax, (car, fit) in zip(axes[0], fits.items(), strict=False):
        _beside_truth(ax, car, fit)
    _errors(axes[0, -1], synthetic)
    return fig


def _beside_truth(ax: Axes, car: str, fit: Fit) -> None:
    scale, start, seen = np.array(fit.prior), np.array(fit.start), np.array(fit.visible)
    known = np.isfinite(fit.true)
    x, y = (np.array(fit.true) - start) / scale, (np.array(fit.estimate) - start) / scale
    bar = STATED * np.array(fit.sd) / scale
    for mask, colour, word, order in (
        (known & ~seen, UNSEEN, "not visible", 2),
        (known & seen, SEEN, "visible", 3),
    ):
        ax.errorbar(
            x[mask], y[mask], yerr=bar[mask], fmt="o", ms=3.5, lw=0.0, elinewidth=0.7, color=colour,
            alpha=1.0 if colour == SEEN else 0.6, zorder=order, label=f"{word} ({mask.sum()})",
        )  # fmt: skip
    reach = 1.05 * float(np.abs(x[known]).max())
    ax.plot([-reach, reach], [-reach, reach], color=PALETTE["black"], lw=0.8, label="estimate = truth")
    label(ax, "true change from nominal [prior sd]", f"estimate ± {STATED:g} stated sd [prior sd]")
    ax.set_ylim(-2.5, 3.4)
    title(ax, f"{car}: {fit.inside} of {fit.judged.sum()} visible within {STATED:g} sd")
    legend(ax, "upper left")


def _errors(ax: Axes, synthetic: Mapping[float, Sequence[Fit]]) -> None:
    edges = np.linspace(-4.0, 4.0, 33)
    for (times, fits), colour in zip(synthetic.items(), (SEEN, PALETTE["orange"]), strict=False):
        z = np.concatenate([f.z[f.judged] for f in fits])
        word = f"{times:g} × scatter: {z.size} parameters"
        ax.hist(np.clip(z, -4.0, 4.0), edges, density=True, histtype="step", lw=1.4, color=colour, label=word)
    x = np.linspace(-4.0, 4.0, 161)
    ax.plot(x, norm.pdf(x), color=PALETTE["black"], label="as stated: N(0, 1)")
    for limit in (-STATED, STATED):
        ax.axvline(limit, color=PALETTE["vermillion"], lw=0.9, ls="--")
    label(ax, "(estimate - truth) / stated sd [-]", "density [-]")
    title(ax, f"{sum(map(len, synthetic.values()))} synthetic cars, visible parameters")
    ax.set_ylim(0.0, 0.68)
    legend(ax, "upper left")
