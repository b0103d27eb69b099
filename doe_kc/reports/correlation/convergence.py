"""How the merit of the search rose over the true-solver evaluations."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.lines import Line2D
from matplotlib.ticker import FuncFormatter, MaxNLocator, SymmetricalLogLocator

from doe_kc.correlation.result import Correlation
from doe_kc.reports.correlation.evaluations import History, history
from doe_kc.reports.drawing import style
from doe_kc.reports.drawing.panel import PageBox, Panel
from doe_kc.reports.drawing.sheet import Sheet
from doe_kc.reports.drawing.style import MARKERS
from doe_kc.reports.drawing.words import POINTS, text_width

CONVERGENCE_SIZE = (8.27, 4.6)
LEFT_MARGIN, BOTTOM_MARGIN, TOP_MARGIN = 0.72 * POINTS, 0.52 * POINTS, 0.34 * POINTS
CONVERGENCE_KEY = 34.0
"""Points beside the words of the legend."""
FAILED = style.PALETTE["vermillion"]
FAILURE_BAND = 3.0
"""Half-decades kept free above the worst rating for the marks of failures."""


def convergence_figure(correlation: Correlation, study: str) -> Sheet:
    """Minus what the search maximizes, symmetric logarithmic, over the evaluations: 0 = every target met
    exactly. With the objective "thesis" it is the rating."""
    past = history(correlation)
    page = Sheet(CONVERGENCE_SIZE)
    panel = page.add_panel(
        PageBox(
            LEFT_MARGIN, BOTTOM_MARGIN, page.width - LEFT_MARGIN, page.height - BOTTOM_MARGIN - TOP_MARGIN
        )
    )
    _scale(panel, past)
    panel.plot(
        np.repeat(past.number, 2)[1:], np.repeat(-past.best, 2)[:-1], color=style.PALETTE["black"], lw=1.2,
        label="best so far",
    )  # fmt: skip
    for k, origin in enumerate(past.origins):
        _origin(
            panel, past, origin, style.COLOUR_CYCLE[k % len(style.COLOUR_CYCLE)], MARKERS[k % len(MARKERS)]
        )
    handles = [line for line in panel.lines if not str(line.get_label()).startswith("_")]
    handles += [*_predicted(panel, past), *_failed(panel, past), *_feasible(panel, past)]
    panel.set_labels("true-solver evaluation (1 = baseline)", "minus merit of the search [-], symmetric log")
    panel.x.set_locator(MaxNLocator(9, integer=True, steps=[1, 2, 2.5, 5, 10]))
    panel.x.set_limits(0.4, past.number[-1] + 0.9)
    panel.set_title(f"Convergence of {correlation.method}: {study}", size=10.0)
    words = max(text_width(str(h.get_label()), 7.0) for h in handles)
    width = page.width - LEFT_MARGIN - words - CONVERGENCE_KEY
    panel.box = PageBox(LEFT_MARGIN, BOTTOM_MARGIN, width, panel.box.height)
    page.add_legend(handles, 1, 7.0, ("left", "top"), (panel.box.right, panel.box.top))
    return page


def threshold(past: History) -> float:
    """Size below which the scale is linear: a decade under the smallest rating that was found."""
    sizes = np.abs(past.rating[np.isfinite(past.rating) & (past.rating != 0.0)])
    return float(10.0 ** np.floor(np.log10(sizes.min()))) if sizes.size else 1.0


def _scale(panel: Panel, past: History) -> None:
    linear = threshold(past)
    panel.y.set_symmetrical_logarithmic(linear)
    locator = SymmetricalLogLocator(base=10, linthresh=linear)
    panel.y.set_locator(locator, FuncFormatter(lambda v, _: f"{v:g}"))
    sizes = -past.rating[np.isfinite(past.rating)]
    top = max(float(sizes.max(initial=linear)), linear)
    panel.y.set_limits(min(0.0, 1.3 * float(sizes.min(initial=0.0))), top * FAILURE_BAND)


def _origin(panel: Panel, past: History, origin: str, colour: str, marker: str) -> None:
    own = np.array([o == origin for o in past.origin]) & ~past.failed
    look: dict[str, Any] = {"dash": "", "color": colour, "marker": marker, "ms": 5, "mew": 1.0}
    for mask, face, word in (
        (own & past.feasible, colour, ""),
        (own & ~past.feasible, "white", ", infeasible"),
    ):
        if mask.any():
            panel.plot(
                past.number[mask], -past.rating[mask], **look, mfc=face, zorder=3, label=f"{origin}{word}",
            )  # fmt: skip


def _predicted(panel: Panel, past: History) -> list[Line2D]:
    known = np.isfinite(past.predicted)
    if not known.any():
        return []
    at, value, sd = past.number[known] + 0.28, -past.predicted[known], np.nan_to_num(past.sd[known])
    grey = style.PALETTE["grey"]
    panel.segments(at, value - sd, at, value + sd, colors=grey, linewidths=0.8, zorder=2)
    for end in (value - sd, value + sd):
        panel.plot(at, end, "", marker="_", color=grey, ms=3, mew=1.0, zorder=2)
    mark = panel.plot(at, value, "", marker="_", color=grey, ms=5, zorder=2, label="predicted ± sd")
    return [mark]


def _failed(panel: Panel, past: History) -> list[Line2D]:
    if not past.failed.any():
        return []
    cross = panel.plot(
        past.number[past.failed], np.full(past.failed.sum(), 0.97), "", marker="x", color=FAILED,
        scales=("data", "panel"), ms=6, mew=1.4, label="no equilibrium",
    )  # fmt: skip
    return [cross]


def _feasible(panel: Panel, past: History) -> list[Line2D]:
    first = past.first_feasible
    if first is None:
        return []
    panel.vspan(first - 0.5, past.number[-1] + 0.9, color="#EAF3EA", zorder=0)
    words = f"feasible from evaluation {first}"
    return [panel.vline(first - 0.5, color=style.PALETTE["green"], lw=1, label=words)]
