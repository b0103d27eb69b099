"""A Gauss-Newton fit beside the truth: misfit by load case, estimate, stated error, what the data see."""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from correlation_runs import solve_run

from doe_kc.correlation.likelihood import Likelihood
from doe_kc.correlation.posterior import posterior
from doe_kc.correlation.problem import Problem
from doe_kc.ground.typing import FloatArray

BUDGET = 25
STATED = 2.0
"""Stated standard deviations that the truth should lie within for about 95 % of the parameters."""


@dataclass(frozen=True)
class Fit:
    """Places u between the bounds, (d,) each; prior: their prior sd; true: nan where the key is silent.

    misfit: load case -> mean squared residual in units of the noise. seconds: of one core.
    """

    paths: list[str]
    misfit: dict[str, float]
    estimate: list[float]
    sd: list[float]
    prior: list[float]
    visible: list[bool]
    true: list[float]
    start: list[float]
    evaluations: int
    feasible: bool
    seconds: float
    stopped: str

    @property
    def z(self) -> FloatArray:
        """(d,) (estimate - truth) / stated sd."""
        return (np.array(self.estimate) - self.true) / self.sd

    @property
    def judged(self) -> FloatArray:
        """(d,) bool: visible and with a known truth."""
        return np.array(self.visible) & np.isfinite(self.true)

    @property
    def inside(self) -> int:
        """Judged parameters within STATED sd of the truth."""
        return int((np.abs(self.z[self.judged]) <= STATED).sum())


def fitted(problem: Problem, known: Mapping[str, float]) -> Fit:
    """Gauss-Newton from nominal, beside the known values (absolute)."""
    started = time.process_time()
    run = solve_run(problem, "gauss_newton", 1, BUDGET)
    seconds = time.process_time() - started
    best = run.evaluated[run.best]
    expansion = problem.linearize(best.point)
    jacobian = problem.likelihood.jacobian(expansion.curves, expansion.characteristics)
    found = posterior(jacobian, problem.space.prior_sd)
    residual = problem.likelihood.residual(best.outcome.curves, best.outcome.characteristics)
    true = [v.place(known[v.path]) if v.path in known else np.nan for v in problem.space.variables]
    return Fit(
        paths=list(problem.space.paths),
        misfit=misfit_by_case(problem.likelihood, residual),
        estimate=best.point.tolist(),
        sd=found.sd.tolist(),
        prior=found.prior.tolist(),
        visible=found.visible.tolist(),
        true=true,
        start=problem.space.start.tolist(),
        evaluations=len(run.evaluated),
        feasible=best.rating is not None and best.rating.feasible,
        seconds=seconds,
        stopped=run.stopped,
    )


def far_off(fits: Sequence[Fit], beyond: float = 3.0) -> list[tuple[str, float]]:
    """Judged parameters more than so many stated sd from the truth, the farthest first: path and z."""
    found = [
        (path, float(z))
        for f in fits
        for path, z, judged in zip(f.paths, f.z, f.judged, strict=True)
        if judged and abs(z) > beyond
    ]
    return sorted(found, key=lambda entry: -abs(entry[1]))


def misfit_by_case(data: Likelihood, residual: FloatArray) -> dict[str, float]:
    """Load case -> mean square; "static" for the alignment, "all" for everything."""
    parts: dict[str, list[FloatArray]] = {}
    end = 0
    for curve, place in data.slices():
        parts.setdefault(curve.load_case, []).append(residual[place])
        end = place.stop
    squares = {case: float(np.mean(np.concatenate(p) ** 2)) for case, p in parts.items()}
    return squares | {"static": float(np.mean(residual[end:] ** 2)), "all": float(np.mean(residual**2))}
