"""How the set-up of a correlation bears on its convergence (thesis, Figures 5 to 9), on the shipped example.

Run: python reports/configurations.py [--quick] [--cache FOLDER]. Writes configurations.md, .csv and five .png
beside itself, and stops with an error when a configuration does worse than stated.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import pandas as pd
from configurations_cases import FIGURES, STANDARD, method_of, problem_of
from configurations_figure import convergence_figure
from configurations_findings import hold
from configurations_text import file_name, markdown
from correlation_runs import Trace, arguments, cached_trace

from doe_kc.correlation.posterior import BOUND_SHARE
from doe_kc.reports.drawing.style import save


@dataclass(frozen=True)
class Plan:
    """seeds: runs of each configuration. left_out: configurations that are not run."""

    seeds: int = 3
    budget: int = 100
    left_out: tuple[str, ...] = ()


OPENING = 20
"""Designs of the opening sample, at least, and a third of the variables: the same for every method."""
QUICK_ONES = (STANDARD, "gaussian", "wide", "gauss_newton_targets")
NAMES = tuple(dict.fromkeys(name for _, entries in FIGURES.values() for name, _ in entries))
"""All that any figure shows, each once."""
QUICK = Plan(seeds=1, budget=28, left_out=tuple(n for n in NAMES if n not in QUICK_ONES))


def study(plan: Plan, cache: Path) -> dict[str, list[Trace]]:
    """Configuration -> its runs, by seed first so that an interrupted study holds all of them once."""
    runs: dict[str, list[Trace]] = {name: [] for name in NAMES if name not in plan.left_out}
    for seed in range(1, plan.seeds + 1):
        for name, found in runs.items():
            if seed == 1 or not name.startswith("gauss_newton"):  # nothing in it is left to chance
                found.append(_run(name, seed, plan.budget, cache))
    return runs


def _run(name: str, seed: int, budget: int, cache: Path) -> Trace:
    run = (method_of(name), seed, budget)
    first = max(OPENING, problem_of(name).space.dimension // 3)
    more = {"first": first, "gradients": False}  # as the thesis's solver, which knew no slopes
    return cached_trace(cache, f"car_a-{name}", lambda: problem_of(name), *run, **more)


def run_table(runs: Mapping[str, list[Trace]]) -> pd.DataFrame:
    """One row a run."""
    rows = [
        {
            "configuration": name,
            "method": t.method,
            "seed": t.seed,
            "variables": len(t.point),
            "at_bound": sum(u <= BOUND_SHARE or u >= 1.0 - BOUND_SHARE for u in t.point),
            "evaluations": t.evaluations,
            **{f"rating_{n}": t.best[min(n, t.evaluations) - 1] for n in (1, 25, 50, 100)},
            "constraints_missed": len(t.violated),
            "feasible_at": t.feasible_at,
            "mean_improvement_percent": t.improvement,
            "seconds": t.seconds,
        }
        for name, traces in runs.items()
        for t in traces
    ]
    return pd.DataFrame(rows)


def check(table: pd.DataFrame, plan: Plan) -> None:
    """AssertionError when a configuration does not do what the report says of it."""
    sampled = table[table["method"] != "gauss_newton"]  # it minimizes the misfit, not the rating
    assert (sampled["rating_100"] > sampled["rating_1"]).all(), sampled
    if plan == Plan():
        hold(table)


def main() -> None:
    """Run, write, print, assert."""
    given = arguments(__doc__ or "", Path(__file__).parent)
    plan = QUICK if given.quick else Plan()
    runs = study(plan, given.cache)
    given.out.mkdir(parents=True, exist_ok=True)
    for number, (what, entries) in FIGURES.items():
        shown = {label.format(n=len(runs[n][0].point)): runs[n] for n, label in entries if n in runs}
        if shown:
            standard = next((k for k, traces in shown.items() if traces is runs[STANDARD]), "")
            picture = convergence_figure(shown, what, plan.budget, standard)
            save(picture, given.out / file_name(number, what))
    table = run_table(runs)
    table.to_csv(given.out / "configurations.csv", index=False, float_format="%.4f")
    constraints = sum(t.constraint is not None for t in problem_of(STANDARD).targets.characteristics)
    text = markdown(table, FIGURES, constraints)
    (given.out / "configurations.md").write_text(text, encoding="utf-8")
    print(text)
    check(table, plan)


if __name__ == "__main__":
    main()
