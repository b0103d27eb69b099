"""The report of one run: results/discovery.md, .csv, and pictures."""

from __future__ import annotations

import csv
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from benchmarks.discovery.confusion import confusion, draw, write_csv
from benchmarks.discovery.reliability_diagram import draw_reliability
from benchmarks.discovery.scoring import Score
from benchmarks.discovery.table import (
    calibration_lines,
    closed_lines,
    excluded_wrongly,
    false_names,
    followup_lines,
    located,
    members_named,
    parameter_lines,
    small_effect_lines,
    suite_table,
)

COLUMNS = (
    "name",
    "suite",
    "truth",
    "verdict",
    "first",
    "names",
    "exact",
    "found",
    "top",
    "in_class",
    "wrong",
    "trace",
    "missed",
    "unexplained",
    "placed",
    "closed",
    "decoy",
    "diagnosable",
    "seconds",
)


@dataclass(frozen=True)
class Run:
    """What a run was: its command, base vehicle, seed, code and machine."""

    command: str
    base: str
    seed: int
    code: str
    machine: str


def lines(found: Sequence[Score], run: Run, followed: Sequence[Score] = ()) -> list[str]:
    """Markdown. followed: of the cars whose advised tests were carried out, after these."""
    seconds = np.array([s.seconds for s in found if np.isfinite(s.seconds)])
    took = f"{np.median(seconds):.0f} s, longest {seconds.max():.0f} s" if seconds.size else "-"
    return [
        "# Discovery: which hidden effects are named",
        "",
        f"`{run.command}`, base vehicle {run.base}, seed {run.seed}, code {run.code}. {run.machine}.",
        f"{len(found)} cars, median time a car {took}. Keys were sealed before the analysis.",
        "",
        "Effects are hidden by other laws than the analyser's (Prandtl-Iwan friction, tabulated bushings, "
        "compliances that stiffen with load), in cars with production scatter, unequal sides and small "
        "shares of all other effects. Diagnosable: the true change of the curves stands out of re-tuning, "
        "of the sides' usual differences and of other sizes of those small shares by 10 standard "
        "deviations, and noise names the most similar rival in at most 5 % of cars.",
        "",
        "Percent of the cars, with the Wilson interval of 95 %.",
        "",
        *suite_table(found),
        "",
        "- Hidden effects that are named, also beside something unexplained, of those diagnosable by "
        f"themselves: {members_named(found)} (target >= 90 % of cars with several); false names: "
        f"{false_names(found)} (target <= 5 %)",
        f"- Place right, of rightly named effects that have one: {located(found)}",
        f"- Excluded below their true size, of hidden effects that are not named: {excluded_wrongly(found)}",
        *parameter_lines(found),
        *small_effect_lines(found),
        *closed_lines(found),
        *followup_lines(found, followed),
        *calibration_lines(found),
        "",
        "![Stated probabilities and how often they are right](discovery_reliability.png)",
        *(["", "![Who is taken for whom](discovery.png)"] if confusion(found).truths else []),
    ]


def write(found: Sequence[Score], run: Run, folder: Path, followed: Sequence[Score] = ()) -> list[str]:
    """All files; returns the text."""
    folder.mkdir(parents=True, exist_ok=True)
    text = lines(found, run, followed)
    (folder / "discovery.md").write_text("\n".join(text) + "\n")
    with (folder / "discovery.csv").open("w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(COLUMNS)
        for s in found:
            writer.writerow([_cell(getattr(s, column)) for column in COLUMNS])
    matrix = confusion(found)
    write_csv(matrix, folder / "discovery_confusion.csv")
    if matrix.truths:  # none of cars with several effects alone
        draw(matrix, folder / "discovery.png")
    draw_reliability([b for s in found for b in s.believed], folder / "discovery_reliability.png")
    return text


def _cell(value: object) -> object:
    if isinstance(value, bool):
        return int(value)
    if isinstance(value, float):
        return f"{value:.4g}"
    if isinstance(value, tuple):
        return " ".join(str(v) for v in value)
    return "" if value is None else value
