"""Which effects the records ask for: ln evidence of each candidate, step by step of the search."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from textwrap import fill

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from doe_kc.discovery.result import Discovery
from doe_kc.discovery.search import Step, threshold
from doe_kc.reporting import style
from doe_kc.reporting.discovery_words import hypothesis_label

SHOWN = 9
"""Candidates of a step, best first."""
REFITTED, SCREENED, CHOSEN = style.PALETTE["orange"], "#DDE1E5", style.PALETTE["blue"]
ROW = 0.2
TITLE = 78
"""Characters of a line of a panel's title."""
LEAST = -2.0
"""Left end of the axis: how much worse a candidate makes it does not matter."""


@dataclass(frozen=True)
class Candidate:
    """gain: ln evidence over the model without it; refitted: after a joint refit, else as screened."""

    label: str
    gain: float
    refitted: bool
    accepted: bool


@dataclass(frozen=True)
class EvidenceStep:
    """One step of the search. needed: ln evidence that a candidate must reach among so many."""

    title: str
    candidates: tuple[Candidate, ...]
    needed: float


def evidence_steps(found: Discovery) -> list[EvidenceStep]:
    """Every step, the last one with nothing to add; candidates best first."""
    count = len(found.search.steps[0].screened)
    last = len(found.search.steps) - 1
    out = []
    for i, step in enumerate(found.search.steps):
        names = ", ".join(hypothesis_label(h).lower() for h in step.before.model.members)
        title = f"Step {i + 1}: re-tuned with {names}" if names else "Step 1: re-tuned without an effect"
        end = "" if step.accepted or i < last else "; nothing more is asked for"
        out.append(EvidenceStep(title + end, _candidates(step), threshold(count) * step.temper))
    return out


def _candidates(step: Step) -> tuple[Candidate, ...]:
    refitted = {t.hypothesis.name for t in step.trials}
    rows = [
        Candidate(hypothesis_label(t.hypothesis), t.gain, True, step.accepted and i == 0)
        for i, t in enumerate(step.trials)
    ]
    others = [s for s in step.screened if s.hypothesis.name not in refitted and not s.failed]
    rows += [Candidate(hypothesis_label(s.hypothesis), s.gain, False, False) for s in others]
    return tuple(rows[:SHOWN])


def evidence_figure(steps: Sequence[EvidenceStep], study: str) -> Figure:
    """One panel a step; the axis is linear about zero and logarithmic beyond."""
    rows = [max(len(s.candidates), 1) for s in steps]
    height = ROW * sum(rows) + 0.7 * len(steps) + 1.1
    fig, axes = style.figure(len(steps), 1, size=(8.27, height), share_x=True)
    grid = axes[0, 0].get_gridspec()
    grid.set_height_ratios(rows)
    largest = max((c.gain for s in steps for c in s.candidates if np.isfinite(c.gain)), default=1.0)
    for ax, step in zip(axes[:, 0], steps, strict=True):
        _panel(ax, step, largest)
    axes[-1, 0].set_xlabel("ln evidence gained over the model without it")
    axes[-1, 0].tick_params(labelbottom=True)
    handles = [
        Patch(color=CHOSEN, label="taken into the model"),
        Patch(color=REFITTED, label="refitted jointly, not taken"),
        Patch(fc=SCREENED, ec="#8A9199", label="screened only"),
        Line2D([], [], color="black", ls="--", lw=0.9, label="needed among so many candidates"),
    ]
    fig.legend(handles=handles, loc="outside lower center", ncols=4, fontsize=7, frameon=False)
    fig.suptitle(f"Evidence for effects: {study}", fontsize=11, parse_math=False)
    return fig


def _panel(ax: Axes, step: EvidenceStep, largest: float) -> None:
    ax.set_xscale("symlog", linthresh=10.0, linscale=1.0)
    ax.set_xlim(LEAST, max(20.0, 8.0 * largest))
    ticks = [t for t in (0, 10, 100, 1000, 10**4, 10**5, 10**6) if t < 8.0 * largest]
    ax.set_xticks(ticks, [f"{t:,}".replace(",", " ") for t in ticks])
    ax.set_ylim(max(len(step.candidates), 1), 0)
    ax.set_title(fill(step.title, TITLE), loc="left", fontsize=8.5, fontweight="bold", parse_math=False)
    ax.grid(visible=False, axis="y")
    ax.minorticks_off()
    ax.tick_params(axis="y", length=0)
    ax.set_yticks([i + 0.5 for i in range(len(step.candidates))], [c.label for c in step.candidates])
    ax.axvline(0.0, color="#8A9199", lw=0.7)
    ax.axvline(step.needed, color="black", lw=0.9, ls=(0, (4, 2)))
    for y, candidate in enumerate(step.candidates):
        _bar(ax, y + 0.5, candidate)


def _bar(ax: Axes, y: float, candidate: Candidate) -> None:
    colour = CHOSEN if candidate.accepted else REFITTED if candidate.refitted else SCREENED
    edge = "#8A9199" if not candidate.refitted else colour
    shown = float(np.clip(candidate.gain, LEAST, None)) if np.isfinite(candidate.gain) else LEAST
    ax.barh(y, shown, height=0.68, color=colour, ec=edge, lw=0.5, zorder=2)
    text = f"{candidate.gain:,.{1 if abs(candidate.gain) < 1000 else 0}f}".replace("-0.0", "0.0")
    ax.annotate(
        text.replace("-", "−").replace(",", " "), (max(shown, 0.0), y), xytext=(4, 0),
        textcoords="offset points", fontsize=6.5, va="center", color="#333333",
    )  # fmt: skip
