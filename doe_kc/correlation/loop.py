"""The one loop that drives every correlation method: ask, confirm by the true solver, tell."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

from doe_kc.correlation.methods._base import Method
from doe_kc.correlation.problem import Candidate, Evaluated, Problem
from doe_kc.ground.errors import RunError
from doe_kc.ground.threads import one_thread
from doe_kc.true_solver.outcome import Outcome

Evaluate = Callable[[Sequence[Mapping[str, float]]], Sequence[Outcome]]
Watch = Callable[[Sequence[Evaluated]], None]


@dataclass(frozen=True)
class Run:
    """evaluated: every design in order, the baseline first. best: its place among them. stopped: why."""

    evaluated: tuple[Evaluated, ...]
    best: int
    stopped: str


@one_thread()
def run_method(
    problem: Problem,
    method: Method,
    evaluate: Evaluate,
    *,
    budget: int,
    proposals: Sequence[Candidate] = (),
    known: Sequence[tuple[Candidate, Outcome]] = (),
    until_feasible: bool = False,
    watch: Watch = lambda _: None,
) -> Run:
    """Run a method until it stops or `budget` designs (the baseline among them) are evaluated.

    proposals: designs confirmed right after the baseline. known: designs evaluated before, told to the
    method but not counted. until_feasible: stop at the first design that meets every constraint. watch: told
    of each round.
    RunError when the baseline has no solution.
    """
    history: list[Evaluated] = []

    def confirm(candidates: Sequence[Candidate]) -> list[Evaluated]:
        outcomes = evaluate([problem.space.values(c.point) for c in candidates])
        start = len(history)
        new = [
            problem.judged(start + i, c, o) for i, (c, o) in enumerate(zip(candidates, outcomes, strict=True))
        ]
        history.extend(new)
        watch(new)
        return new

    baseline = confirm([Candidate(problem.space.start, "baseline")])
    if baseline[0].rating is None:
        raise RunError(f"the baseline axle cannot be solved: {baseline[0].outcome.reason}")
    earlier = [problem.judged(-1 - i, c, o) for i, (c, o) in enumerate(known)]
    proposed = confirm(list(proposals)[: budget - 1]) if proposals else []
    method.tell([*baseline, *proposed, *earlier])
    while not method.stopped and len(history) < budget:
        if until_feasible and any(e.feasible for e in history):
            return Run(tuple(history), method.best(history), "the first design that meets every constraint")
        candidates = list(method.ask())[: budget - len(history)]
        if not candidates:
            break
        method.tell(confirm(candidates))
    return Run(tuple(history), method.best(history), method.stopped or "budget used up")
