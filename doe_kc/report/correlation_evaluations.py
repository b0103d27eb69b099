"""Every true-solver evaluation of a correlation, in order."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pandas as pd

from doe_kc.correlation.problem import Evaluated
from doe_kc.correlation.result import Correlation
from doe_kc.ground.typing import FloatArray


@dataclass(frozen=True)
class History:
    """Merits of the search over n evaluations, all (n,).

    number: 1 = the baseline. rating: nan after a failure. best: largest so far. predicted, sd: what the
    method expected, nan where it expected nothing.
    """

    number: FloatArray
    origin: tuple[str, ...]
    rating: FloatArray
    best: FloatArray
    feasible: np.ndarray
    failed: np.ndarray
    predicted: FloatArray
    sd: FloatArray

    @property
    def first_feasible(self) -> int | None:
        """Number of the first evaluation that meets every constraint."""
        return int(self.number[np.argmax(self.feasible)]) if self.feasible.any() else None

    @property
    def origins(self) -> tuple[str, ...]:
        """What proposed designs, in order of appearance."""
        return tuple(dict.fromkeys(self.origin))


def history(correlation: Correlation) -> History:
    """Ratings of a run in order."""
    runs = correlation.run.evaluated
    merit = np.array([e.merit for e in runs])
    expected = [e.candidate.predicted for e in runs]
    return History(
        number=np.arange(1, len(runs) + 1, dtype=float),
        origin=tuple(e.candidate.origin for e in runs),
        rating=np.where(np.isfinite(merit), merit, np.nan),
        best=np.maximum.accumulate(merit),
        feasible=np.array([e.feasible for e in runs]),
        failed=np.array([e.rating is None for e in runs]),
        predicted=np.array([p.rating if p else np.nan for p in expected], dtype=float),
        sd=np.array([p.rating_sd if p else np.nan for p in expected], dtype=float),
    )


def evaluation_frame(correlation: Correlation) -> pd.DataFrame:
    """One row an evaluation: its figures, then the absolute value of every variable by path."""
    past = history(correlation)
    figures = pd.DataFrame(
        {
            "evaluation": past.number.astype(int),
            "origin": past.origin,
            "merit": past.rating,
            "best_so_far": past.best,
            "feasible": past.feasible,
            "chosen": [i == correlation.run.best for i in range(past.number.size)],
            "failed_because": [e.outcome.reason for e in correlation.run.evaluated],
            "predicted_merit": past.predicted,
            "predicted_sd": past.sd,
            "seconds": [e.outcome.seconds for e in correlation.run.evaluated],
        }
    )
    paths = list(correlation.problem.space.paths)
    values = pd.DataFrame([_values(correlation, e) for e in correlation.run.evaluated], columns=paths)
    return pd.concat([figures, values], axis=1)


def _values(correlation: Correlation, evaluated: Evaluated) -> list[float]:
    values = correlation.problem.space.values(evaluated.point)
    return [values[p] for p in correlation.problem.space.paths]
