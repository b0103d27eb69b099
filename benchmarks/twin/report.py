"""The comparison as text."""

from __future__ import annotations

import time
from collections.abc import Iterable, Iterator, Sequence

from benchmarks.twin.corrections import AS_SHIPPED
from benchmarks.twin.running import NO_TWIN, REACHED, TwinRun

NEAR_END = 0.5
"""Points of mean improvement below the best that any search of the case got to: the end of the road."""

INTRODUCTION = (
    "Outside model: `doe-kc simulate` behind the protocol of outside solvers, with two effects that the twin "
    "lacks (the shipped front axle). Records: a car with both effects at the parameters of a key, with the "
    "rig's noise, three runs; quiet rig: a tenth of the noise. All default variables, continuous; method "
    "`ego` as shipped but for the correction of the twin. Wrong import: every bushing stiffness off by a "
    "factor (sd 0.6 of its logarithm), four points by 15 mm, the bar by 30 %. Numbers are evaluations of the "
    "outside model, the baseline counted; – is never.",
    "",
    f"- feasible: until every constraint is met. {REACHED:g} %: until the mean improvement of the design "
    "that would be handed over is that.",
    f"- end: until it is within {NEAR_END:g} points of the best that any search of the case got to, which "
    "noise and curves limit; a case that one search alone was run on has its own end.",
)


def report(runs: Sequence[TwinRun], useless: Iterable[str], command: str, machine: str) -> list[str]:
    """Markdown: a table of all searches, twins of little use, and what is said of each twin."""
    return [
        "# The twin of an outside model",
        "",
        f"{time.strftime('%Y-%m-%d')}, `{command}`, {machine}, other work on the machine.",
        "",
        *INTRODUCTION,
        "",
        "| case | correction | seed | feasible | 98 % | end | at 3 | at 8 | at the end | own CPU s |",
        "|---|---|---|---|---|---|---|---|---|---|",
        *_rows(runs),
        "",
        "## By correction",
        "",
        "| correction | cases | feasible by 3 | 98 % by 8 | end by 8 |",
        "|---|---|---|---|---|",
        *_summary(runs),
        "",
        "## Twins of little use",
        "",
        "The problem of [the optimizers](optimizers.md), all 72 variables, continuous; own solver as the "
        "outside one, the wrong import as its twin. Evaluations to 10, 1 and 0.1 % of the start's deviation, "
        "and to the first design that meets every constraint; median (worst) of the seeds.",
        "",
        "| search | seeds | 10 % | 1 % | 0.1 % | feasible |",
        "|---|---|---|---|---|---|",
        *useless,
        "",
        "## What is said of the twin",
        "",
        *(f"- {r.case}: {r.agreement}" for r in runs if r.how == AS_SHIPPED and r.seed == 1),
    ]


def _best(runs: Sequence[TwinRun], case: str, seed: int) -> float:
    return max(max(r.improvement) for r in runs if r.case == case and r.seed == seed)


def _end(runs: Sequence[TwinRun], run: TwinRun) -> int | None:
    level = _best(runs, run.case, run.seed) - NEAR_END
    return next((i for i, v in enumerate(run.improvement, start=1) if v >= level), None)


def _at(run: TwinRun, n: int) -> str:
    return f"{run.improvement[min(n, len(run.improvement)) - 1]:.1f}"


def _rows(runs: Sequence[TwinRun]) -> Iterator[str]:
    for r in runs:
        cells = [r.case, f"**{r.how}**" if r.how == AS_SHIPPED else r.how, str(r.seed)]
        cells += ["–" if n is None else str(n) for n in (r.feasible, r.reached, _end(runs, r))]
        cells += [_at(r, 3), _at(r, 8), _at(r, len(r.improvement)), f"{r.own_cpu:.0f}"]
        yield f"| {' | '.join(cells)} |"


def _summary(runs: Sequence[TwinRun]) -> Iterator[str]:
    for how in dict.fromkeys(r.how for r in runs):
        for wrong in (False, True):
            own = [r for r in runs if r.how == how and ("wrong" in r.case) == wrong]
            if not own:
                continue
            ends = [_end(runs, r) for r in own]
            counts = (
                sum(r.feasible is not None and r.feasible <= 3 for r in own),
                sum(r.reached is not None and r.reached <= 8 for r in own),
                sum(e is not None and e <= 8 for e in ends),
            )
            label = f"{how}{', wrong import' if wrong else ''}"
            label = f"{label} (the study without one)" if how == NO_TWIN else label
            yield f"| {label} | {len(own)} | {' | '.join(f'{c} of {len(own)}' for c in counts)} |"
