"""All evaluations of a run, whichever search proposed them, and what is modelled from them."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import cached_property

import numpy as np

from doe_kc.correlation.modelled.archive import Archive, build_archive
from doe_kc.correlation.modelled.proposal import fit_outputs, level_steps
from doe_kc.correlation.problem import Evaluated, Problem
from doe_kc.ground.typing import FloatArray
from doe_kc.surrogate_models.interface import Fitted
from doe_kc.surrogate_models.learning import Learning
from doe_kc.surrogate_models.training import constant_outputs

ROWS = 160
"""Designs that surrogates are fitted to, those nearest the best one: the cost grows with their cube."""
TRIES = 200
"""A guard: only on very few levels are so many neighbours known."""
MODEL_DESIGNS = 5
"""Sound designs below which nothing is modelled."""
NUGGET = 1e-5
"""Share of each output's variance: what jumps and the left-out curve components disturb."""


class SearchHistory:
    """Frozen view of the evaluations. sound: with a finite rating; failed: the others."""

    def __init__(self, problem: Problem, evaluated: Iterable[Evaluated], *, seed: int) -> None:
        self.problem, self.seed = problem, seed
        self.evaluated = tuple(evaluated)
        self.sound = tuple(e for e in self.evaluated if np.isfinite(e.merit))
        self.failed = tuple(e for e in self.evaluated if not np.isfinite(e.merit))

    @property
    def best(self) -> Evaluated:
        """The best rating, the earlier one of equals."""
        return max(self.sound, key=lambda e: e.merit)

    @cached_property
    def ranked(self) -> tuple[Evaluated, ...]:
        """Sound designs, best rating first."""
        return tuple(sorted(self.sound, key=lambda e: -e.merit))

    @cached_property
    def archive(self) -> Archive:
        """Points and outputs of the sound designs nearest the best one."""
        return build_archive(self.problem.search, nearest(self.sound, self.best.point, ROWS))

    @cached_property
    def model(self) -> Fitted:
        """Gaussian processes of all outputs."""
        return fit_outputs(self.archive, seed=self.seed, learning=Learning(nugget=NUGGET))

    @property
    def can_model(self) -> bool:
        """Whether there are enough designs, and outputs that change between them."""
        return len(self.sound) >= MODEL_DESIGNS and not constant_outputs(self.archive.outputs).all()

    def doubtful(self, point: FloatArray) -> bool:
        """Whether the nearest evaluated design failed."""
        if not self.failed:
            return False
        return distance(self.failed, point) < distance(self.sound, point)

    def fresh(self, point: FloatArray, taken: Sequence[FloatArray], rng: np.random.Generator) -> FloatArray:
        """The point on levels; while it is known or among `taken`, one more variable moved by a level."""
        space = self.problem.space
        known = {e.point.tobytes() for e in self.evaluated} | {t.tobytes() for t in taken}
        current = space.snapped(point)
        steps = level_steps(space)
        for _ in range(TRIES):
            if current.tobytes() not in known:
                break
            i = int(rng.integers(space.dimension))
            current = current.copy()
            current[i] += rng.choice([-1.0, 1.0]) * (steps[i] or 0.01)
            current = space.snapped(current)
        return current


def distance(evaluated: Sequence[Evaluated], point: FloatArray) -> float:
    """Euclidean distance to the nearest one in the unit cube."""
    return min(float(np.linalg.norm(e.point - point)) for e in evaluated)


def nearest(evaluated: Sequence[Evaluated], point: FloatArray, rows: int) -> tuple[Evaluated, ...]:
    """The designs nearest a point, at most `rows`, in the order in which they were evaluated."""
    if len(evaluated) <= rows:
        return tuple(evaluated)
    apart = np.array([np.linalg.norm(e.point - point) for e in evaluated])
    return tuple(evaluated[i] for i in np.sort(np.argsort(apart, kind="stable")[:rows]))
