"""Who is taken for whom."""

from __future__ import annotations

import csv
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from benchmarks.discovery.scoring import Score
from benchmarks.discovery.truth import DELETED
from doe_kc.ground.typing import FloatArray

OTHERS = ("none", "unexplained", "failed")


@dataclass(frozen=True)
class Confusion:
    """counts: (truths, answers) cases."""

    truths: tuple[str, ...]
    answers: tuple[str, ...]
    counts: FloatArray


def confusion(found: Sequence[Score]) -> Confusion:
    """First names over what was hidden; an effect deleted from the library is a row of its own."""
    rows = [(_row(s), s.first) for s in found if " + " not in s.truth]
    truths = tuple(sorted({r for r, _ in rows}, key=_order))
    right = {t if _plain(t) else "unexplained" for t in truths}
    answers = tuple(sorted({a for _, a in rows} | right, key=_order))
    counts = np.zeros((len(truths), len(answers)))
    for truth, first in rows:
        counts[truths.index(truth), answers.index(first)] += 1
    return Confusion(truths, answers, counts)


def _row(score: Score) -> str:
    return f"deleted: {score.truth}" if score.suite == DELETED else score.truth


def _plain(name: str) -> bool:
    return ":" not in name


def _order(name: str) -> tuple[int, str]:
    return (name in OTHERS) + 2 * name.startswith("deleted:") + 3 * name.startswith("outside:"), name


def write_csv(found: Confusion, path: Path) -> None:
    """Rows: what was hidden; columns: the first name."""
    with path.open("w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["hidden", *found.answers])
        for truth, row in zip(found.truths, found.counts, strict=True):
            writer.writerow([truth, *(int(n) for n in row)])


def draw(found: Confusion, path: Path) -> None:
    """Heat map of row shares with the counts in it; one hue, light to dark, so that it prints in grey."""
    wide, high = len(found.answers), len(found.truths)
    figure = Figure(figsize=(4.2 + 0.42 * wide, 2.6 + 0.3 * high), layout="constrained")
    FigureCanvasAgg(figure)
    axes = figure.subplots()
    shares = found.counts / np.maximum(found.counts.sum(axis=1, keepdims=True), 1)
    image = axes.imshow(shares, cmap="Blues", vmin=0, vmax=1, aspect="auto")
    for (i, j), count in np.ndenumerate(found.counts):
        if count:
            colour = "white" if shares[i, j] > 0.55 else "black"
            axes.text(j, i, f"{count:.0f}", ha="center", va="center", fontsize=8, color=colour)
    for i, truth in enumerate(found.truths):
        right = truth if _plain(truth) else "unexplained"
        if right in found.answers:
            axes.add_patch(_frame(found.answers.index(right), i))
    axes.set_xticks(range(wide), [_words(a) for a in found.answers], rotation=50, ha="right", fontsize=8)
    axes.set_yticks(range(high), [_words(t) for t in found.truths], fontsize=8)
    axes.set(xlabel="named first", ylabel="hidden", title="Who is taken for whom (framed: right)")
    axes.set_xticks(np.arange(wide + 1) - 0.5, minor=True)
    axes.set_yticks(np.arange(high + 1) - 0.5, minor=True)
    axes.grid(which="minor", color="0.85", lw=0.6)
    axes.tick_params(which="minor", length=0)
    figure.colorbar(image, ax=axes, label="share of the row", shrink=0.6)
    figure.savefig(path, dpi=150)


def _frame(column: int, row: int) -> Rectangle:
    return Rectangle((column - 0.5, row - 0.5), 1, 1, fill=False, edgecolor="#D55E00", lw=1.4)


def _words(name: str) -> str:
    return name.replace("_", " ")
