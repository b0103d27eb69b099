"""A twin of little use on the problem of benchmarks/optimizers.py: levels of deviation, beside BoTorch's."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace

import numpy as np
from optimizers.counting import CountingSolver
from optimizers.ours import _without_levels
from optimizers.running import problem

from benchmarks.twin.cars import wrongly_imported
from doe_kc.correlation.loop import run_method
from doe_kc.correlation.methods import MethodSettings
from doe_kc.correlation.methods.ego import Ego
from doe_kc.correlation.twin import Twin
from tests.correlation import cases

LEVELS = (0.1, 0.01, 0.001)
"""Shares of the start's deviation."""
USELESS_SDS = (0.6, 2.0)
"""Of the logarithm of the twin's bushing stiffnesses: factors of 1.8 and 7."""
BUDGET = 30
BOTORCH: Mapping[str, tuple[int, int, int, int]] = {"BoTorch composite, no twin": (10, 17, 24, 10)}
"""From results/optimizers.md, the same problem and counting: median of five seeds."""


@dataclass(frozen=True)
class UselessRun:
    """reached: evaluations to each of LEVELS, and to the first design that meets every constraint."""

    sd: float
    seed: int
    reached: tuple[int | None, ...]


def run_useless(sd: float, seed: int) -> UselessRun:
    """`ego`, continuous variables; the records are those of car_b, the solver stands for the outside one."""
    plain = _without_levels(problem())
    twin = Twin(wrongly_imported(plain.axle, sd))
    beside = replace(plain, exact=False, twin=twin)
    solver = CountingSolver(beside, cases.solver(plain.axle), BUDGET)
    method = Ego(beside, MethodSettings(seed=seed, budget=BUDGET))
    run_method(beside, method, solver.evaluate, budget=BUDGET)
    best = np.minimum.accumulate(np.array(solver.log.deviation)) / solver.log.deviation[0]
    marks = [*(best <= level for level in LEVELS), np.array(solver.log.feasible)]
    return UselessRun(sd, seed, tuple(int(np.argmax(m)) + 1 if m.any() else None for m in marks))


def useless_rows(runs: list[UselessRun]) -> Iterator[str]:
    """A row a twin: median of the seeds, the worst in brackets, and BoTorch's."""
    for sd in USELESS_SDS:
        own = [r for r in runs if r.sd == sd]
        cells = []
        for values in zip(*(r.reached for r in own), strict=True):
            ranked = sorted(values, key=lambda v: BUDGET + 1 if v is None else v)
            words = ["–" if v is None else str(v) for v in (ranked[len(ranked) // 2], ranked[-1])]
            cells.append(f"{words[0]} ({words[1]})")
        yield f"| `ego`, twin with bushings off by sd {sd:g} | {len(own)} | {' | '.join(cells)} |"
    for name, values in BOTORCH.items():
        yield f"| {name} | 5 | {' | '.join(map(str, values))} |"
