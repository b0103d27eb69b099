"""Picture of a front of trade-offs: every design over the objectives, and the pair most in conflict."""

from __future__ import annotations

from functools import partial
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from scipy.stats import rankdata

from doe_kc.correlation.pareto.front import VIOLATION, Front
from doe_kc.errors import InputError
from doe_kc.pictures import PNG, PictureFormat
from doe_kc.reporting.names import case_label
from doe_kc.reporting.series import draw_series
from doe_kc.reporting.style import PALETTE, figure, label
from doe_kc.typing import FloatArray

SIZE = (11.69, 5.4)
MOST = 300
"""Designs drawn, best ratings first: more lines hide each other."""
NARROW = 0.05
"""Share of the widest range below which an objective is in no conflict worth a picture."""
OTHERS, BEST, KNEE = PALETTE["grey"], PALETTE["blue"], PALETTE["vermillion"]


def pareto_figure(front: Front, *, study: str) -> Figure:
    """Parallel coordinates of the front, and its designs over the two objectives most in conflict.

    InputError for an empty front.
    """
    if not len(front.indices):
        raise InputError(f"{study}: the front is empty, no design has an answer; nothing to draw.")
    fig, axes = figure(1, 2, size=SIZE, width_ratios=(2.1, 1.0), share_x=False)
    _parallel(axes[0, 0], front)
    _pair(axes[0, 1], front)
    kind = "feasible designs" if front.feasible else "designs, none of which is feasible,"
    fig.suptitle(
        f"Trade-offs: {len(front.indices)} confirmed {kind} that no other beats in every objective: {study}",
        fontsize=11,
        parse_math=False,
    )
    return fig


def _parallel(ax: Axes, front: Front) -> None:
    places = np.arange(len(front.names))
    for row in front.values[1:MOST]:
        ax.plot(places, row, color=OTHERS, lw=0.6, alpha=0.5)
    for place, color, style, text in _marked(front):
        ax.plot(places, front.values[place], style, color=color, lw=2.0, ms=5, label=text)
    ax.plot([], [], color=OTHERS, lw=0.8, label="other designs of the front")
    ax.set_xticks(places)
    ax.set_xticklabels([_name(n).replace(", ", ",\n") for n in front.names], rotation=30, ha="right")
    ax.set_xlim(-0.2, len(front.names) - 0.8)
    _scale(ax, front.values, "y")
    label(ax, None, "loss: share of the rating, sign turned (0 = targets met)")
    ax.legend(loc="best", fontsize=8)


def _pair(ax: Axes, front: Front) -> None:
    i, j, rho = most_in_conflict(front.values)
    ax.plot(front.values[:MOST, i], front.values[:MOST, j], "o", color=OTHERS, ms=3, alpha=0.7)
    for place, color, style, _ in _marked(front):
        ax.plot(front.values[place, i], front.values[place, j], style[0], color=color, ms=8)
    _scale(ax, front.values[:, [i]], "x")
    _scale(ax, front.values[:, [j]], "y")
    label(ax, f"{_name(front.names[i])}: loss", f"{_name(front.names[j])}: loss")
    words = f"rank correlation {rho:+.2f}" if np.isfinite(rho) else "one design"
    ax.set_title(f"Most in conflict ({words})", fontsize=9)


def _marked(front: Front) -> list[tuple[int, str, str, str]]:
    """Place, colour, marker with line, and words of the designs that stand out; shapes differ as well."""
    best = (0, BEST, "o-", f"best rating {front.ratings[0]:.3g}: evaluation {front.indices[0] + 1}")
    knee = front.knee
    words = f"knee, rating {front.ratings[knee]:.3g}: evaluation {front.indices[knee] + 1}"
    return [best, (knee, KNEE, "s--", words)]


def most_in_conflict(values: FloatArray) -> tuple[int, int, float]:
    """Places of the two objectives (f, g) of least rank correlation, and that; nan for fewer than 3 designs.

    Objectives that hardly differ over the front, below NARROW, count last.
    """
    if len(values) < 3:
        return 0, 1, float("nan")
    ranks = np.apply_along_axis(rankdata, 0, values)
    centred = ranks - ranks.mean(axis=0)
    size = np.linalg.norm(centred, axis=0)
    rho = centred.T @ centred / np.maximum(np.outer(size, size), 1e-12)
    narrow = np.ptp(values, axis=0) < NARROW * np.ptp(values, axis=0).max()
    judged = np.where(np.triu(np.ones_like(rho), 1) > 0, rho + 2.0 * (narrow[:, None] | narrow), np.inf)
    i, j = np.unravel_index(int(np.argmin(judged)), rho.shape)
    return int(i), int(j), float(rho[i, j])


def _scale(ax: Axes, values: FloatArray, axis: str) -> None:
    """Logarithmic when positive values span more than a factor of thirty."""
    if values.min() > 0.0 and values.max() > 30.0 * values.min():
        (ax.set_yscale if axis == "y" else ax.set_xscale)("log")


def _name(name: str) -> str:
    return "Constraint violation" if name == VIOLATION else case_label(name)


def write_pareto_figure(
    front: Front, folder: Path, *, study: str, pictures: PictureFormat = PNG
) -> list[Path]:
    """The picture `pareto_front` in `folder`; RunError when it cannot be written."""
    job = (folder / "pareto_front", partial(pareto_figure, front, study=study))
    return draw_series([job], 1, pictures=pictures)
