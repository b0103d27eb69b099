"""The trade-off between load cases: its objectives, and the front of confirmed designs with its knee."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from doe_kc.correlation.problem import Evaluated
from doe_kc.ground.errors import InputError
from doe_kc.ground.typing import FloatArray
from doe_kc.targets import Objective, Rating, Target, Targets

if TYPE_CHECKING:
    import pandas as pd


@dataclass(frozen=True)
class Objectives:
    """g objectives, each minus its share of the rating: 0 = its targets met, the larger the worse.

    names: (g,) load cases, or single objectives. characteristics: (k,), curves: (c,) which objective a
    target belongs to, -1 = none.
    """

    names: tuple[str, ...]
    characteristics: NDArray[np.int_]
    curves: NDArray[np.int_]

    def values(self, rating: Rating) -> FloatArray:
        """(g,) of a design."""
        terms = np.concatenate([rating.objectives, rating.curves])
        member = np.concatenate([self.characteristics, self.curves])
        return np.array([-terms[member == g].sum() for g in range(len(self.names))])


def objectives(targets: Targets) -> Objectives:
    """One objective a load case; each objective term alone when all belong to one load case.

    InputError when there is one term only.
    """
    cases = [t.entry.load_case if t.objective else "" for t in targets.characteristics]
    lines = [c.load_case for c in targets.curves]
    by_case = _grouped(cases, lines)
    if len(by_case.names) > 1:
        return by_case
    single = _grouped(
        [t.entry.id if t.objective else "" for t in targets.characteristics], [c.id for c in targets.curves]
    )
    if len(single.names) > 1:
        return single
    raise InputError(
        f"{targets.source}: pareto needs two objectives to trade against each other and found "
        f"{len(single.names)}; set objective = true for another characteristic or choose --method ego."
    )


def _grouped(characteristics: list[str], curves: list[str]) -> Objectives:
    names = tuple(dict.fromkeys(n for n in [*characteristics, *curves] if n))
    place = {name: i for i, name in enumerate(names)} | {"": -1}
    return Objectives(
        names,
        np.array([place[n] for n in characteristics], dtype=int),
        np.array([place[n] for n in curves], dtype=int),
    )


def relative_violation(targets: Targets, rating: Rating) -> float:
    """Sum of ConViol / Norm over all constraints, 0 for a feasible design."""
    norm = np.array([1.0 if t.constraint is None else t.constraint.norm for t in targets.characteristics])
    return float((rating.violation / norm).sum())


def weighted(targets: Targets, objectives: Objectives, weight: FloatArray) -> Targets:
    """The targets with the weights of each objective's terms multiplied by weight (g,); same constraints."""
    factor = np.append(weight, 1.0)  # -1, no objective, finds the last
    return replace(
        targets,
        characteristics=tuple(
            replace(t, objective=t.objective and _times(t.objective, factor[g]))
            for t, g in zip(targets.characteristics, objectives.characteristics, strict=True)
        ),
        curves=tuple(
            replace(c, objective=_times(c.objective, factor[g]))
            for c, g in zip(targets.curves, objectives.curves, strict=True)
        ),
    )


def only_constraints(targets: Targets) -> Targets:
    """Constraints alone, their violation counted as in `relative_violation`."""
    return replace(
        targets, characteristics=tuple(map(_bare, targets.characteristics)), curves=(), misfit=None
    )


def _bare(target: Target) -> Target:
    constraint = target.constraint and replace(target.constraint, linear=1.0, quadratic=0.0)
    return replace(target, objective=None, constraint=constraint)


def _times(objective: Objective, factor: float) -> Objective:
    return replace(objective, linear=objective.linear * factor, quadratic=objective.quadratic * factor)


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
