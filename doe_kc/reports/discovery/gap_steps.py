"""The gap falling step by step, down to the noise of the rig."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import accumulate
from textwrap import fill

from doe_kc.discovery.result import Discovery
from doe_kc.effects.hypothesis import Hypothesis
from doe_kc.effects.words import hypothesis_words
from doe_kc.reports.discovery.gaps import MODEL_COLOURS
from doe_kc.reports.discovery.words import other_laws_words
from doe_kc.reports.drawing import style
from doe_kc.reports.drawing.panel import PageBox
from doe_kc.reports.drawing.sheet import Sheet
from doe_kc.reports.drawing.words import POINTS, text_width


@dataclass(frozen=True)
class GapStep:
    """label: what was done. gap: whitened RMS of all records then, in units of their own errors."""

    label: str
    gap: float


def gap_steps(discovery: Discovery) -> list[GapStep]:
    """In the order of the search; the last one is the axle handed over. Effects that the search took back
    are named with the step that did so."""
    out = [GapStep("model as handed in", discovery.gap.nominal), GapStep("re-tuned", discovery.gap.tuned)]
    before: Sequence[Hypothesis] = ()
    for step in discovery.search.steps[1:]:
        if list(step.members) != list(before):
            out.append(GapStep(_changed(before, step.members), step.gap))
        before = step.members
    last = discovery.fitted.model.members
    if list(last) != list(before):
        out.append(GapStep(_changed(before, last), discovery.gap.with_effect))
    elif last:
        out[-1] = GapStep(out[-1].label, discovery.gap.with_effect)
    return out


def _changed(before: Sequence[Hypothesis], after: Sequence[Hypothesis]) -> str:
    """`+ steering friction`, `− strut bending`, `other law of strut friction`."""
    known, left = ({h.name for h in members} for members in (before, after))
    new = [f"+ {hypothesis_words(h)}" for h in after if h.name not in known]
    gone = [f"− {hypothesis_words(h)}" for h in before if h.name not in left]
    changed = other_laws_words(before, after)
    return ", ".join([*new, *gone, *([changed] if changed else [])]) or "refitted"


STEPS_WIDTH, STEPS_ROW, STEPS_TOP, STEPS_FOOT = 8.0, 0.34, 0.22, 0.55
"""Inches: width; a step; above and below them."""
STEPS_LINE = 0.145
"""Inches: a line of a step's name, of which a step has room for two."""
STEPS_LETTERS = 52
"""Letters of a line of a step's name."""
STEPS_RIGHT = 46.0
"""Points right of the bars, for the number of the longest."""


def gap_steps_figure(steps: Sequence[GapStep], noise: float) -> Sheet:
    """A bar a step, its number at the end. noise: what noise alone leaves, the dashed line."""
    labels = [fill(s.label, STEPS_LETTERS) for s in steps]
    rows = [1.0 + STEPS_LINE / STEPS_ROW * max(0, label.count("\n") - 1) for label in labels]
    ends = list(accumulate(rows))
    middles = [end - row / 2.0 for end, row in zip(ends, rows, strict=True)]
    tall = STEPS_ROW * ends[-1]
    page = Sheet((STEPS_WIDTH, STEPS_TOP + tall + STEPS_FOOT))
    left = max(text_width(label, 8.0) for label in labels) + 10.0
    panel = page.add_panel(PageBox(left, STEPS_FOOT * POINTS, page.width - left - STEPS_RIGHT, tall * POINTS))
    longest = max(s.gap for s in steps)
    panel.x.set_limits(0.0, longest * 1.02)
    panel.y.set_limits(ends[-1], 0)
    panel.y.set_ticks(middles, labels)
    panel.number_size["y"] = 8.0
    panel.grid["y"] = panel.marks["y"] = False
    panel.set_labels("deviation of all records from the model, times the noise of the rig", None)
    colours = [_colour(i, len(steps)) for i in range(len(steps))]
    panel.bars(middles, 0.0, [s.gap for s in steps], 0.62, colours)
    for middle, step in zip(middles, steps, strict=True):
        panel.text(step.gap, middle, f"{step.gap:.2f} ×", shift=(4.0, 0.0), size=8.0, along="center")
    panel.vline(noise, (0, (4, 2)), color=style.PALETTE["black"], lw=1.0, zorder=3)
    panel.text(noise, 0.0, "noise of the rig", shift=(0.0, 4.0), size=7.5, across="center", color="#333333")
    return page


def _colour(step: int, count: int) -> str:
    if step < 2:
        return MODEL_COLOURS["nominal" if step == 0 else "tuned"]
    return MODEL_COLOURS["with_effect"] if step == count - 1 else style.PALETTE["sky"]
