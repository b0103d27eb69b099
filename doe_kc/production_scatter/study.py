"""The tolerance study: cars drawn, each solved by the true solver, and what their scatter comes from."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from doe_kc.axle.model import Axle
from doe_kc.axle.parameter_kinds import must_be_positive, not_below_zero, side_prefix
from doe_kc.campaign.runner import Campaign
from doe_kc.characteristics import CHARACTERISTICS, Characteristic, characteristics_of
from doe_kc.curves import RIG_RESPONSES
from doe_kc.ground.errors import InputError, RunError
from doe_kc.ground.threads import one_thread
from doe_kc.ground.typing import FloatArray
from doe_kc.production_scatter.bands import BandCollector, CurveBand
from doe_kc.production_scatter.first_order import FirstOrderScatter, regression_slopes
from doe_kc.production_scatter.model import ScatterModel
from doe_kc.production_scatter.requirements import Requirement
from doe_kc.production_scatter.result import MeasuredCar, Tolerance
from doe_kc.sampling.design import Design
from doe_kc.solver.curve_gradient import characteristic_gradients
from doe_kc.solver.suite import solve
from doe_kc.true_solver.outcome import Outcome
from doe_kc.true_solver.protocol import TrueSolver

CHUNK = 512
"""Cars whose curves are in memory at once."""
CARS_ORIGIN = "tolerance"
EXACT_SLOPES = "exact sensitivities"
FITTED_SLOPES = "slopes fitted to the sample"


def car_design(model: ScatterModel, n: int, seed: int, source: str) -> tuple[Design, FloatArray]:
    """(n + 1) designs, the unchanged axle first, and the deviations (n, m) of the others.

    InputError where a distribution without limits takes a value of size to zero or below.
    """
    deviations = model.deviations(n, seed)
    values = model.values(deviations)
    for path, column in zip(model.paths, values.T, strict=True):
        name = path.removeprefix(side_prefix(path))
        bad = column <= 0.0 if must_be_positive(name) else column < 0.0
        if bad.any() and (must_be_positive(name) or not_below_zero(name)):
            raise InputError(
                f"{source}: tolerance: {path} is not above 0 in {int(bad.sum())} of {n} cars; give "
                f'[[tolerance.scatter]] with match = "{name}" a smaller sd, or '
                'distribution = "truncated_normal".'
            )
    rows = np.vstack([model.nominal, values])
    labels = ("nominal", *(f"car {i + 1}" for i in range(n)))
    return Design(CARS_ORIGIN, model.paths, rows, labels, seed), deviations


@dataclass(frozen=True)
class _Cars:
    """solved: (n,) bool of the drawn cars. nominal: (all characteristics,). values: (solved, all)."""

    solved: np.ndarray
    nominal: FloatArray
    values: FloatArray
    bands: tuple[CurveBand, ...]
    failures: tuple[str, ...]
    runs: int


@one_thread()
def tolerance_study(
    axle: Axle,
    solver: TrueSolver,
    model: ScatterModel,
    *,
    n: int,
    seed: int,
    requirements: Mapping[str, Requirement],
    cars: Sequence[MeasuredCar] = (),
    store: Path | None = None,
    twin: Axle | None = None,
    workers: int | None = None,
    scheduler: str | None = None,
    source: str = "study",
    progress: Callable[[int], None] = lambda _: None,
) -> Tolerance:
    """n cars of an axle, solved, with what their scatter comes from.

    store: file of the evaluations; what it has is not run again. twin: the package's own model of an axle
    that an outside solver solves, for the slopes; without one they are fitted to the sample. progress: told
    how many more cars are done, the unchanged axle among them. RunError when that has no equilibrium, or
    hardly any car.
    """
    started = time.perf_counter()
    design, deviations = car_design(model, n, seed, source)
    with Campaign(solver, store, workers=workers, scheduler=scheduler) as campaign:
        done = _solved(campaign, design, progress)
    known = np.isfinite(done.nominal) & np.isfinite(done.values).all(axis=0)
    entries = [e for e in characteristics_of(axle) if known[list(CHARACTERISTICS).index(e.id)]]
    columns = [list(CHARACTERISTICS).index(e.id) for e in entries]
    values, moved = done.values[:, columns], deviations[done.solved]
    return Tolerance(
        model=model,
        characteristics=tuple(entries),
        nominal=done.nominal[columns],
        deviations=moved,
        values=values,
        first_order=_first_order(axle if solver.exact else twin, solver, model, entries, moved, values),
        requirements={k: r for k, r in requirements.items() if any(e.id == k for e in entries)},
        bands=done.bands,
        cars=tuple(cars),
        failures=done.failures,
        runs=done.runs,
        seed=seed,
        seconds=time.perf_counter() - started,
    )


def _solved(campaign: Campaign, design: Design, progress: Callable[[int], None]) -> _Cars:
    rows = list(design.rows())
    outcomes: list[Outcome] = []
    collector: BandCollector | None = None
    for start in range(0, len(rows), CHUNK):
        part = campaign.evaluate(rows[start : start + CHUNK], CARS_ORIGIN, progress)
        if start == 0:
            if part[0].failed:
                raise RunError(f"the nominal axle cannot be solved: {part[0].reason}")
            if part[0].curves is not None:
                collector = BandCollector(part[0].curves, RIG_RESPONSES)
        curves = [o.curves for o in (part[1:] if start == 0 else part) if o.curves is not None]
        if collector is not None and curves:
            collector.add(curves)
        outcomes += [Outcome(None, o.characteristics, o.reason, o.seconds) for o in part]
    drawn = outcomes[1:]
    solved = np.array([not o.failed for o in drawn])
    if solved.sum() < max(2.0, 0.5 * len(drawn)):
        reason = next(o.reason for o in drawn if o.failed)
        raise RunError(
            f"{len(drawn) - int(solved.sum())} of {len(drawn)} cars have no equilibrium, the first: "
            f"{reason}; make the scatter of [tolerance] smaller."
        )
    return _Cars(
        solved=solved,
        nominal=outcomes[0].characteristics,
        values=np.array([o.characteristics for o in drawn if not o.failed]),
        bands=() if collector is None else collector.bands(),
        failures=tuple(o.reason for o in drawn if o.failed),
        runs=campaign.runs,
    )


def _first_order(
    axle: Axle | None,
    solver: TrueSolver,
    model: ScatterModel,
    entries: Sequence[Characteristic],
    deviations: FloatArray,
    values: FloatArray,
) -> FirstOrderScatter:
    if axle is None:
        return FirstOrderScatter(regression_slopes(deviations, values), model.covariance, FITTED_SLOPES)
    gradients = characteristic_gradients(
        axle, solve(axle), list(model.paths), entries, windows=solver.windows
    )
    if not np.isfinite(gradients).all():
        return FirstOrderScatter(regression_slopes(deviations, values), model.covariance, FITTED_SLOPES)
    source = EXACT_SLOPES if solver.exact else f"{EXACT_SLOPES} of the twin"
    return FirstOrderScatter(np.asarray(gradients * model.sign), model.covariance, source)
