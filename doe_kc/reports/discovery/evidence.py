"""Which effects the records ask for: ln posterior odds of each candidate, step by step of the search."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from textwrap import fill

import numpy as np
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from doe_kc.discovery.result import Discovery
from doe_kc.discovery.search.decision import HypothesisGain, Step
from doe_kc.discovery.thresholds import ACCEPTED_ODDS
from doe_kc.effects.hypothesis import Hypothesis
from doe_kc.effects.words import hypothesis_label, hypothesis_words
from doe_kc.reports.discovery.words import other_laws_words
from doe_kc.reports.drawing import style
from doe_kc.reports.drawing.panel import PageBox, Panel
from doe_kc.reports.drawing.panel_axis import PanelAxis
from doe_kc.reports.drawing.sheet import Sheet
from doe_kc.reports.drawing.words import POINTS, text_width

CANDIDATES_SHOWN = 9
"""Candidates of a step, best first."""
REFITTED, SCREENED, CHOSEN = style.PALETTE["orange"], "#DDE1E5", style.PALETTE["blue"]
EVIDENCE_ROW, EVIDENCE_HEAD, EVIDENCE_LINE, EVIDENCE_TOP, EVIDENCE_FOOT, EVIDENCE_WIDTH = (
    0.2,
    0.24,
    0.145,
    0.22,
    0.75,
    8.27,
)
"""Inches: a candidate; above a panel, and a line of its title; title and foot of the page; its width."""
EVIDENCE_EDGE, EVIDENCE_END = 9.0, 20.0
"""Points beside the names, and beside the panels, where half a number needs room."""
LETTER = 6.0
"""Points of a letter of a panel's title, not less than most."""
EVIDENCE_AXIS_START = -6.0
"""Left end of the axis: how much worse a candidate makes it does not matter."""


@dataclass(frozen=True)
class EvidenceBar:
    """gain: ln of the posterior odds over the set without it; refitted: after a joint refit, else as
    screened."""

    label: str
    gain: float
    refitted: bool
    accepted: bool


@dataclass(frozen=True)
class EvidenceStep:
    """One step of the search. needed: ln posterior odds that a candidate must reach."""

    title: str
    candidates: tuple[EvidenceBar, ...]
    needed: float


def evidence_steps(discovery: Discovery) -> list[EvidenceStep]:
    """Every step, the last one with nothing to add; candidates best first. A title says which members have
    another law than in the step before."""
    last = len(discovery.search.steps) - 1
    out: list[EvidenceStep] = []
    before: Sequence[Hypothesis] = ()
    for i, step in enumerate(discovery.search.steps):
        names = ", ".join(hypothesis_words(h) for h in step.members)
        title = f"Step {i + 1}: re-tuned {f'with {names}' if names else 'without an effect'}"
        changed = other_laws_words(before, step.members)
        law = f"; {changed}" if changed else ""
        end = "" if step.accepted or i < last else "; nothing more is asked for"
        out.append(EvidenceStep(title + law + end, _candidates(step), ACCEPTED_ODDS * step.temper))
        before = step.members
    return out


def _candidates(step: Step) -> tuple[EvidenceBar, ...]:
    return tuple(
        EvidenceBar(candidate_label(c), c.gain, c.joint, step.accepted and i == 0)
        for i, c in enumerate(step.candidates[:CANDIDATES_SHOWN])
    )


def candidate_label(candidate: HypothesisGain) -> str:
    """Name and place, and what came in with it, e.g. `Strut friction + steering friction`."""
    label, others = hypothesis_label(candidate.hypothesis), candidate.beside
    if len(others) > 1:
        return f"{label} + {len(others)} others"
    return " + ".join([label, *map(hypothesis_words, others)])


def evidence_figure(steps: Sequence[EvidenceStep], study: str) -> Sheet:
    """One panel a step; the axis is linear about zero and logarithmic beyond."""
    widest = max((text_width(c.label, 7.0) for s in steps for c in s.candidates), default=0.0)
    left = widest + EVIDENCE_EDGE
    titles = [fill(s.title, int((EVIDENCE_WIDTH * POINTS - left - EVIDENCE_END) / LETTER)) for s in steps]
    heads = [EVIDENCE_HEAD + EVIDENCE_LINE * (t.count("\n") + 1) for t in titles]
    deep = [EVIDENCE_ROW * max(len(s.candidates), 1) for s in steps]
    height = EVIDENCE_TOP + sum(heads) + sum(deep) + EVIDENCE_FOOT
    page = Sheet((EVIDENCE_WIDTH, height))
    largest = max((c.gain for s in steps for c in s.candidates if np.isfinite(c.gain)), default=1.0)
    axis, top = PanelAxis(), height - EVIDENCE_TOP
    for step, title, head, tall in zip(steps, titles, heads, deep, strict=True):
        top -= head + tall
        box = PageBox(left, top * POINTS, page.width - left - EVIDENCE_END, tall * POINTS)
        _panel(page.add_panel(box, axis), step, title, largest)
    for panel in page.panels[:-1]:
        panel.numbers["x"] = False
    page.panels[-1].set_labels(
        "how much more probable the set is with it (natural logarithm; 10 = 22 000 times)", None
    )
    handles: list[Line2D | Patch] = [
        Patch(color=CHOSEN, label="taken into the model"),
        Patch(color=REFITTED, label="refitted jointly, not taken"),
        Patch(fc=SCREENED, ec="#8A9199", label="screened only"),
        Line2D([], [], color="black", ls="--", lw=0.9, label="needed, a hundred to one at least"),
    ]
    page.add_legend(handles, 4)
    page.set_heading(f"Evidence for effects: {study}", 1 - 0.06 / height)
    return page


def _panel(panel: Panel, step: EvidenceStep, title: str, largest: float) -> None:
    panel.x.set_symmetrical_logarithmic(10.0)
    panel.x.set_limits(EVIDENCE_AXIS_START, max(20.0, 8.0 * largest))
    ticks = [t for t in (0, 10, 100, 1000, 10**4, 10**5, 10**6) if t < 8.0 * largest]
    panel.x.set_ticks(ticks, [f"{t:,}".replace(",", " ") for t in ticks])
    panel.y.set_limits(max(len(step.candidates), 1), 0)
    panel.set_title(title, size=8.5, weight="bold", across="left")
    panel.grid["y"] = panel.marks["y"] = False
    panel.y.set_ticks([i + 0.5 for i in range(len(step.candidates))], [c.label for c in step.candidates])
    panel.vline(0.0, color="#8A9199", lw=0.7, zorder=1.9)
    panel.vline(step.needed, (0, (4, 2)), color="black", lw=0.9, zorder=1.9)
    for y, candidate in enumerate(step.candidates):
        _bar(panel, y + 0.5, candidate)


def _bar(panel: Panel, y: float, candidate: EvidenceBar) -> None:
    colour = CHOSEN if candidate.accepted else REFITTED if candidate.refitted else SCREENED
    edge = "#8A9199" if not candidate.refitted else colour
    shown = (
        float(np.clip(candidate.gain, EVIDENCE_AXIS_START, None))
        if np.isfinite(candidate.gain)
        else EVIDENCE_AXIS_START
    )
    panel.bars(y, 0.0, shown, 0.68, [colour], edgecolors=edge, linewidths=0.5, zorder=2)
    text = f"{candidate.gain:,.{1 if abs(candidate.gain) < 1000 else 0}f}".replace("-0.0", "0.0")
    panel.text(
        max(shown, 0.0), y, text.replace(",", " "), shift=(4.0, 0.0), size=6.5,
        along="center", color="#333333", backing="white",
    )  # fmt: skip
