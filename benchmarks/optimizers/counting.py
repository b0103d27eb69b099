"""One wrapper around the true solver for everyone: it counts, logs, and ends a search at its budget."""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, fields

import numpy as np

from doe_kc.correlation.linearization import Linearization
from doe_kc.correlation.loop import Evaluate
from doe_kc.correlation.problem import Candidate, Evaluated, Problem
from doe_kc.ground.typing import FloatArray
from doe_kc.targets import Targets
from doe_kc.true_solver.outcome import Outcome

FAILED = 10.0
"""A failed design counts as this many times the baseline's loss and residuals."""


class BudgetSpent(Exception):
    """Ends a peer's search; every peer is run until then or until it stops by itself."""


def deviations(targets: Targets, values: FloatArray) -> FloatArray:
    """(k,) normalised errors (value - target) / Norm of the active characteristics."""
    pairs = zip(targets.characteristics, values, strict=True)
    return np.array([(v - t.value) / (t.objective or t.constraint).norm for t, v in pairs if t.active])


@dataclass
class Log:
    """One entry an evaluation, the baseline first. deviation: inf, rating: -inf after a failure."""

    rating: list[float] = field(default_factory=list)
    deviation: list[float] = field(default_factory=list)
    feasible: list[bool] = field(default_factory=list)


class CountingSolver:
    """Counts each evaluation, repeated designs too. `BudgetSpent` at the budget or the deadline.

    cpu: seconds inside the true solver. The baseline is evaluated on construction unless `run_method`
    is to do it; a peer's first call at the start is answered with it, not counted again.
    """

    def __init__(self, problem: Problem, solve: Evaluate, budget: int, *, seconds: float = np.inf) -> None:
        self.problem, self.budget, self.cpu, self.log = problem, budget, 0.0, Log()
        self._solve, self._deadline = solve, time.perf_counter() + seconds
        self._baseline: Evaluated | None = None
        self._reusable = True

    def evaluate(self, designs: Sequence[Mapping[str, float]]) -> list[Outcome]:
        """Answers of the true solver, for `run_method`."""
        return [self._one(design) for design in designs]

    @property
    def baseline(self) -> Evaluated:
        """The start's answer, the first evaluation."""
        if self._baseline is None:
            self._baseline = self._confirmed(self.problem.space.start)
        return self._baseline

    def at(self, point: FloatArray) -> Evaluated:
        """The design at a point (d,), inside the bounds."""
        baseline, inside = self.baseline, np.clip(point, 0.0, 1.0)
        if self._reusable and np.array_equal(inside, baseline.point):
            self._reusable = False
            return baseline
        return self._confirmed(inside)

    def loss(self, point: FloatArray) -> float:
        """Minus the rating."""
        found = self.at(point)
        return -found.merit if found.rating is not None else -FAILED * self.baseline.merit

    def residuals(self, point: FloatArray) -> FloatArray:
        """Objectives' e / Norm, constraints' violation times sqrt(QuadWt) / Norm, scaled curves' errors."""
        found = self.at(point)
        if found.rating is None:
            return FAILED * residuals_of(self.problem.targets, self.baseline)
        return residuals_of(self.problem.targets, found)

    def _confirmed(self, point: FloatArray) -> Evaluated:
        outcome = self._one(self.problem.space.values(point))
        return self.problem.judged(len(self.log.rating) - 1, Candidate(point, "peer"), outcome)

    def _one(self, design: Mapping[str, float]) -> Outcome:
        if len(self.log.rating) >= self.budget or time.perf_counter() > self._deadline:
            raise BudgetSpent
        started = time.process_time()
        outcome = self._solve([design])[0]
        self.cpu += time.process_time() - started
        self._note(outcome)
        return outcome

    def _note(self, outcome: Outcome) -> None:
        found = self.problem.judged(0, Candidate(self.problem.space.start, ""), outcome)
        solved = found.score is not None and found.rating is not None
        errors = deviations(self.problem.targets, found.score.values) if found.score else np.array([np.inf])
        self.log.rating.append(found.merit)
        self.log.deviation.append(float(np.square(errors).sum()))
        self.log.feasible.append(bool(solved and found.rating and found.rating.feasible))


def residuals_of(targets: Targets, found: Evaluated) -> FloatArray:
    """(r,) whose sum of squares has its minimum where all objectives and constraints are met."""
    if found.score is None or found.rating is None:
        raise ValueError("a failed design has no residuals")
    terms: list[float] = []
    violation = found.rating.violation
    for target, value, excess in zip(targets.characteristics, found.score.values, violation, strict=True):
        if target.objective is not None:
            terms.append((value - target.value) / target.objective.norm)
        if target.constraint is not None:
            terms.append(float(np.sqrt(target.constraint.quadratic)) * excess / target.constraint.norm)
    return np.concatenate([terms, found.scaled - targets.scaled_targets])


@dataclass(frozen=True)
class WatchedProblem(Problem):
    """Notes in `asked` the seconds of each exact sensitivity: they are no evaluations but cost time."""

    asked: list[float] = field(default_factory=list)

    def linearize(self, point: FloatArray) -> Linearization:
        """As the problem's."""
        started = time.process_time()
        try:
            return super().linearize(point)
        finally:
            self.asked.append(time.process_time() - started)


def watched(problem: Problem) -> WatchedProblem:
    """The same problem, watched."""
    return WatchedProblem(**{f.name: getattr(problem, f.name) for f in fields(problem)})
