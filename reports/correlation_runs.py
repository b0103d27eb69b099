"""Correlation runs of the reports: the cars' problems, one run as a few figures, and a cache of runs.

The cache is a folder of JSON files, one a run, so that an interrupted report goes on where it was. It knows
nothing of the product's state: delete it after a change of the product.
"""

from __future__ import annotations

import argparse
import json
import tempfile
import time
import tomllib
from collections.abc import Callable
from dataclasses import asdict, dataclass, field
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np

from doe_kc import __version__
from doe_kc.axle.model import Axle
from doe_kc.axle_file import read_axle
from doe_kc.correlation.likelihood import build_likelihood
from doe_kc.correlation.loop import Run, run_method
from doe_kc.correlation.methods import METHODS, MethodSettings
from doe_kc.correlation.options import Gradients
from doe_kc.correlation.problem import Problem
from doe_kc.ground.typing import FloatArray
from doe_kc.measurement import Measurement, reduce_measurement
from doe_kc.targets import Targets, build_targets, improvements, mean_improvement
from doe_kc.targets.comparison import FLOOR
from doe_kc.true_solver.own import AxleSolver
from doe_kc.variables import VariableOptions, build_space

ROOT = Path(__file__).parents[1]
EXAMPLE = ROOT / "examples" / "front_axle"
RIG = ROOT / "tests" / "data" / "rig"
LEVELS = 101
"""Of every variable, as in the thesis; the rating alone is the objective, as there."""
BUSHING_AXES = ("Fx", "Fy", "Fz", "Tx", "Ty", "Tz")
POINTS = {"WC": "WLC", "SAL": "LWD"}
"""Names of the cars' keys that differ from the axle's."""


@dataclass(frozen=True)
class Trace:
    """What a run leaves behind.

    best: rating of the best design so far, an entry an evaluation, the baseline first. feasible_at: the
    first evaluation that met every constraint, 1 = baseline; None when none did. violated: constraints that
    the final design misses. improvement: mean percent. point: of the final design. seconds: of one core.
    deviation: mean |value - target| / Norm of the active characteristics at the baseline and at the end.
    """

    method: str
    seed: int
    best: list[float]
    feasible_at: int | None
    feasible: bool
    violated: list[str]
    rating: float
    improvement: float
    point: list[float]
    stopped: str
    seconds: float
    deviation: list[float] = field(default_factory=list)

    @property
    def evaluations(self) -> int:
        """Designs evaluated, the baseline among them."""
        return len(self.best)


@lru_cache(maxsize=1)
def nominal() -> Axle:
    """The example's axle, from which every correlation starts."""
    return read_axle(EXAMPLE / "axle.toml")


@lru_cache(maxsize=4)
def measured(car: str) -> Measurement:
    """The reduced records of a car."""
    return reduce_measurement(RIG / car)


def problem_of(measurement: Measurement, options: VariableOptions | None = None) -> Problem:
    """The nominal axle's variables (default: all) against reduced records."""
    axle = nominal()
    targets = build_targets(axle, measurement, [], [], source="report")
    return Problem(
        axle=axle,
        space=build_space(axle, options or VariableOptions(levels=LEVELS), "report"),
        targets=targets,
        likelihood=build_likelihood(axle, measurement, targets),
        windows={},
        exact=True,
    )


def solve_run(
    problem: Problem,
    method: str,
    seed: int,
    budget: int,
    *,
    first: int | None = None,
    gradients: Gradients = "auto",
) -> Run:
    """One run of a method, every design solved in this process. first: designs of the opening sample.

    gradients: False as for an outside solver, which gives no exact sensitivities.
    """
    solver = AxleSolver(problem.axle, problem.windows).prepare([])
    made = METHODS[method](
        problem, MethodSettings(seed=seed, budget=budget, first=first, gradients=gradients)
    )
    return run_method(problem, made, lambda designs: [solver.evaluate(d) for d in designs], budget=budget)


def traced(problem: Problem, method: str, seed: int, budget: int, **more: Any) -> Trace:
    """One run in figures; more: as in `solve_run`."""
    started = time.process_time()
    run = solve_run(problem, method, seed, budget, **more)
    return trace_of(problem, run, method, seed, time.process_time() - started)


