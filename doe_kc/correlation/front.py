"""The front of confirmed designs: those that no other one beats in every objective, and its knee."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from doe_kc.correlation.objectives import Objectives, objectives, relative_violation
from doe_kc.correlation.problem import Evaluated
from doe_kc.ground.typing import FloatArray
from doe_kc.targets import Targets

if TYPE_CHECKING:
    import pandas as pd

VIOLATION = "constraint violation"
LOSS_LIMIT = 3.0
"""Loss, over the least one, beyond which a design is no trade-off that anyone would make."""


@dataclass(frozen=True)
class Front:
    """f non-dominated confirmed designs, best rating first.

    indices: (f,) of the designs. names: (g,) objectives; when no design is feasible the last one is the
    relative constraint violation. values: (f, g) minus the share of the rating, dimensionless, small is
    good. ratings: (f,). feasible: whether its designs are. knee: place in the front, -1 when it is empty.
    """

    names: tuple[str, ...]
    indices: NDArray[np.int_]
    values: FloatArray
    ratings: FloatArray
    feasible: bool
    knee: int

    def columns(self) -> dict[str, NDArray[Any]]:
        """One row a design: its evaluation, from 1, objectives, rating, whether it is the knee."""
        return {
            "evaluation": np.add(self.indices, 1),
            **dict(zip(self.names, self.values.T, strict=True)),
            "rating": self.ratings,
            "knee": np.arange(len(self.indices)) == self.knee,
        }

    def to_frame(self) -> pd.DataFrame:
        """`columns` as a data frame; index: the evaluation."""
        import pandas as pd

        return pd.DataFrame(self.columns()).set_index("evaluation")


def front_of(targets: Targets, history: Sequence[Evaluated], *, chosen: Objectives | None = None) -> Front:
    """Front of any method's designs; chosen: the objectives, by default one a load case.

    Feasible designs alone while there are any (their best rating is on it: the rating falls with every
    objective), of those the ones with at most STRETCH times the least loss: in many objectives nearly
    every design is best at something. Without a feasible design all, the violation being one more objective.
    """
    chosen = chosen or objectives(targets)
    sound = [e for e in history if np.isfinite(e.merit)]
    feasible = [e for e in sound if e.feasible]
    pool = sorted(feasible or sound, key=lambda e: (-e.merit, e.index))
    names = chosen.names if feasible else (*chosen.names, VIOLATION)
    values = np.array([_values(targets, chosen, e, not feasible) for e in pool]).reshape(-1, len(names))
    places = non_dominated(values)
    if feasible:
        places = places[values[places].sum(axis=1) <= bearable(values.sum(axis=1).min())]
    return Front(
        names,
        np.array([pool[i].index for i in places], dtype=int),
        values[places],
        np.array([pool[i].merit for i in places]),
        bool(feasible),
        knee(values[places]),
    )


def _values(targets: Targets, objectives: Objectives, design: Evaluated, with_violation: bool) -> FloatArray:
    if design.searched is None:
        raise ValueError("a failed design has no objectives")
    own = objectives.values(design.searched)
    return np.append(own, relative_violation(targets, design.searched)) if with_violation else own


def bearable(least: float) -> float:
    """Largest loss worth a look; least: the smallest one, below zero when goals are to maximize."""
    return least + (LOSS_LIMIT - 1.0) * abs(least)


def non_dominated(values: FloatArray) -> NDArray[np.int_]:
    """Places of the rows (n, g) that no row beats: at least as small everywhere, smaller somewhere.

    Of equal rows the first one.
    """
    keep = []
    for i, row in enumerate(values):
        better = (values <= row).all(axis=1) & (values < row).any(axis=1)
        equal = (values[:i] == row).all(axis=1)
        if not better.any() and not equal.any():
            keep.append(i)
    return np.array(keep, dtype=int)


def normalized(values: FloatArray) -> FloatArray:
    """(f, g) each objective from 0, its best on the front, to 1, its worst there."""
    low, span = values.min(axis=0), np.ptp(values, axis=0)
    return np.asarray((values - low) / np.where(span > 0.0, span, 1.0))


def knee(values: FloatArray) -> int:
    """Place nearest the ideal point, Euclidean, objectives normalized to the front; -1 for an empty one.

    Compromise solution of P. L. Yu, Management Science 19(8), 1973; independent of the objectives' weights.
    """
    if not len(values):
        return -1
    return int(np.argmin(np.linalg.norm(normalized(values), axis=1)))
