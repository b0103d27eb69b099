"""What a correlation found."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from doe_kc.axle.model import Axle
from doe_kc.axle.parameters import with_values
from doe_kc.correlation.loop import Run
from doe_kc.correlation.posterior import ParameterPosterior
from doe_kc.correlation.problem import Evaluated, Problem
from doe_kc.correlation.reach import Relaxation
from doe_kc.correlation.search_targets import all_measured
from doe_kc.correlation.twin_agreement import TwinAgreement
from doe_kc.targets import (
    CurveTarget,
    Improvement,
    exact_model_improvement,
    improvements,
    mean_improvement,
    score,
)


@dataclass(frozen=True, repr=False)
class Correlation:
    """A finished run of one method.

    method: its id. steps: what was set before it (ride height, alignment), in sentences. posterior: of the
    variables at the best design from the exact sensitivities; None when the solver gives none or there are
    no records. seconds: of the whole run. relaxation: targets that the bounds do not reach, None where that
    was not known beforehand. given: the axle as it was handed in, where the run started from another. twin:
    where an outside model and its twin disagree; None without a twin. Then the posterior is by its slopes.
    """

    method: str
    problem: Problem
    run: Run
    steps: tuple[str, ...]
    posterior: ParameterPosterior | None
    seconds: float
    notes: tuple[str, ...] = ()
    relaxation: Relaxation | None = None
    given: Evaluated | None = None
    twin: TwinAgreement | None = None

    @property
    def baseline(self) -> Evaluated:
        """The axle that was handed in: the design that the run started from, unless effects were added."""
        return self.given or self.run.evaluated[0]

    @property
    def best(self) -> Evaluated:
        """The design to hand over."""
        return self.run.evaluated[self.run.best]

    @property
    def rating(self) -> float:
        """Equation 2.2 of the best design."""
        return self.best.rating.total if self.best.rating is not None else -math.inf

    @property
    def baseline_rating(self) -> float:
        """Equation 2.2 of the baseline."""
        return self.baseline.rating.total if self.baseline.rating is not None else -math.inf

    @property
    def feasible(self) -> bool:
        """Whether the best design meets every constraint of the rating."""
        return self.best.rating is not None and self.best.rating.feasible

    @property
    def improvements(self) -> list[Improvement]:
        """Every characteristic with a target, before and after."""
        before, after = self.baseline.score, self.best.score
        if before is None or after is None:
            raise ValueError("a correlation without a solved baseline has no improvement")
        return improvements(self.problem.targets, before, after, sought=self.problem.search)

    @property
    def misfit(self) -> float | None:
        """Whitened RMS of the mean curves' deviations at the best design, 1 is noise; None without curves."""
        data, best = self.problem.likelihood, self.best.outcome
        if not data.curves or best.curves is None:
            return None
        residual = data.residual(best.curves, best.characteristics)
        return float(np.sqrt(np.mean(residual**2)))

    @property
    def curve_deviations(self) -> list[tuple[CurveTarget, float, float]]:
        """Every measured curve with the RMS deviation of the baseline and of the best design; none without
        curves from the solver."""
        wide = all_measured(self.problem.targets)
        ours = [e.outcome for e in (self.baseline, self.best)]
        if any(o.curves is None for o in ours):
            return []
        before, after = (score(wide, o.characteristics, o.curves).rms for o in ours)
        return [(c, float(b), float(a)) for c, b, a in zip(wide.curves, before, after, strict=True)]

    @property
    def mean_improvement(self) -> float:
        """Percent, over the characteristics that count; nan when none does."""
        return mean_improvement(self.improvements)

    @property
    def exact_model_improvement(self) -> float:
        """Percent that an exact model of the car would show, see there; nan when none counts."""
        return exact_model_improvement(self.improvements)

    @property
    def values(self) -> dict[str, float]:
        """Path -> absolute value of every variable, tied and fixed parameter of the best design."""
        return self.problem.space.values(self.best.point)

    @property
    def axle(self) -> Axle:
        """The correlated axle."""
        return with_values(self.problem.axle, self.values)