def trace_of(problem: Problem, run: Run, method: str, seed: int, seconds: float) -> Trace:
    """The figures of a finished run."""
    base, final = run.evaluated[0], run.evaluated[run.best]
    if base.score is None or final.score is None or final.rating is None:
        raise ValueError("a run ends at a solved design")
    found = improvements(problem.targets, base.score, final.score)
    first = (e.index + 1 for e in run.evaluated if e.rating is not None and e.rating.feasible)
    return Trace(
        method=method,
        seed=seed,
        best=[float(b) for b in np.maximum.accumulate([e.merit for e in run.evaluated])],
        feasible_at=next(first, None),
        feasible=final.rating.feasible,
        violated=[f.target.entry.id for f in found if not f.inside],
        rating=final.merit,
        improvement=mean_improvement(found),
        point=[float(u) for u in final.point],
        stopped=run.stopped,
        seconds=seconds,
        deviation=[_deviation(problem.targets, e.score.values) for e in (base, final) if e.score],
    )


def _deviation(targets: Targets, values: FloatArray) -> float:
    off = [
        abs(v - t.value) / np.hypot(t.value, FLOOR**0.5)
        for t, v in zip(targets.characteristics, values, strict=True)
        if t.active
    ]
    return float(np.mean(off))


def cached(folder: Path, name: str, make: Callable[[], dict[str, Any]]) -> dict[str, Any]:
    """The JSON document of that name, made when the folder lacks it."""
    file = folder / f"{name}.json"
    if file.exists():
        return dict(json.loads(file.read_text(encoding="utf-8")))
    document = make()
    folder.mkdir(parents=True, exist_ok=True)
    beside = file.with_suffix(".part")
    beside.write_text(json.dumps(document), encoding="utf-8")
    beside.replace(file)
    print(f"{name} done", flush=True)
    return document


def cached_trace(folder: Path, name: str, problem: Callable[[], Problem], *run: Any, **more: Any) -> Trace:
    """`traced(problem(), *run, **more)` through the cache under the name; run: method, seed, budget."""
    label = "-".join(map(str, (name, *run)))
    return Trace(**cached(folder, label, lambda: asdict(traced(problem(), *run, **more))))


def truth(car: str) -> dict[str, float]:
    """Path -> absolute value of every parameter that a car's answer key states."""
    key: dict[str, Any] = tomllib.loads((RIG / f"{car}.key.toml").read_text(encoding="utf-8"))
    at, other = nominal().values, key["other"]
    shifts = {POINTS.get(p, p): s for p, s in key["points"].items()}
    out = {
        f"{p}.{a}": at[f"{p}.{a}@L"] + s for p, xyz in shifts.items() for a, s in zip("xyz", xyz, strict=True)
    }
    for name, factors in key["bushing"].items():
        out |= {f"{name.lower()}.{a}": f for a, f in zip(BUSHING_AXES, factors, strict=True)}
    return out | {
        "spring.rate": at["spring.rate@L"] * other["spring.k_N_mm"],
        "tyre.rate": at["tyre.rate@L"] * other["tyre.k_radial_N_mm"],
        "arb.radius": at["arb.radius"] * other["arb.k_N_mm"] ** 0.25,
        "scb.Tz": other["steering.column_N_mm"],
        "static.toe": at["static.toe@L"] + other["wheel.toe_deg"],
        "static.camber": at["static.camber@L"] + other["wheel.camber_deg"],
        "ride_height": 0.0,
    }


def arguments(description: str, output: Path) -> argparse.Namespace:
    """--quick, --cache and --out of a report."""
    parser = argparse.ArgumentParser(description=description)
    parser.add_argument("--quick", action="store_true", help="a reduced version, for tests")
    default = Path(tempfile.gettempdir()) / f"doe_kc_reports_{__version__}"
    parser.add_argument("--cache", type=Path, default=default, help="folder of finished runs")
    parser.add_argument("--out", type=Path, default=output, help="folder to write to")
    return parser.parse_args()
