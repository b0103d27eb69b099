"""How many more designs: table, lines, document and picture of a surrogate study's learning curve."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from doe_kc.characteristics import Characteristic
from doe_kc.load_cases import case_label
from doe_kc.reports.drawing.panel import Panel
from doe_kc.reports.drawing.sheet import Sheet, sheet
from doe_kc.reports.drawing.style import PALETTE
from doe_kc.reports.render.json import table_records
from doe_kc.reports.table import Column, SheetLayout, Table, Value
from doe_kc.surrogate_models.learning_curve import CURVE_REACH, LearningCurve
from doe_kc.surrogate_models.report import SurrogateReport

LEARNING_PANELS = 5
"""Columns of small multiples."""
NAMED = 3
"""Characteristics that need most designs, named in the terminal."""
ROUND_NUMBERS = tuple(m * 10.0**k for k in range(-4, 6) for m in (1.0, 2.0, 5.0))
"""Numbers of the axes."""
NEVER_CHANGES = "never changes"


@dataclass(frozen=True)
class LearningRow:
    """Q2 from half the designs and as cross-validated, rate of the error, and designs for the goal with
    limits; None for a characteristic that does not vary."""

    entry: Characteristic
    model: str
    half: float | None
    q2: float | None
    rate: float
    needed: float | None
    low: float | None
    high: float | None


LEARNING_COLUMNS: tuple[Column[LearningRow], ...] = (
    Column("characteristic", "Characteristic", lambda r: r.entry.id, width=34, words=lambda r: r.entry.label),
    Column("load_case", "Load case", lambda r: case_label(r.entry.load_case), width=24, csv=False),
    Column("model", "Model", lambda r: r.model, width=12),
    Column("q2_half", "Q2 of half the designs", lambda r: r.half, "0.0000", 12),
    Column("q2", "Q2", lambda r: r.q2, "0.0000", 12),
    Column("rate", "Rate", lambda r: r.rate, "0.00", 9, json="rate"),
    Column("designs", "Designs for the goal", lambda r: r.needed, "0", 12, json="designs"),
    Column("designs_low", "at least", lambda r: r.low, "0", 12, json="low"),
    Column("designs_high", "at most", lambda r: r.high, "0", 12, json="high"),
)


def learning_table(report: SurrogateReport, curve: LearningCurve) -> Table[LearningRow]:
    """One row a characteristic."""
    best, low, high = curve.needed(report.goal)
    half, whole = 1.0 - curve.errors**2
    rows = [
        LearningRow(
            entry, model, _known(half[j]), _known(whole[j]), float(curve.rate[j]), _known(best[j]),
            _known(low[j]), _known(high[j]),
        )
        for j, (entry, model) in enumerate(
            zip(report.designs.characteristics, report.fitted.chosen, strict=True)
        )
    ]  # fmt: skip
    remark = (
        f"Designs for Q2 = {report.goal:g}, from {len(report.designs.x)}; followed from half to "
        f"{CURVE_REACH:g} times as many."
    )
    layout = SheetLayout(frozen="model", single=True, first=("load_case", "characteristic", "model"))
    return Table("Learning curve", remark, LEARNING_COLUMNS, rows, title="Learning curve", sheet=layout)


def _known(value: float) -> float | None:
    return float(value) if np.isfinite(value) else None


def learning_document(report: SurrogateReport) -> dict[str, dict[str, Value]]:
    """Characteristic -> designs for the goal with limits, and the rate."""
    if report.curve is None:
        return {}
    table = learning_table(report, report.curve)
    return dict(zip((r.entry.id for r in table.rows), table_records(table), strict=True))


def learning_lines(report: SurrogateReport) -> list[str]:
    """For a terminal: what has reached the goal, and what needs most designs to."""
    if report.curve is None:
        return []
    rows = [r for r in learning_table(report, report.curve).rows if r.needed is not None]
    behind = [r for r in rows if r.q2 is not None and r.q2 < report.goal]
    lines = [f"Q2 of {report.goal:g}: {len(rows) - len(behind)} of {len(rows)} characteristics are there"]
    for r in sorted(behind, key=lambda r: -(r.needed or 0.0))[:NAMED]:
        assert r.needed is not None
        assert r.low is not None
        assert r.high is not None
        lines.append(f"  {r.entry.id}: at about {r.needed:.0f} designs ({r.low:.0f} to {r.high:.0f})")
    return lines


def learning_curves(report: SurrogateReport, curve: LearningCurve, *, study: str) -> Sheet:
    """One panel a characteristic: left-out error over designs, measured and followed on, and the goal."""
    entries = report.designs.characteristics
    rows = -(-len(entries) // LEARNING_PANELS)
    height = 1.3 + 2.05 * rows
    margins = {"left": 0.075, "right": 0.985, "wspace": 0.4, "hspace": 0.62}
    margins |= {"bottom": 0.6 / height, "top": 1.0 - 1.25 / height}
    page, panels = sheet(rows, LEARNING_PANELS, size=(11.69, height), share_x=False, margins=margins)
    needed = curve.needed(report.goal)
    for j, panel in enumerate(panels.flat[: len(entries)]):
        _learning_panel(panel, report, curve, j, tuple(float(n[j]) for n in needed))
    del page.panels[len(entries) :]
    for panel in panels[:, 0]:
        panel.set_labels(None, "error / spread [%]")
    for panel in page.panels[-LEARNING_PANELS:]:
        panel.set_labels("designs", None)
    goal = f"goal Q² {report.goal:g}, where it is reached with its 95 % limits"
    page.set_heading(f"Learning curves: {study}\n(vermillion: {goal})", 1.0 - 0.1 / height)
    return page


def _learning_panel(
    panel: Panel, report: SurrogateReport, curve: LearningCurve, j: int, needed: tuple[float, ...]
) -> None:
    entry, goal = report.designs.characteristics[j], 100.0 * np.sqrt(1.0 - report.goal)
    head = f"{case_label(entry.load_case)}\n{entry.label}"
    panel.x.set_logarithmic()
    panel.y.set_logarithmic()
    if not np.isfinite(needed[0]):
        panel.set_title(f"{head}\n{NEVER_CHANGES}", size=6.5)
        panel.x.set_limits(10.0, 1000.0)
        panel.y.set_limits(0.1, 100.0)
        return
    first, last = curve.sizes[0], max(8.0 * curve.sizes[1], 1.2 * needed[2])
    sizes = np.geomspace(first, last, 40)
    errors = 100.0 * curve.errors[:, j]
    line = 100.0 * np.array([curve.error(n)[j] for n in sizes])
    beyond = sizes > curve.sizes[1]
    panel.plot(sizes, line, color=PALETTE["sky"], lw=1.0, dash="-", zorder=1)
    panel.plot(curve.sizes, errors, "", marker="o", ms=4.0, mew=0, color=PALETTE["blue"], zorder=2)
    panel.hline(goal, color=PALETTE["vermillion"], lw=0.8)
    panel.plot(needed[1:], [goal, goal], color=PALETTE["vermillion"], lw=2.4, zorder=3)
    panel.plot(needed[:1], [goal], "", marker="o", ms=4.5, mew=0, color=PALETTE["vermillion"], zorder=3)
    panel.x.set_limits(0.8 * min(first, needed[1]), 1.1 * last)
    low = min(goal, float(line[beyond].min() if beyond.any() else line.min()))
    panel.y.set_limits(0.7 * low, 1.5 * max(goal, float(errors.max())))
    for axis in (panel.x, panel.y):
        shown = [t for t in ROUND_NUMBERS if axis.limits[0] <= t <= axis.limits[1]]
        axis.set_ticks(shown, [f"{t:g}" for t in shown])
    words = f"{needed[0]:.0f} ({needed[1]:.0f} to {needed[2]:.0f})"
    there = errors[1] <= goal
    panel.set_title(f"{head}\n{'is there' if there else words}", size=6.5)
