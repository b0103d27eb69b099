"""How the set-up of a correlation bears on its convergence (thesis, Figures 5 to 9), on the shipped example.

Run: python reports/configurations.py [--quick] [--cache FOLDER]. Writes configurations.md, .csv and five .png
beside itself, and stops with an error when a configuration does worse than stated.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path

import pandas as pd
from configurations_figure import convergence_figure
from configurations_text import markdown
from correlation_runs import EXAMPLE, Trace, arguments, cached_trace

from doe_kc.correlation.methods import METHODS
from doe_kc.correlation.posterior import AT_BOUND
from doe_kc.correlation.problem import Problem
from doe_kc.reporting.style import save_png
from doe_kc.study import Study, read_study
from doe_kc.variables import Change, Space, VariableOptions, build_space
from doe_kc.variables.variable import Variable
from doe_kc.workflow.correlate import study_problem, study_space
from doe_kc.workflow.influence import study_influence
from doe_kc.workflow.measure import Reduced, study_records

DOZEN = 12
STANDARD = "standard"
FIGURES: Mapping[int, tuple[str, tuple[tuple[str, str], ...]]] = {
    5: ("distribution", ((STANDARD, "uniform"), ("gaussian", "Gaussian"))),
    6: ("resolution", (("levels_21", "21 levels"), (STANDARD, "101 levels"), ("continuous", "continuous"))),
    7: ("variables", ((STANDARD, "all {n}"), ("selection", "selection, {n}"), ("dozen", "a dozen"))),
    8: ("bounds", (("narrow", "narrow, × 0.5"), (STANDARD, "standard"), ("wide", "wide, × 2"))),
    9: (
        "algorithm",
        ((STANDARD, "ego"), ("pareto", "pareto"), ("hybrid", "hybrid"), ("gauss_newton", "gauss_newton")),
    ),
}
"""Number of the thesis's figure -> what varies, and its configurations with their names in the figure."""


@dataclass(frozen=True)
class Plan:
    """seeds: runs of each configuration. left_out: configurations that are not run."""

    seeds: int = 3
    budget: int = 100
    left_out: tuple[str, ...] = ()


QUICK = Plan(
    seeds=1,
    budget=28,
    left_out=("selection", "dozen", "levels_21", "continuous", "narrow", "pareto", "hybrid"),
)


@lru_cache(maxsize=1)
def example() -> tuple[Study, Reduced | None]:
    """The shipped study and its records."""
    study = read_study(EXAMPLE)
    return study, study_records(study)


@lru_cache(maxsize=1)
def advised() -> tuple[str, ...]:
    """Variables that the influence study advises, in the order of choice."""
    study, reduced = example()
    selection = study_influence(study, reduced.measurement if reduced else None, workers=1).selection
    return tuple(v.parameter.path for v in selection.variables if v.used) if selection else ()


def space_of(name: str) -> Space:
    """The variables of a configuration."""
    study, reduced = example()
    if name == "selection":
        chosen = VariableOptions(use="selection")
        return study_space(replace(study, variables=chosen), reduced, workers=1)
    return build_space(study.axle, options_of(name, study), "report")


def options_of(name: str, study: Study) -> VariableOptions:
    """What a study file would say."""
    match name:
        case "gaussian":
            return VariableOptions(distribution="gaussian")
        case "levels_21":
            return VariableOptions(levels=21)
        case "continuous":
            return VariableOptions(levels="continuous")
        case "dozen":
            return VariableOptions(use=list(advised()[:DOZEN]))
        case "narrow" | "wide":
            times = 0.5 if name == "narrow" else 2.0
            return VariableOptions(change=[_stretched(v, times) for v in study.space.variables])
    return VariableOptions()


def _stretched(variable: Variable, times: float) -> Change:
    """Bounds `times` as far from nominal, for factors in their logarithm."""
    low, start, high = variable.lower, variable.start, variable.upper
    if variable.logarithmic:
        bounds = [start * (low / start) ** times, start * (high / start) ** times]
    else:
        bounds = [start + (low - start) * times, start + (high - start) * times]
    return Change(match=variable.path, range=bounds)


@lru_cache(maxsize=2)
def problem_of(name: str) -> Problem:
    """The example's targets for the variables of a configuration."""
    study, reduced = example()
    return study_problem(study, reduced, space=space_of(name))


def method_of(name: str) -> str:
    """`ego`, unless the configuration is another algorithm."""
    return name if name in METHODS else "ego"


def configurations(plan: Plan) -> list[str]:
    """All that any figure shows, each once."""
    names = dict.fromkeys(name for _, entries in FIGURES.values() for name, _ in entries)
    methods = {"pareto", "hybrid", "gauss_newton"}
    return [n for n in names if n not in plan.left_out and (n not in methods or n in METHODS)]


def study(plan: Plan, cache: Path) -> dict[str, list[Trace]]:
    """Configuration -> its runs, by seed first so that an interrupted study holds all of them once."""
    runs: dict[str, list[Trace]] = {name: [] for name in configurations(plan)}
    for seed in range(1, plan.seeds + 1):
        for name, found in runs.items():
            if name != "gauss_newton" or seed == 1:  # nothing in it is left to chance
                label = f"car_a-{name}"
                found.append(_run(label, name, seed, plan.budget, cache))
    return runs


def _run(label: str, name: str, seed: int, budget: int, cache: Path) -> Trace:
    return cached_trace(cache, label, lambda: problem_of(name), method_of(name), seed, budget)


def run_table(runs: Mapping[str, list[Trace]]) -> pd.DataFrame:
    """One row a run."""
    rows = [
        {
            "configuration": name,
            "method": t.method,
            "seed": t.seed,
            "variables": len(t.point),
            "at_bound": sum(u <= AT_BOUND or u >= 1.0 - AT_BOUND for u in t.point),
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


def check(table: pd.DataFrame) -> None:
    """AssertionError when a run does not improve the rating at least tenfold."""
    assert (table["rating_100"] > 0.1 * table["rating_1"]).all(), table


def main() -> None:
    """Run, write, print, assert."""
    given = arguments(__doc__ or "", Path(__file__).parent)
    runs = study(QUICK if given.quick else Plan(), given.cache)
    given.out.mkdir(parents=True, exist_ok=True)
    for number, (what, entries) in FIGURES.items():
        shown = {label.format(n=len(runs[n][0].point)): runs[n] for n, label in entries if n in runs}
        save_png(convergence_figure(shown, what), given.out / f"configurations_{number}_{what}")
    table = run_table(runs)
    table.to_csv(given.out / "configurations.csv", index=False, float_format="%.4f")
    constraints = sum(t.constraint is not None for t in problem_of(STANDARD).targets.characteristics)
    text = markdown(table, FIGURES, constraints)
    (given.out / "configurations.md").write_text(text, encoding="utf-8")
    print(text)
    check(table)


if __name__ == "__main__":
    main()
