"""The results as markdown tables."""

from __future__ import annotations

import importlib.metadata
import math
from collections.abc import Callable, Sequence
from datetime import UTC, datetime

import numpy as np
from _common import machine
from optimizers.figures import (
    LEVELS,
    OURS,
    best_rating,
    median,
    to_feasible,
    to_level,
    to_rating,
    used,
    worst,
)
from optimizers.peer import Peer
from optimizers.running import CODE, PEERS, Result, problem
from optimizers.text import CONDITIONS, reading
from optimizers.truth import true_car

PACKAGES = ("numpy", "scipy", "torch", "botorch", "optuna", "cma", "DFO-LS", "cobyqa", "pymoo", "smt")
HEAD = (
    "| method | sees | seeds | 10 % | 1 % | 0.1 % | feasible | as the true car | "
    "rating at 50 | at 100 | at 300 | budget used | own CPU s / evaluation |"
)
RULE = "|---|---|---|---|---|---|---|---|---|---|---|---|---|"


def report(found: Sequence[Result], overhead: str, command: str) -> list[str]:
    """The whole page."""
    runs = {p.id: [r for r in found if r.peer == p.id] for p in PEERS}
    there = [p for p in PEERS if runs[p.id]]
    rating, deviation = true_car()
    size = problem().space.dimension
    return [
        "# Optimizers",
        "",
        f"{datetime.now(UTC):%Y-%m-%d}, `{command}`, {machine()}, one thread, other work on the "
        f"machine, source {CODE}. Peers' runs are of the same problem, maybe of an earlier source of ours.",
        ", ".join(f"{name} {_version(name)}" for name in PACKAGES) + ".",
        "",
        *CONDITIONS.format(size=size, rating=rating, share=100.0 * deviation / _start(found)).splitlines(),
        "",
        HEAD,
        RULE,
        *(_row(p, runs[p.id], rating) for p in there),
        "",
        *_absent(runs),
        *(line for name in OURS for line in _ratios(there, runs, name)),
        f"- {overhead}" if overhead else "",
        *_slopes(runs),
        *reading(PEERS, runs),
        "",
        "![Best deviation and best rating so far](optimizers.png)",
    ]


def _row(peer: Peer, runs: Sequence[Result], true_rating: float) -> str:
    figures = [to_level(x) for x in LEVELS] + [to_feasible, to_rating(true_rating)]
    spent = used(runs)
    cells = " | ".join(_cell(runs, f) for f in figures)
    cpu = np.median([r.own_cpu / len(r.rating) for r in runs])
    name = f"**{peer.label}**" if peer.ours else peer.label
    return (
        f"| {name} | {peer.sees} | {len(runs)} | {cells} | "
        + " | ".join(_rating(runs, within) for within in (50, 100, 300))
        + f" | {spent} | {cpu:.2g} |"
    )


def _rating(runs: Sequence[Result], within: int) -> str:
    """Median best rating; a dash where a budget ended before that many."""
    full = all(len(r.rating) >= within or not r.stopped.endswith("used up") for r in runs)
    return f"{best_rating(runs, within):.3g}" if full else "–"


def _cell(runs: Sequence[Result], figure: Callable[[Result], float]) -> str:
    """Median (worst); "not in N" where fewer than half of the runs get there."""
    middle, last = median(runs, figure), worst(runs, figure)
    if not math.isfinite(middle):
        return f"not in {used(runs)}"
    return f"{middle:.0f} ({last:.0f})" if math.isfinite(last) else f"{middle:.0f} (not in {used(runs)})"


def _ratios(there: Sequence[Peer], runs: dict[str, list[Result]], to: str) -> list[str]:
    """Median evaluations of each peer over those of a row of ours; a lower bound where it never arrives."""
    if not runs[to]:
        return []
    lines = [
        f"## Ratios to {OURS[to]}",
        "",
        "| peer | sees | 10 % | 1 % | 0.1 % | feasible |",
        "|---|---|---|---|---|---|",
    ]
    for peer in (p for p in there if not p.ours):
        cells = [_ratio(runs[peer.id], runs[to], f) for f in [*map(to_level, LEVELS), to_feasible]]
        lines.append(f"| {peer.label} | {peer.sees} | {' | '.join(cells)} |")
    return [*lines, ""]


def _ratio(runs: Sequence[Result], own: Sequence[Result], figure: Callable[[Result], float]) -> str:
    ours, theirs = median(own, figure), median(runs, figure)
    if not math.isfinite(ours):
        return "–"
    return f"{theirs / ours:.1f}" if math.isfinite(theirs) else f"> {used(runs) / ours:.1f} (not reached)"


def _absent(runs: dict[str, list[Result]]) -> list[str]:
    gone = [
        f"{p.label} ({'not installed' if not p.installed else 'not run'})" for p in PEERS if not runs[p.id]
    ]
    return [f"Left out: {', '.join(gone)}.", ""] if gone else []


def _slopes(runs: dict[str, list[Result]]) -> list[str]:
    lines = []
    for name in ("ego", "gauss_newton"):
        if found := runs[name]:
            number = np.median([r.expansions for r in found])
            cost = np.median([r.expansion_cpu for r in found])
            solve = np.median([r.solver_cpu / len(r.rating) for r in found])
            lines.append(
                f"- `{name}` also took {number:.0f} exact sensitivities a run, {cost:.2f} s each, the time "
                f"of {cost / solve:.0f} evaluations, which the table does not count."
            )
    return [*lines, ""]


def _start(found: Sequence[Result]) -> float:
    return found[0].deviation[0]


def _version(name: str) -> str:
    try:
        return importlib.metadata.version(name)
    except importlib.metadata.PackageNotFoundError:
        return "not installed"
