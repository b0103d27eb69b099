"""The first proposal where slopes are exact: the most probable design to first order, before any sample."""

from __future__ import annotations

import numpy as np

from doe_kc.correlation.least_squares import bounded_step
from doe_kc.correlation.problem import Candidate, Evaluated, Problem
from doe_kc.solver.result import NotConverged

ORIGIN = "first-order step"


def first_order(problem: Problem, answer: Evaluated) -> Candidate | None:
    """A Gauss-Newton step on records and typed targets from a design, within bounds and on the levels.

    None without data, without sensitivities there, or when the step leads nowhere.
    """
    data = problem.likelihood
    if not data.size or answer.outcome.failed:
        return None
    try:
        expansion = problem.linearize(answer.point)
    except NotConverged:
        return None
    jacobian = data.jacobian(expansion.curves, expansion.characteristics)
    residual = data.residual(answer.outcome.curves, answer.outcome.characteristics)
    weight = problem.space.prior_sd**-2.0
    gradient = jacobian.T @ residual + weight * (answer.point - problem.space.start)
    hessian = jacobian.T @ jacobian + np.diag(weight)
    step = bounded_step(hessian, gradient, -answer.point, 1.0 - answer.point)
    point = problem.space.snapped(answer.point + step)
    return None if np.array_equal(point, answer.point) else Candidate(point, ORIGIN)
