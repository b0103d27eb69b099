"""Picture of a front of trade-offs: every design over the objectives, and the pair most in conflict."""

from __future__ import annotations

from functools import partial
from pathlib import Path

import numpy as np
from matplotlib.lines import Line2D
from matplotlib.ticker import FuncFormatter, SymmetricalLogLocator

from doe_kc.correlation.front import VIOLATION, Front
from doe_kc.ground.errors import InputError
from doe_kc.ground.picture_format import PNG, PictureFormat
from doe_kc.ground.typing import FloatArray
from doe_kc.load_cases import case_label
from doe_kc.reports.drawing.panel import Dash, Panel
from doe_kc.reports.drawing.panel_axis import PanelAxis
from doe_kc.reports.drawing.series import draw_series
from doe_kc.reports.drawing.sheet import Sheet, sheet
from doe_kc.reports.drawing.style import PALETTE

PARETO_SIZE = (11.69, 5.4)
PARETO_MARGINS = {"left": 0.065, "right": 0.985, "top": 0.86, "bottom": 0.2, "wspace": 0.14}
DESIGNS_DRAWN = 300
"""Designs drawn, best ratings first: more lines hide each other."""
NARROW = 0.05
"""Share of the widest range below which an objective is in no conflict worth a picture."""
OTHERS, BEST, KNEE = PALETTE["grey"], PALETTE["blue"], PALETTE["vermillion"]


def pareto_figure(front: Front, *, study: str) -> Sheet:
    """Parallel coordinates of the front, and its designs over the two objectives most in conflict.

    InputError for an empty front.
    """
    if not len(front.indices):
        raise InputError(f"{study}: the front is empty, no design has an answer; nothing to draw.")
    page, panels = sheet(
        1, 2, size=PARETO_SIZE, width_ratios=(2.1, 1.0), share_x=False, margins=PARETO_MARGINS
    )
    left, right = panels[0]
    handles = _parallel(left, front)
    page.add_legend(handles, 3, 8.0, ("left", "bottom"), (left.box.left, left.box.top))
    _pair(right, front)
    kind = "feasible designs" if front.feasible else "designs, none of which is feasible,"
    page.set_heading(
        f"Trade-offs: {len(front.indices)} confirmed {kind} that no other beats in every objective: {study}",
        0.985,
    )
    return page


def _parallel(panel: Panel, front: Front) -> list[Line2D]:
    """Lines with a word in the legend."""
    _scale(panel.y, front.values)
    places = np.arange(len(front.names))
    for row in front.values[1:DESIGNS_DRAWN]:
        panel.plot(places, row, color=OTHERS, lw=0.6, alpha=0.5)
    shown = [
        panel.plot(places, front.values[place], dash, marker=marker, color=color, lw=2.0, ms=5, label=text)
        for place, color, marker, dash, text in _marked(front)
    ]
    panel.x.set_ticks(places, [_name(n).replace(", ", ",\n") for n in front.names])
    panel.number_angle["x"] = 30.0
    panel.x.set_limits(-0.2, len(front.names) - 0.8)
    panel.set_labels(None, "loss: share of the rating, sign turned (0 = targets met)")
    return [*shown, Line2D([], [], color=OTHERS, lw=0.8, label="other designs of the front")]


def _pair(panel: Panel, front: Front) -> None:
    i, j, rho = most_in_conflict(front.values)
    _scale(panel.x, front.values[:, [i]])
    _scale(panel.y, front.values[:, [j]])
    panel.plot(
        front.values[:DESIGNS_DRAWN, i],
        front.values[:DESIGNS_DRAWN, j],
        "",
        marker="o",
        color=OTHERS,
        ms=3,
        alpha=0.7,
    )
    for place, color, marker, *_ in _marked(front):
        panel.plot(front.values[place, i], front.values[place, j], "", marker=marker, color=color, ms=8)
    panel.set_labels(f"{_name(front.names[i])}: loss", f"{_name(front.names[j])}: loss")
    words = f"rank correlation {rho:+.2f}" if np.isfinite(rho) else "one design"
    panel.set_title(f"Most in conflict ({words})")


def _marked(front: Front) -> list[tuple[int, str, str, Dash, str]]:
    """Place, colour, marker, dash and words of the designs that stand out; shapes differ as well."""
    best: tuple[int, str, str, Dash, str] = (
        0,
        BEST,
        "o",
        "-",
        f"best rating {front.ratings[0]:.3g}: evaluation {front.indices[0] + 1}",
    )
    knee = front.knee
    words = f"knee, rating {front.ratings[knee]:.3g}: evaluation {front.indices[knee] + 1}"
    return [best, (knee, KNEE, "s", "--", words)]


def most_in_conflict(values: FloatArray) -> tuple[int, int, float]:
    """Places of the two objectives (f, g) of least rank correlation, and that; nan for fewer than 3 designs.

    Objectives that hardly differ over the front, below NARROW, count last.
    """
    if len(values) < 3:
        return 0, 1, float("nan")
    from scipy.stats import rankdata  # takes half a second

    ranks = np.apply_along_axis(rankdata, 0, values)
    centred = ranks - ranks.mean(axis=0)
    size = np.linalg.norm(centred, axis=0)
    rho = centred.T @ centred / np.maximum(np.outer(size, size), 1e-12)
    narrow = np.ptp(values, axis=0) < NARROW * np.ptp(values, axis=0).max()
    judged = np.where(np.triu(np.ones_like(rho), 1) > 0, rho + 2.0 * (narrow[:, None] | narrow), np.inf)
    i, j = np.unravel_index(int(np.argmin(judged)), rho.shape)
    return int(i), int(j), float(rho[i, j])


def _scale(axis: PanelAxis, values: FloatArray) -> None:
    """Logarithmic where values span more than a factor of thirty; linear from 0 to a decade below the median
    of the positive ones where some are zero."""
    positive = values[values > 0.0]
    if not positive.size or values.max() <= 30.0 * values.min():
        return
    if values.min() > 0.0:
        axis.set_logarithmic()
    elif positive.max() > 30.0 * np.median(positive):
        linear = float(10.0 ** np.floor(np.log10(np.median(positive))))
        axis.set_symmetrical_logarithmic(linear)
        axis.set_locator(
            SymmetricalLogLocator(base=10, linthresh=linear), FuncFormatter(lambda v, _: f"{v:g}")
        )


def _name(name: str) -> str:
    return "Constraint violation" if name == VIOLATION else case_label(name)


def write_pareto_figure(
    front: Front, folder: Path, *, study: str, pictures: PictureFormat = PNG
) -> list[Path]:
    """The picture `pareto_front` in `folder`; RunError when it cannot be written."""
    job = (folder / "pareto_front", partial(pareto_figure, front, study=study))
    return draw_series([job], 1, pictures=pictures)
