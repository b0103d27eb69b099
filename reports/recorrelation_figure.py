"""How the rating of a re-correlation rises, and which directions and parameters are found again."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pandas as pd
from axes import figure, label
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from recorrelation_case import Case
from report_figures import legend, title

from doe_kc.ground.typing import FloatArray
from doe_kc.reports.drawing.style import PALETTE

FREE = PALETTE["green"]
EGO, NEWTON = PALETTE["vermillion"], PALETTE["blue"]
SIZES = (PALETTE["orange"], PALETTE["vermillion"], PALETTE["purple"])
SEEN = 3.0**0.5
"""Sensitivity from which records halve the prior sd of a direction."""
EDGES = np.array([1e-4, 1e-3, 1e-2, 3e-2, 0.1, 0.3, 1.0, 3.0, 10.0, 30.0, 100.0, 1000.0])


def recorrelation_figure(cases: Sequence[Case], share: float) -> Figure:
    """Convergence, and what is left of the disturbance over how well the records see it."""
    fig, axes = figure(1, 2, size=(10.5, 4.3), share_x=False)
    _convergence(axes[0, 0], cases)
    _directions(axes[0, 1], cases, share)
    return fig


def _convergence(ax: Axes, cases: Sequence[Case]) -> None:
    for colour, times in zip(SIZES, sorted({c.times for c in cases}), strict=False):
        runs = [t for c in cases if c.times == times for t in c.ego]
        for k, run in enumerate(runs):
            word = f"ego, {times:g} × scatter ({len(runs)} runs)" if k == 0 else None
            steps = np.arange(1, run.evaluations + 1)
            ax.step(steps, -np.array(run.best), where="post", color=colour, lw=0.9, alpha=0.8, label=word)
            if run.feasible_at:
                ax.plot(run.feasible_at, -run.best[run.feasible_at - 1], "o", ms=4, color=colour, mec="black")
    free = [t for c in cases for t in c.fine]
    for k, run in enumerate(free):
        word = f"ego, continuous variables ({len(free)} runs)" if k == 0 else None
        steps = np.arange(1, run.evaluations + 1)
        ax.step(steps, -np.array(run.best), where="post", color=FREE, lw=0.8, alpha=0.8, label=word)
    for k, run in enumerate(c.newton for c in cases):
        word = f"gauss_newton ({len(cases)} runs)" if k == 0 else None
        ax.step(
            range(1, run.evaluations + 1), -np.array(run.best), where="post", color=NEWTON, lw=0.8, label=word
        )
    ax.plot([], [], "o", ms=4, color="white", mec="black", label="all constraints met from here")
    ax.set_yscale("log")
    label(ax, "true-solver evaluation (1 = nominal) [-]", "minus best rating so far [-]")
    title(ax, "Convergence: 0 would be the target exactly")
    legend(ax, "upper right")


def _directions(ax: Axes, cases: Sequence[Case], share: float) -> None:
    seen = np.concatenate([c.seen for c in cases])
    moved = np.concatenate([c.axes.T @ c.moved for c in cases])
    by_fit = np.concatenate([c.axes.T @ c.left(c.fit.estimate) for c in cases])
    runs = len(cases[0].ego)
    by_ego = np.concatenate([c.axes.T @ c.left(t.point) for c in cases for t in c.ego])
    repeated = np.concatenate([np.tile(c.seen, runs) for c in cases])
    moves = np.concatenate([np.tile(c.axes.T @ c.moved, runs) for c in cases])
    for colour, word, x, a, b in (
        (EGO, "ego", repeated, by_ego, moves),
        (NEWTON, "gauss_newton", seen, by_fit, moved),
    ):
        centre, left = _binned(x, a, b)
        ax.plot(centre, left, "o-", ms=4, color=colour, label=word)
    fine = np.geomspace(EDGES[0], EDGES[-1], 200)
    ax.plot(
        fine, 1.0 / (1.0 + (fine / share) ** 2), color=PALETTE["black"], lw=0.8, ls="--",
        label="linear theory of gauss_newton",
    )  # fmt: skip
    ax.axvline(SEEN, color=PALETTE["grey"], lw=0.9)
    ax.annotate(" visible to the rig", (SEEN, 1.48), fontsize=7)
    ax.annotate("not visible ", (SEEN, 1.48), fontsize=7, ha="right")
    ax.set_xscale("log")
    label(
        ax,
        "sensitivity of the records to a direction [noise sd per prior sd]",
        "share of the disturbance left [-]",
    )
    ax.set_ylim(-0.05, 1.3 * ax.get_ylim()[1])
    title(ax, "Found again (0) or not (1), by direction")
    legend(ax, "upper right")


def _binned(seen: FloatArray, left: FloatArray, moved: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Centres of the bins with at least three directions, and rms left over rms moved in them."""
    place = np.digitize(np.clip(seen, EDGES[0], EDGES[-1] * 0.999), EDGES)
    bins = [k for k in range(1, EDGES.size) if (place == k).sum() >= 3]
    centre = np.array([np.sqrt(EDGES[k - 1] * EDGES[k]) for k in bins])
    squares = [np.sum(left[place == k] ** 2) / np.sum(moved[place == k] ** 2) for k in bins]
    return centre, np.sqrt(np.array(squares))


def parameter_figure(table: pd.DataFrame) -> Figure:
    """What is left of the disturbance of each parameter."""
    fig, axes = figure(1, 1, size=(11.69, 4.4))
    ax, x = axes[0, 0], np.arange(len(table))
    ax.plot(x, table["moved"], "_", ms=8, mew=1.5, color=PALETTE["black"], label="disturbance")
    for name, colour in (("left_by_ego", EGO), ("left_by_gauss_newton", NEWTON)):
        ax.plot(x, table[name], "o", ms=4, color=colour, label=name.replace("left_by_", "left by "))
    for k in x[table["visible_share"] >= 0.5]:
        ax.axvspan(k - 0.5, k + 0.5, color="#EAF3EA", lw=0, zorder=0)
    ax.set_xticks(x, list(table["parameter"]), rotation=90)
    ax.set_xlim(-0.6, len(table) - 0.4)
    ax.grid(axis="x", visible=False)
    label(ax, None, "rms over the cars [prior sd]")
    title(ax, "Error left in each parameter; green: visible to the rig in at least half of the cars")
    ax.set_ylim(0.0, 1.25 * float(table[["moved", "left_by_ego", "left_by_gauss_newton"]].to_numpy().max()))
    legend(ax, "upper left", ncols=3)
    return fig
