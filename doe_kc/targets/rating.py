"""What a design reaches of its targets, and its performance rating (thesis, equation 2.2).

sum_i (LinWt_i S_i Obj_i / Norm_i + QuadWt_i S_i Obj_i^2 / Norm_i^2)
- sum_j (LinWt_j ConViol_j / Norm_j + QuadWt_j ConViol_j^2 / Norm_j^2)

0 = every target met exactly (with the default goals), the more negative the worse.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from doe_kc.curves import CurveSet
from doe_kc.ground.typing import FloatArray
from doe_kc.targets.comparison.deviation import rms_deviation
from doe_kc.targets.target import Constraint, Objective, Targets, sampled


@dataclass(frozen=True)
class Score:
    """values: (k,) characteristics in the order of the targets. rms: (c,) in each response's unit.

    misfit: mean square of the residuals against the records, 1 is noise; 0 where it does not count.
    """

    values: FloatArray
    rms: FloatArray
    misfit: float = 0.0


def score(targets: Targets, characteristics: FloatArray, curves: CurveSet | None) -> Score:
    """Score of one design; characteristics: all registered ones, in their order.

    ValueError when a curve target meets a model without curves.
    """
    if targets.curves and curves is None:
        raise ValueError("the model gives no curves, so curve targets cannot be judged")
    rms = [rms_deviation(sampled(t, curves), t.curve) for t in targets.curves] if curves else []
    return Score(np.asarray(characteristics)[targets.rows], np.array(rms))


LIMIT_WEIGHT = 1e6
"""QuadWt of a limit: a hundred times that of a constraint, which is not to be met at the cost of what was
right; what pulls at it, up to some hundreds a measure, is stopped within a few ten-thousandths of it."""


@dataclass(frozen=True)
class Rating:
    """A design's rating and its terms, all of them summed in `total`.

    objectives, constraints: (k,) of the characteristics, 0 without one. curves: (c,), the price of limits
    among them. violation: (k,) ConViol in the characteristic's unit, 0 where met. beyond: (k,) distance from
    the target beyond its limit. excess: (c,) RMS beyond its limit in the response's unit. misfit: term of
    the records as data.
    """

    objectives: FloatArray
    constraints: FloatArray
    curves: FloatArray
    violation: FloatArray
    beyond: FloatArray
    excess: FloatArray
    misfit: float = 0.0

    @property
    def total(self) -> float:
        """Equation 2.2."""
        return float(self.objectives.sum() + self.constraints.sum() + self.curves.sum() + self.misfit)

    @property
    def feasible(self) -> bool:
        """Whether every constraint and limit is met."""
        return not self.violation.any() and self.harmless

    @property
    def harmless(self) -> bool:
        """Whether every limit is met."""
        return not self.beyond.any() and not self.excess.any()


def rate(targets: Targets, score: Score) -> Rating:
    """Rating of one design from its values and RMS deviations; nan values give nan."""
    pairs = list(zip(targets.characteristics, score.values, strict=True))
    violation = np.array([0.0 if t.constraint is None else violated(t.constraint, v) for t, v in pairs])
    beyond = np.array([max(0.0, abs(v - t.value) - t.limit) for t, v in pairs])
    lines = list(zip(targets.curves, score.rms, strict=True))
    excess = np.array([max(0.0, rms - t.limit) for t, rms in lines])
    return Rating(
        objectives=np.array(
            [0.0 if t.objective is None else objective_term(t.objective, v, t.value) for t, v in pairs]
        ),
        constraints=np.array(
            [
                (0.0 if t.constraint is None else constraint_term(t.constraint, x))
                - LIMIT_WEIGHT * (max(0.0, abs(v - t.value) - t.threshold) / t.scale) ** 2
                for (t, v), x in zip(pairs, violation, strict=True)
            ]
        ),
        curves=np.array(
            [
                objective_term(t.objective, rms, 0.0)
                - LIMIT_WEIGHT * (max(0.0, rms - t.threshold) / t.objective.norm) ** 2
                for t, rms in lines
            ]
        ),
        violation=violation,
        beyond=beyond,
        excess=excess,
        misfit=-targets.misfit.weight * score.misfit if targets.misfit is not None else 0.0,
    )


def objective_term(objective: Objective, value: float, target: float) -> float:
    """LinWt S Obj / Norm + QuadWt S Obj^2 / Norm^2."""
    size = (abs(value - target) if objective.goal == "target" else value) / objective.norm
    return float(objective.sign * (objective.linear * size + objective.quadratic * size**2))


def violated(constraint: Constraint, value: float) -> float:
    """ConViol: how far the value lies outside the interval, 0 inside."""
    return float(np.maximum(np.maximum(constraint.low - value, value - constraint.high), 0.0))


def constraint_term(constraint: Constraint, violation: float) -> float:
    """-(LinWt ConViol / Norm + QuadWt ConViol^2 / Norm^2)."""
    size = violation / constraint.norm
    return float(-(constraint.linear * size + constraint.quadratic * size**2))
