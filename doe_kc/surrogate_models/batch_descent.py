"""Many minimisations of equal size at once, each by L-BFGS of its own, all evaluated together.

Reference: J. Nocedal, S. J. Wright, Numerical Optimization, 2nd ed. 2006, algorithms 7.4 and 3.1.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from doe_kc.ground.typing import FloatArray

DESCENT_MEMORY = 10
"""Pairs of steps that a direction is made of."""
ARMIJO_SHARE = 1e-4
"""Share of the decrease that the slope promises from which a step is taken."""
SHORTEST, LONGEST_CUT = 0.1, 0.5
"""Between which a refused step is shortened."""
LONGEST_STEP = 3.0
"""Largest change of a variable in one step: of a logarithm, a factor of 20."""

Objective = Callable[[FloatArray, np.ndarray], tuple[FloatArray, FloatArray]]
"""Points (k, d) of the problems numbered (k,) to values (k,) and gradients (k, d)."""


def minimise(
    objective: Objective, first: FloatArray, *, evaluations: int, low: FloatArray, high: FloatArray
) -> FloatArray:
    """(m, d) lowest points of m problems from `first` (m, d), between low and high (m, d).

    evaluations: of each problem. A problem that has come to rest is evaluated no more. Deterministic; what is
    made of one problem does not depend on the others.
    """
    state = _Descent.at(first, *objective(first, np.arange(len(first))))
    for _ in range(evaluations - 1):
        active = np.flatnonzero(~state.resting)
        if not active.size:
            break
        trial = np.clip(state.point + state.step[:, None] * state.direction, low, high)[active]
        state.learn(active, trial, *objective(trial, active))
    return state.point


@dataclass
class _Descent:
    """Of m problems: where they are, (m, d) point, gradient, direction, (m,) value, step, resting; steps and
    differences (k, m, d) of the k earlier gradients, the newest first, with inverse products (k, m), 0
    where there is none."""

    point: FloatArray
    value: FloatArray
    gradient: FloatArray
    direction: FloatArray
    step: FloatArray
    resting: np.ndarray
    steps: FloatArray
    differences: FloatArray
    inverse: FloatArray

    @classmethod
    def at(cls, point: FloatArray, value: FloatArray, gradient: FloatArray) -> _Descent:
        """The first step is one unit long at most."""
        size = np.linalg.norm(gradient, axis=1)
        memory = np.zeros((DESCENT_MEMORY, *point.shape))
        return cls(
            point.copy(), value, gradient, -gradient, 1.0 / np.maximum(size, 1.0), size == 0.0,
            memory, memory.copy(), np.zeros(memory.shape[:2]),
        )  # fmt: skip

    def learn(self, active: np.ndarray, trial: FloatArray, value: FloatArray, gradient: FloatArray) -> None:
        """Takes the trial points (k, d) of the problems `active` that are low enough, shortens the others'
        steps."""
        moved = trial - self.point[active]
        promised = (self.gradient[active] * moved).sum(axis=1)
        low = value <= self.value[active] + ARMIJO_SHARE * promised
        refused = active[~low]
        # the minimum of the parabola through value and slope here and the value there
        rise = value[~low] - self.value[refused] - promised[~low]
        cut = np.clip(-0.5 * promised[~low] / np.maximum(rise, 1e-300), SHORTEST, LONGEST_CUT)
        self.step[refused] *= cut
        self.resting[refused] |= self.step[refused] < 1e-8
        taken = active[low]
        if taken.size:
            self._remember(taken, moved[low], gradient[low] - self.gradient[taken])
            self.point[taken], self.value[taken] = trial[low], value[low]
            self.gradient[taken] = gradient[low]
            self._turn(taken)

    def _remember(self, taken: np.ndarray, moved: FloatArray, change: FloatArray) -> None:
        product = (moved * change).sum(axis=1)
        fit = product > 1e-10 * (change * change).sum(axis=1)
        new = taken[fit]
        for memory, entry in ((self.steps, moved[fit]), (self.differences, change[fit])):
            memory[1:, new] = memory[:-1, new]
            memory[0, new] = entry
        self.inverse[1:, new] = self.inverse[:-1, new]
        self.inverse[0, new] = 1.0 / product[fit]

    def _turn(self, taken: np.ndarray) -> None:
        """New directions, two loops over the memory."""
        steps, differences, inverse = self.steps[:, taken], self.differences[:, taken], self.inverse[:, taken]
        q = self.gradient[taken].copy()
        shares = np.zeros_like(inverse)
        depth = int((inverse > 0.0).any(axis=1).sum())
        for k in range(depth):
            shares[k] = inverse[k] * (steps[k] * q).sum(axis=1)
            q -= shares[k][:, None] * differences[k]
        newest = (differences[0] ** 2).sum(axis=1)
        scale = 1.0 / np.maximum(np.linalg.norm(q, axis=1), 1.0)
        known = inverse[0] > 0.0
        scale[known] = 1.0 / (inverse[0, known] * newest[known])
        q *= scale[:, None]
        for k in reversed(range(depth)):
            back = inverse[k] * (differences[k] * q).sum(axis=1)
            q += (shares[k] - back)[:, None] * steps[k]
        self.direction[taken] = -q
        self.step[taken] = np.minimum(1.0, LONGEST_STEP / np.maximum(np.abs(q).max(axis=1), 1e-300))
        self.resting[taken] |= np.abs(self.gradient[taken]).max(axis=1) < 1e-5
