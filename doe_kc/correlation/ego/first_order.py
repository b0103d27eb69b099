"""The first proposal where slopes are exact: the most probable design to first order, before any sample."""

from __future__ import annotations

import numpy as np

from doe_kc.correlation.first_order import most_probable_step
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
    step = most_probable_step(jacobian, residual, answer.point, problem.space)
    point = problem.space.snapped(answer.point + step)
    return None if np.array_equal(point, answer.point) else Candidate(point, ORIGIN)
