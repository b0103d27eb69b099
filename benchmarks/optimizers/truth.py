"""How the car that the records were made of rates itself: what measurement noise leaves."""

from __future__ import annotations

import numpy as np
from optimizers.counting import deviations
from optimizers.running import CAR, problem

from doe_kc.correlation.problem import Candidate
from tests.correlation import cases


def true_car() -> tuple[float, float]:
    """Rating and deviation of the car's key, not used by any method."""
    known = problem()
    start = known.space.values(known.space.start)
    key = cases.truth(CAR, known.axle)
    outcome = cases.outcome(known.axle, start | {p: v for p, v in key.items() if p in start})
    found = known.judged(0, Candidate(known.space.start, "key"), outcome)
    if found.score is None or found.rating is None:
        raise ValueError(f"the key of {CAR} has no solution: {outcome.reason}")
    return found.rating.total, float(np.square(deviations(known.targets, found.score.values)).sum())
