"""Surrogates of the example axle: quality, coverage, fit time and Jacobian over the number of designs."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

from _common import example_axle, machine, publish

import numpy as np  # isort: skip  # after the thread limits
from scipy.stats import qmc

from doe_kc.campaign.runner import Campaign
from doe_kc.characteristics import CHARACTERISTICS
from doe_kc.ground.typing import FloatArray
from doe_kc.solver.curve_gradient import characteristic_gradients
from doe_kc.solver.suite import solve
from doe_kc.surrogate_models.calibration import calibration_factors
from doe_kc.surrogate_models.folds import refit_folds
from doe_kc.surrogate_models.interface import Fitted, SurrogateModel
from doe_kc.surrogate_models.learning import Learning
from doe_kc.surrogate_models.models import make
from doe_kc.surrogate_models.models.gp import FirstOrderTrend, GaussianProcess
from doe_kc.surrogate_models.validation import NOMINAL_WIDTH, quality_on
from doe_kc.true_solver.own import AxleSolver
from doe_kc.variables import Space, VariableOptions, build_space

SIZES = (20, 40, 80, 120, 300)
TESTS = 500
FEW = slice(None, None, 6)
"""Five of the thirty characteristics, for models that take minutes."""
HEAD = "| model | n | Q2 mean | median | worst | coverage mean | lowest | Jacobian error | worst | fit / s |"
RULE = "|---|---|---|---|---|---|---|---|---|---|"


@dataclass(frozen=True)
class Truth:
    """designs: n -> (x, y). test: (x, y). slope: (m, d) exact at the start. start: (d,), value (m,) there."""

    designs: dict[int, tuple[FloatArray, FloatArray]]
    test: tuple[FloatArray, FloatArray]
    start: FloatArray
    value: FloatArray
    slope: FloatArray

    def part(self, which: slice) -> Truth:
        """The same for some of the characteristics."""
        return replace(
            self,
            designs={n: (x, y[:, which]) for n, (x, y) in self.designs.items()},
            test=(self.test[0], self.test[1][:, which]),
            value=self.value[which],
            slope=self.slope[which],
        )


def truth() -> Truth:
    axle = example_axle()
    space = build_space(axle, VariableOptions(), "benchmark")
    with Campaign(AxleSolver(axle, {})) as campaign:

        def values(x: FloatArray) -> FloatArray:
            outcomes = campaign.evaluate([space.values(u) for u in x], "benchmark", curves=False)
            return np.array([o.characteristics for o in outcomes])

        designs = {n: (x := hypercube(space, n, seed=31), values(x)) for n in SIZES}
        test = hypercube(space, TESTS, seed=399)
        start = space.start
        slope = characteristic_gradients(axle, solve(axle), space.paths) * space.slopes(start)
        return Truth(designs, (test, values(test)), start, values(start[None])[0], slope)


def hypercube(space: Space, n: int, *, seed: int) -> FloatArray:
    return np.asarray(qmc.LatinHypercube(space.dimension, rng=np.random.default_rng(seed)).random(n))


def row(name: str, n: int, fitted: Fitted, known: Truth, seconds: float) -> str:
    q = quality_on(fitted, *known.test)
    sd = known.test[1].std(axis=0)[:, None]
    difference = (fitted.gradient(known.start[None])[0] - known.slope) / sd
    norm = np.linalg.norm(known.slope / sd, axis=1)
    error = np.linalg.norm(difference, axis=1) / norm
    total = np.linalg.norm(difference) / np.linalg.norm(norm)
    return (
        f"| {name} | {n} | {q.q2.mean():.4f} | {np.median(q.q2):.4f} | {q.q2.min():.4f} | "
        f"{q.coverage.mean():.2f} | {q.coverage.min():.2f} | {total:.3f} | {error.max():.2f} | "
        f"{seconds:.2f} |"
    )


def table(
    models: Sequence[tuple[str, Callable[[], SurrogateModel]]], known: Truth, sizes: Sequence[int]
) -> list[str]:
    lines = [HEAD, RULE]
    for name, kind in models:
        for n in sizes:
            x, y = known.designs[n]
            model = kind()
            if n < model.fewest(x.shape[1]):
                continue
            started = time.process_time()
            fitted = model.fit(x, y, seed=1)
            lines.append(row(name, n, fitted, known, time.process_time() - started))
            sys.stderr.write(lines[-1] + "\n")
    return [*lines, ""]


def named(*names: str) -> list[tuple[str, Callable[[], SurrogateModel]]]:
    return [(name, lambda name=name: make(name)) for name in names]  # type: ignore[misc]


def variants(known: Truth) -> list[tuple[str, Callable[[], SurrogateModel]]]:
    """What `gp` would be with less."""
    trend = FirstOrderTrend(known.start, known.value, known.slope)
    return [
        ("gp", GaussianProcess),
        ("nothing learnt: all variables alike", lambda: GaussianProcess(learning=Learning(steps=0))),
        ("one set of relevances for all outputs", lambda: GaussianProcess(learning=Learning(shrink=1e6))),
        ("bend held along the relevances", lambda: GaussianProcess(learning=Learning(wait=99))),
        ("gp with exact slopes at the start", lambda: GaussianProcess(trend=trend)),
    ]


def coverage_table(known: Truth) -> list[str]:
    """Coverage of the test set: as predicted, calibrated by held left-out rows, by refitted folds."""
    lines = ["| n | raw | leave-one-out, held | ten refitted folds | Q2 held | Q2 refitted | Q2 test |"]
    lines.append("|---|---|---|---|---|---|---|")
    for n in SIZES[1:-1]:
        (x, y), model = known.designs[n], make("gp_ard")
        fitted = model.fit(x, y)
        held, refitted = fitted.cross_validate(), refit_folds(model, x, y, folds=10, seed=1)
        total = np.square(y - y.mean(axis=0)).sum(axis=0)
        q2 = [float((1 - np.square(h.residual).sum(axis=0) / total).mean()) for h in (held, refitted)]
        error = np.abs(known.test[1] - fitted.predict(known.test[0]))
        sd = NOMINAL_WIDTH * np.sqrt(fitted.variance(known.test[0]))
        ones, many = np.ones(y.shape[1]), len(x)
        factors = (ones, calibration_factors(held, many), calibration_factors(refitted, 10))
        covered = " | ".join(f"{(error <= sd * np.sqrt(f)).mean():.3f}" for f in factors)
        test = quality_on(fitted, *known.test).q2.mean()
        lines.append(f"| {n} | {covered} | {q2[0]:.4f} | {q2[1]:.4f} | {test:.4f} |")
    return [*lines, ""]


def speed_lines(known: Truth) -> list[str]:
    """Fit and prediction of 70 outputs."""
    x, y = known.designs[120][0][:100], known.designs[120][1][:100]
    mixed = y @ np.random.default_rng(0).normal(size=(y.shape[1], 70 - y.shape[1])) / y.std(axis=0).mean()
    many = np.column_stack([y, mixed])
    fitted = GaussianProcess().fit(x, many)
    again = GaussianProcess(start=fitted, learning=Learning(steps=2))
    points = known.test[0]
    jobs: list[tuple[str, Callable[[], object]]] = [
        ("fit, 100 designs, 70 outputs", lambda: GaussianProcess().fit(x, many)),
        ("fit again from the last one's kernels, 2 steps", lambda: again.fit(x, many)),
        ("mean, 1 point", lambda: fitted.predict(points[:1])),
        ("mean, variance and their gradients, 1 point", lambda: fitted.predict_all(points[:1])),
        ("mean and gradient, 20 points", lambda: (fitted.predict(points[:20]), fitted.gradient(points[:20]))),
        ("mean, variance and their gradients, 20 points", lambda: fitted.predict_all(points[:20])),
    ]
    return [f"- {name}: {1e3 * best_of(job):.1f} ms" for name, job in jobs] + [""]


def best_of(job: Callable[[], object], times: int = 7) -> float:
    seconds = []
    for _ in range(times):
        started = time.process_time()
        job()
        seconds.append(time.process_time() - started)
    return min(seconds)


def main() -> None:
    known = truth()
    few = known.part(FEW)
    d, m = known.slope.shape[1], len(CHARACTERISTICS)
    publish(
        "surrogates",
        [
            "# Surrogates",
            "",
            f"Example axle, {d} variables, {m} characteristics, Latin hypercubes of n designs over the whole "
            f"ranges, {TESTS} further designs as test. Coverage: of 95 % intervals, not calibrated. "
            "Jacobian error: of the characteristics' gradients at "
            "the start against exact sensitivities, relative, all characteristics over their standard "
            f"deviations, and the worst one alone. Seconds of a processor, one thread, niced, much other "
            f"work on the machine. {machine()}.",
            "",
            "## All characteristics",
            "",
            *table(named("linear", "rbf", "gp", "gp_ard"), known, SIZES),
            *table(named("quadratic"), known, SIZES[:-1]),
            f"## Costly models, {len(few.value)} of the characteristics",
            "",
            "SMT's KRG at 50 designs: `surrogate_peers.md`.",
            "",
            *table(named("gp", "gp_ard", "kpls"), few, (40, 120)),
            "## What makes the difference in `gp`",
            "",
            *table(variants(known), known, (20, 40, 80, 120)),
            "## Coverage and cross-validation of `gp_ard`",
            "",
            *coverage_table(known),
            "## Speed of `gp`",
            "",
            *speed_lines(known),
        ],
    )


if __name__ == "__main__":
    main()
