"""Targets of a correlation: characteristics with objective and constraint, and measured curves."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np

from doe_kc.characteristics import CHARACTERISTICS, Characteristic
from doe_kc.curves import CurveSet
from doe_kc.ground.typing import FloatArray
from doe_kc.targets.comparison import FLOOR
from doe_kc.targets.options import Goal

LIMIT_MARGIN = 5e-4
"""Share of the measure within which a limit is charged for already: a design that leans on it, steep as the
price is, still meets it, and one that lies at it, as the baseline may, pays a quarter."""


@dataclass(frozen=True, kw_only=True)
class Objective:
    """LinWt, QuadWt and Norm of one objective of equation 2.2; norm in the unit of the objective.

    goal "target": Obj = |value - target|, S = -1; "minimize": Obj = value, S = -1; "maximize": S = +1.
    """

    goal: Goal = "target"
    linear: float = 1.0
    quadratic: float = 0.0
    norm: float = 1.0

    @property
    def sign(self) -> float:
        """S of equation 2.2."""
        return 1.0 if self.goal == "maximize" else -1.0


@dataclass(frozen=True, kw_only=True)
class Constraint:
    """The interval that the value must lie in, and LinWt, QuadWt, Norm of its violation."""

    low: float
    high: float
    linear: float = 0.0
    quadratic: float = 10000.0
    norm: float = 1.0


@dataclass(frozen=True, kw_only=True)
class Target:
    """One characteristic's target, in its unit. sd: standard deviation of the target, 0 when exact.

    objective, constraint: its terms of the rating. excluded: the study takes it out of the objectives, so
    that a search on everything that was measured leaves it out too. hold: whether a search must not move it
    away from the target. limit: distance from the target beyond which a search pays LIMIT_WEIGHT. relax:
    whether its interval may be widened to what the bounds allow.
    """

    entry: Characteristic
    value: float
    sd: float
    objective: Objective | None = None
    constraint: Constraint | None = None
    excluded: bool = False
    hold: bool = True
    limit: float = math.inf
    relax: bool = True

    @property
    def scale(self) -> float:
        """sqrt(target^2 + 0.005), the measure of the constraint interval (equation 5.1), in its unit."""
        return math.sqrt(self.value**2 + FLOOR)

    @property
    def threshold(self) -> float:
        """Distance from which the limit is charged for, in the characteristic's unit."""
        return max(0.0, self.limit - LIMIT_MARGIN * self.scale)

    @property
    def active(self) -> bool:
        """Whether the correlation works on it; the others are followed only."""
        return self.objective is not None or self.constraint is not None


@dataclass(frozen=True, kw_only=True)
class CurveTarget:
    """A measured mean curve of both wheels that the model's shall follow.

    input: (n,) load-case input in `input_unit`. curve: (2, n) left and right, response's unit. noise: its
    RMS standard deviation, below which two curves do not differ. limit: RMS deviation beyond which a search
    pays LIMIT_WEIGHT, in the response's unit. excluded, hold: as of `Target`.
    """

    load_case: str
    response: str
    input_unit: str
    input: FloatArray
    curve: FloatArray
    noise: float
    objective: Objective
    limit: float = math.inf
    excluded: bool = False
    hold: bool = True

    @property
    def threshold(self) -> float:
        """RMS from which the limit is charged for, in the response's unit."""
        return max(0.0, self.limit - LIMIT_MARGIN * self.objective.norm)

    @property
    def id(self) -> str:
        """`load_case.response`."""
        return f"{self.load_case}.{self.response}"


@dataclass(frozen=True)
class MisfitTerm:
    """The records as data, one more term of a search: minus `weight` times the mean of the squared residuals.

    size: number of residuals, each in standard deviations of its datum.
    """

    size: int
    weight: float


@dataclass(frozen=True)
class Targets:
    """All targets. Characteristics that have a target but are not `active` are followed only.

    curves: those that the rating counts. others: the other measured ones. dropped: (load case, response) of
    the curves that the study takes out of the correlation. misfit: None where the records as data do not
    count beside the targets.
    """

    characteristics: tuple[Target, ...]
    curves: tuple[CurveTarget, ...]
    source: str
    dropped: frozenset[tuple[str, str]] = frozenset()
    others: tuple[CurveTarget, ...] = ()
    misfit: MisfitTerm | None = None

    @cached_property
    def rows(self) -> np.ndarray:
        """(k,) places of the targets' characteristics in the registry."""
        order = list(CHARACTERISTICS)
        return np.array([order.index(t.entry.id) for t in self.characteristics], dtype=int)

    @property
    def values(self) -> FloatArray:
        """(k,) target values."""
        return np.array([t.value for t in self.characteristics])

    @property
    def active(self) -> np.ndarray:
        """(k,) bool."""
        return np.array([t.active for t in self.characteristics], dtype=bool)

    def scaled_curves(self, curves: CurveSet) -> FloatArray:
        """(N,) the model's curves at the measured inputs, left and right, each point over Norm sqrt(2 n).

        The distance of two such vectors within one curve's block is its RMS over Norm.
        KeyError for a curve that the model lacks.
        """
        blocks = [_scaled(t, sampled(t, curves)) for t in self.curves]
        return np.concatenate(blocks) if blocks else np.zeros(0)

    @cached_property
    def scaled_targets(self) -> FloatArray:
        """(N,) the measured curves, scaled alike, then zeros for the residuals of the misfit."""
        blocks = [_scaled(t, t.curve) for t in self.curves]
        return np.concatenate([*blocks, np.zeros(self.misfit.size if self.misfit is not None else 0)])

    @cached_property
    def blocks(self) -> tuple[slice, ...]:
        """Where each curve lies in the scaled vector, and last the misfit."""
        more = [] if self.misfit is None else [self.misfit.size]
        ends = np.cumsum([0] + [t.curve.size for t in self.curves] + more)
        return tuple(slice(int(a), int(b)) for a, b in pairwise(ends))


def sampled(target: CurveTarget, curves: CurveSet) -> FloatArray:
    case = curves.cases[target.load_case]
    return np.array([np.interp(target.input, case.input, row) for row in case.mean[target.response]])


def _scaled(target: CurveTarget, curve: FloatArray) -> FloatArray:
    return np.asarray(curve.ravel() / (target.objective.norm * np.sqrt(curve.size)))
