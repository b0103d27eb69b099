"""A disturbed model correlated back to its own curves: is the disturbance found again, and if not, why?

Run: python reports/recorrelation.py [--quick] [--cache FOLDER]. Writes recorrelation.md, two .csv and a .png
beside itself, and stops with an error when less is found again than stated.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace
from functools import lru_cache, partial
from pathlib import Path

import numpy as np
import pandas as pd
from correlation_runs import LEVELS, arguments, cached, cached_trace, nominal, problem_of
from recorrelation_case import Case
from recorrelation_figure import parameter_figure, recorrelation_figure
from recorrelation_text import markdown
from recovery import BUDGET, Fit, fitted
from synthetic_cars import quieter, record, scattered

from doe_kc.correlation.posterior import posterior
from doe_kc.correlation.problem import Problem
from doe_kc.reports.drawing.style import save
from doe_kc.targets import Targets
from doe_kc.variables import Space, VariableOptions, build_space

SHARE = 0.1
"""Of the rig's noise: the error that the fit of noise-free curves assumes."""


@dataclass(frozen=True)
class Plan:
    """times: disturbances in multiples of production scatter, `cars` of each, `seeds` runs of ego a car."""

    times: tuple[float, ...] = (1.0, 2.0)
    cars: int = 3
    seeds: int = 2
    budget: int = 100


QUICK = Plan(times=(1.0,), cars=1, seeds=1, budget=12)


def space() -> Space:
    """All default variables of the nominal axle."""
    return build_space(nominal(), VariableOptions(levels=LEVELS), "report")


def disturbed(times: float, car: int) -> tuple[Problem, dict[str, float]]:
    """A car's noise-free records as a problem that starts at nominal, targets exact, and its parameters."""
    values = scattered(space(), 100 + car, times=times)
    problem = problem_of(quieter(record(values, noise=None), SHARE))
    known = problem.targets
    exact = Targets(
        tuple(replace(t, sd=0.0) for t in known.characteristics),
        tuple(replace(c, noise=0.0) for c in known.curves),
        known.source,
    )
    return replace(problem, targets=exact), values


def continuous(problem: Problem) -> Problem:
    """The same without levels."""
    free = tuple(replace(v, levels=None) for v in problem.space.variables)
    return replace(problem, space=replace(problem.space, variables=free))


def case(times: float, car: int, plan: Plan, cache: Path) -> Case:
    """One disturbed car with all its runs."""
    name = f"recorrelation-{times:g}-{car}"
    fit = Fit(**cached(cache, f"{name}-fit", lambda: asdict(fitted(*disturbed(times, car)))))
    make = lru_cache(maxsize=1)(lambda: disturbed(times, car)[0])
    ego = [cached_trace(cache, name, make, "ego", s, plan.budget) for s in range(1, plan.seeds + 1)]
    fine = [
        cached_trace(cache, f"{name}-continuous", lambda: continuous(make()), "ego", s, plan.budget)
        for s in range(1, plan.seeds + 1)
    ]
    newton = cached_trace(cache, name, make, "gauss_newton", 1, BUDGET)
    view = cached(cache, f"{name}-view", partial(_view, times, car))
    prior, start = np.array(fit.prior), np.array(fit.start)
    return Case(
        times=times,
        car=car,
        active=int(view["active"]),
        paths=fit.paths,
        moved=(np.array(fit.true) - start) / prior,
        prior=prior,
        start=start,
        seen=np.array(view["seen"]),
        axes=np.array(view["axes"]),
        visible=np.array(view["visible"]),
        ego=ego,
        fine=fine,
        newton=newton,
        fit=fit,
    )


def _view(times: float, car: int) -> dict[str, object]:
    """What records with the rig's whole noise see of the parameters, at the truth."""
    values = scattered(space(), 100 + car, times=times)
    problem = problem_of(record(values, noise=None))
    point, prior = problem.space.unit(values), problem.space.prior_sd
    expansion = problem.linearize(point)
    jacobian = problem.likelihood.jacobian(expansion.curves, expansion.characteristics)
    _, seen, rows = np.linalg.svd(jacobian * prior, full_matrices=False)
    visible = posterior(jacobian, prior).visible
    return {
        "seen": seen.tolist(),
        "axes": rows.T.tolist(),
        "visible": visible.tolist(),
        "active": int(problem.targets.active.sum()),
    }


def study(plan: Plan, cache: Path) -> list[Case]:
    """Every car of the plan."""
    return [case(t, c, plan, cache) for t in plan.times for c in range(1, plan.cars + 1)]


def run_table(cases: Sequence[Case]) -> pd.DataFrame:
    """One row a run."""
    rows = [
        {
            "times": c.times,
            "car": c.car,
            "variables": variables,
            **{k: v for k, v in asdict(t).items() if k in KEPT},
            "start": t.best[0],
        }
        for c in cases
        for variables, runs in (("levels", c.ego), ("continuous", [*c.fine, c.newton]))
        for t in runs
    ]
    return pd.DataFrame(rows)


KEPT = ("method", "seed", "rating", "feasible", "feasible_at", "improvement", "seconds")


def parameter_table(cases: Sequence[Case]) -> pd.DataFrame:
    """One row a parameter: rms over all cars, in prior sd."""
    moved = np.array([c.moved for c in cases])
    by_fit = np.array([c.left(c.fit.estimate) for c in cases])
    by_ego = np.array([c.left(t.point) for c in cases for t in c.ego])
    rms = {"moved": moved, "left_by_gauss_newton": by_fit, "left_by_ego": by_ego}
    columns = {name: np.sqrt(np.mean(v**2, axis=0)) for name, v in rms.items()}
    visible = np.mean([c.visible for c in cases], axis=0)
    return pd.DataFrame({"parameter": cases[0].paths, "visible_share": visible, **columns})


def check(cases: Sequence[Case], plan: Plan) -> None:
    """AssertionError when less is found again than stated."""
    for c in cases:
        assert c.fit.feasible
        assert c.fit.misfit["all"] < 0.01, c.fit.misfit
        seen = c.visible.astype(bool)
        assert np.sqrt(np.mean(c.left(c.fit.estimate)[seen] ** 2)) < 0.25
        assert all(t.rating > 0.1 * t.best[0] for t in c.ego)
        if plan == Plan():
            assert all(t.feasible and t.rating > 0.01 * t.best[0] for t in c.ego)
            assert all(t.feasible and t.rating > -0.05 for t in c.fine)


def main() -> None:
    """Run, write, print, assert."""
    given = arguments(__doc__ or "", Path(__file__).parent)
    plan = QUICK if given.quick else Plan()
    cases = study(plan, given.cache)
    given.out.mkdir(parents=True, exist_ok=True)
    parameters = parameter_table(cases)
    text = markdown(cases, parameters, SHARE)
    (given.out / "recorrelation.md").write_text(text, encoding="utf-8")
    parameters.to_csv(given.out / "recorrelation_parameters.csv", index=False, float_format="%.4f")
    run_table(cases).to_csv(given.out / "recorrelation_runs.csv", index=False, float_format="%.4f")
    save(recorrelation_figure(cases, SHARE), given.out / "recorrelation")
    save(parameter_figure(parameters), given.out / "recorrelation_parameters")
    print(text)
    check(cases, plan)


if __name__ == "__main__":
    main()
