"""All that tables and figures of a surrogate study are made of."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from doe_kc.ground.typing import FloatArray
from doe_kc.surrogate_models.designs import Designs
from doe_kc.surrogate_models.influence import Agreement
from doe_kc.surrogate_models.learning_curve import LearningCurve
from doe_kc.surrogate_models.options import GOAL
from doe_kc.surrogate_models.study import SurrogateStudy
from doe_kc.variables import Space


@dataclass(frozen=True)
class SurrogateReport:
    """d variables, m characteristics.

    changes: (d, m) for a positive step of each parameter, by the chosen models, in the characteristics'
    units; reference: the same one at a time by the true solver, nan where unknown. shares: (d, m) total
    effects over the box. targets: characteristic -> measured value. goal: Q2 that the learning curve is
    followed to; curve: None where half the designs are too few.
    """

    space: Space
    designs: Designs
    fitted: SurrogateStudy
    changes: FloatArray
    shares: FloatArray
    reference: FloatArray
    agreement: Agreement
    targets: Mapping[str, float]
    goal: float = GOAL
    curve: LearningCurve | None = None
