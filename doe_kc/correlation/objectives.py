"""The objectives of a trade-off: the terms of equation 2.2 summed by load case, constraints apart."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from doe_kc.ground.errors import InputError
from doe_kc.ground.typing import FloatArray
from doe_kc.targets import Objective, Rating, Target, Targets


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
