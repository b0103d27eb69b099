"""The package's own model of the axle that an outside solver solves: cheap answers and exact slopes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property

from doe_kc.axle.model import Axle
from doe_kc.correlation.linearization import Linearization, linearize
from doe_kc.ground.typing import FloatArray
from doe_kc.true_solver.outcome import Outcome
from doe_kc.true_solver.own import AxleSolver
from doe_kc.variables import Space

ANSWER_CACHE = 64
"""Answers of the twin that are kept, some 0.1 MB each: a search asks for its designs again and again."""


@dataclass(frozen=True)
class Twin:
    """axle: with the load cases that the outside model answers. windows: as in `reduce_all`.

    Points are (d,) of the study's space, whose absolute values both models are given.
    """

    axle: Axle
    windows: Mapping[str, float] = field(default_factory=dict)

    def answer(self, space: Space, point: FloatArray) -> Outcome:
        """Curves and characteristics at a point; a failure where the twin has no equilibrium."""
        key = point.tobytes()
        if key not in self._answers:
            self._answers[key] = self._solver.evaluate(space.values(point))
            while len(self._answers) > ANSWER_CACHE:
                self._answers.pop(next(iter(self._answers)))
        return self._answers[key]

    def linearize(self, space: Space, point: FloatArray) -> Linearization:
        """Exact first-order expansion of the twin; NotConverged where it has no equilibrium."""
        return linearize(self.axle, space, point, self.windows)

    @cached_property
    def _solver(self) -> AxleSolver:
        """In compiled code where that is possible: a search asks for hundreds of answers."""
        return AxleSolver(self.axle, self.windows).prepare([{}])

    @cached_property
    def _answers(self) -> dict[bytes, Outcome]:
        return {}
