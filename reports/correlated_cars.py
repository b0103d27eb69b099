"""Correlation of two measured cars whose parameters are known, and of many more made for the purpose.

Run: python reports/correlated_cars.py [--quick] [--cache FOLDER]. Writes correlated_cars.md, two .csv and a
.png beside itself, and stops with an error when the cars are not correlated as well as stated.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from functools import lru_cache
from pathlib import Path

import numpy as np
import pandas as pd
from correlated_cars_figure import recovery_figure
from correlated_cars_text import markdown
from correlation_runs import Trace, arguments, cached, cached_trace, measured, problem_of, truth
from recovery import Fit, far_off, fitted
from synthetic_cars import record, scattered

from doe_kc.correlation.options import Gradients
from doe_kc.reports.drawing.style import save

CARS = ("car_b", "car_e")
SLOPES: Mapping[str, Gradients] = {"exact": "auto", "learnt": False}
"""How `ego` knows slopes: as shipped, and as with an outside solver."""


@dataclass(frozen=True)
class Plan:
    """How much is run: seeds of `ego`, with each kind of slopes, and its budget on each car; synthetic cars
    of each scatter."""

    cars: tuple[str, ...] = CARS
    seeds: int = 10
    budget: int = 100
    synthetic: int = 40
    times: tuple[float, ...] = (1.0, 2.0)


QUICK = Plan(cars=("car_b",), seeds=1, budget=16, synthetic=2, times=(1.0,))


@dataclass(frozen=True)
class Found:
    """ego: (car, kind of slopes) -> runs. fits: car -> Gauss-Newton fit.

    synthetic: multiple of the production scatter -> fits of the cars made with it.
    """

    plan: Plan
    ego: Mapping[tuple[str, str], list[Trace]]
    fits: Mapping[str, Fit]
    synthetic: Mapping[float, list[Fit]]

    @property
    def runs(self) -> list[Trace]:
        """All runs of `ego`."""
        return [t for runs in self.ego.values() for t in runs]

    @property
    def made(self) -> list[Fit]:
        """Fits of all synthetic cars."""
        return [f for fits in self.synthetic.values() for f in fits]


def study(plan: Plan, cache: Path) -> Found:
    """Everything run, or read from the cache."""
    return Found(
        plan,
        {(car, slopes): _ego(car, slopes, plan, cache) for car in plan.cars for slopes in SLOPES},
        {car: _fit(car, cache) for car in plan.cars},
        {t: [_synthetic(s, t, cache) for s in range(1, plan.synthetic + 1)] for t in plan.times},
    )


def _ego(car: str, slopes: str, plan: Plan, cache: Path) -> list[Trace]:
    make = lru_cache(maxsize=1)(lambda: problem_of(measured(car)))
    return [
        cached_trace(cache, f"{car}-{slopes}", make, "ego", s, plan.budget, gradients=SLOPES[slopes])
        for s in range(1, plan.seeds + 1)
    ]


def _fit(car: str, cache: Path) -> Fit:
    return Fit(**cached(cache, f"{car}-fit", lambda: asdict(fitted(problem_of(measured(car)), truth(car)))))


def _synthetic(seed: int, times: float, cache: Path) -> Fit:
    def make() -> dict[str, object]:
        known = scattered(problem_of(measured("car_b")).space, seed, times=times)
        records = record(known, noise=np.random.default_rng([9, seed]))
        return asdict(fitted(problem_of(records), known))

    return Fit(**cached(cache, f"synthetic-{times:g}-{seed}-fit", make))


def coverage(fits: list[Fit]) -> tuple[float, float]:
    """Share of judged parameters within two stated sd, and its standard error from car to car."""
    inside = np.array([f.inside for f in fits])
    judged = np.array([f.judged.sum() for f in fits])
    share = inside.sum() / judged.sum()
    if len(fits) < 2:
        return float(share), float("nan")
    scatter = np.sum((inside - share * judged) ** 2) / (len(fits) - 1) * len(fits)
    return float(share), float(np.sqrt(scatter) / judged.sum())


def parameter_table(found: Found) -> pd.DataFrame:
    """One row a car and parameter, in prior sd about nominal."""
    rows = []
    for car, fit in found.fits.items():
        for i, path in enumerate(fit.paths):
            scale, start = fit.prior[i], fit.start[i]
            rows.append(
                {
                    "car": car,
                    "parameter": path,
                    "visible": fit.visible[i],
                    "true": (fit.true[i] - start) / scale,
                    "estimate": (fit.estimate[i] - start) / scale,
                    "sd": fit.sd[i] / scale,
                    "z": fit.z[i],
                }
            )
    return pd.DataFrame(rows)


def run_table(found: Found) -> pd.DataFrame:
    """One row a run of `ego`."""
    rows = [
        {
            "car": car,
            "slopes": slopes,
            "seed": t.seed,
            "evaluations": t.evaluations,
            "feasible": t.feasible,
            "feasible_at": t.feasible_at,
            "mean_improvement_percent": t.improvement,
            "rating": t.rating,
            "seconds": t.seconds,
        }
        for (car, slopes), runs in found.ego.items()
        for t in runs
    ]
    return pd.DataFrame(rows)


def check(found: Found) -> None:
    """AssertionError when a figure that the report states is not reached."""
    for fit in found.fits.values():
        assert fit.stopped.startswith("converged"), fit.stopped
        assert fit.feasible
    for fit in [*found.fits.values(), *found.made]:
        assert fit.seconds < 10.0, fit.seconds
        assert 0.9 < fit.misfit["all"] < 1.1, fit.misfit
    assert coverage(list(found.fits.values()))[0] >= 0.9
    assert all(t.rating > 10.0 * t.best[0] / 100.0 for t in found.runs)
    if found.plan == Plan():
        assert 0.945 < coverage(found.synthetic[1.0])[0] < 0.985
        assert coverage(found.synthetic[2.0])[0] > 0.9
        assert sum(f.feasible for f in found.made) >= 0.9 * len(found.made)
        assert all("stop" in path for path, z in far_off(found.synthetic[1.0]) if abs(z) > 4.0)
        assert all(t.feasible for t in found.runs)
        assert min(t.improvement for t in found.runs) >= 95.0


def main() -> None:
    """Run, write, print, assert."""
    given = arguments(__doc__ or "", Path(__file__).parent)
    found = study(QUICK if given.quick else Plan(), given.cache)
    given.out.mkdir(parents=True, exist_ok=True)
    text = markdown(found.ego, found.fits, found.synthetic, coverage)
    (given.out / "correlated_cars.md").write_text(text, encoding="utf-8")
    parameter_table(found).to_csv(
        given.out / "correlated_cars_parameters.csv", index=False, float_format="%.4f"
    )
    run_table(found).to_csv(given.out / "correlated_cars_runs.csv", index=False, float_format="%.4f")
    save(recovery_figure(found.fits, found.synthetic), given.out / "correlated_cars")
    print(text)
    check(found)


if __name__ == "__main__":
    main()
