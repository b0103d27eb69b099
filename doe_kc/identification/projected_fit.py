"""Levenberg-Marquardt within bounds: each step solves its quadratic in the box.

Reference: K. Madsen, H. B. Nielsen, O. Tingleff, Methods for Non-Linear Least Squares Problems, 2nd ed.,
Technical University of Denmark 2004, section 3.2 (damping by the gain ratio).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass

import numpy as np

from doe_kc.correlation.least_squares import bounded_step, normal_equations
from doe_kc.ground.typing import FloatArray
from doe_kc.identification.matrix_model import MatrixModel
from doe_kc.identification.unknowns import BOUND_SDS

FIRST_DAMPING = 1.0
"""Of a step in prior standard deviations: as much as the prior's own curvature."""
LARGEST_DAMPING = 1e9
"""Steps are then a billionth of the slope: what does not gain there is rounding."""
FIT_TOLERANCE = 1e-3
"""Share of the cost that a step must promise or have gained to go on."""
MOST_FIT_STEPS = 60
"""At most; fits of the published matrix take 10 to 25."""
CHUNKS_A_WORKER = 3
"""Of a Jacobian's columns: the last one to end leaves little waiting."""


@dataclass(frozen=True)
class MatrixFit:
    """z: (d,). residual: (n,), jacobian: (n, d) there, in noise. sign: (m,) of the columns.

    cost: 1/2 (|residual|^2 + |z|^2). steps: accepted ones. converged: False where their number ran out.
    """

    z: FloatArray
    residual: FloatArray
    jacobian: FloatArray
    sign: FloatArray
    cost: float
    steps: int
    converged: bool


@dataclass(frozen=True)
class _Point:
    z: FloatArray
    residual: FloatArray
    sign: FloatArray

    @property
    def cost(self) -> float:
        return float(self.residual @ self.residual + self.z @ self.z) / 2.0


def _point(model: MatrixModel, z: FloatArray) -> _Point | None:
    solved = model.residual(z) if model.is_axle(z) else None
    return None if solved is None else _Point(z, *solved)


def projected_fit(
    model: MatrixModel,
    start: FloatArray,
    executor: Executor,
    workers: int,
    step_done: Callable[[float], None] = lambda _: None,
) -> MatrixFit | None:
    """The most probable z from a start (d,), |z| <= 2.5 each; None when the start has no equilibrium.

    step_done: told the cost after each accepted step.
    """
    now = _point(model, start)
    if now is None:
        return None
    damping, steps = FIRST_DAMPING, 0
    jacobian = _jacobian(model, now, executor, workers)
    while steps < MOST_FIT_STEPS:
        following = next(_better(model, now, jacobian, damping), None)
        if following is None:
            break
        gained = now.cost - following[0].cost
        (now, damping), steps = following, steps + 1
        jacobian = _jacobian(model, now, executor, workers)
        step_done(now.cost)
        if gained <= FIT_TOLERANCE * now.cost:
            break
    return MatrixFit(now.z, now.residual, jacobian, now.sign, now.cost, steps, steps < MOST_FIT_STEPS)


def _better(
    model: MatrixModel, now: _Point, jacobian: FloatArray, damping: float
) -> Iterator[tuple[_Point, float]]:
    """A point of less cost and the damping to go on with; nothing when no step promises enough."""
    hessian, gradient = normal_equations(jacobian, now.residual, np.ones_like(now.z), now.z)
    growth = 2.0
    while damping < LARGEST_DAMPING:
        damped = hessian + damping * np.eye(now.z.size)
        step = bounded_step(damped, gradient, -BOUND_SDS - now.z, BOUND_SDS - now.z)
        promised = -float(gradient @ step + 0.5 * step @ hessian @ step)
        if promised <= FIT_TOLERANCE * FIT_TOLERANCE * now.cost:
            return
        new = _point(model, now.z + step)
        if new is not None and new.cost < now.cost:
            ratio = (now.cost - new.cost) / promised
            yield new, damping * max(1.0 / 3.0, 1.0 - (2.0 * ratio - 1.0) ** 3)
            return
        damping, growth = damping * growth, 2.0 * growth


def _jacobian(model: MatrixModel, at: _Point, executor: Executor, workers: int) -> FloatArray:
    """(n, d) at a point, its columns shared among the workers."""
    parts = [list(part) for part in np.array_split(np.arange(at.z.size), _parts(at.z.size, workers))]
    futures = [executor.submit(_columns, model, at, part) for part in parts]
    return np.array([column for future in futures for column in future.result()]).T


def _parts(size: int, workers: int) -> int:
    return 1 if workers == 1 else min(size, CHUNKS_A_WORKER * workers)


def _columns(model: MatrixModel, at: _Point, which: Sequence[int]) -> list[FloatArray]:
    return model.columns(at.z, at.residual, at.sign, which)
