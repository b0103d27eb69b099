"""`gauss_newton`: fits the measured curves by exact sensitivities, weighted by their errors.

Minimizes |r(u)|^2 + |(u - u0) / P|^2 between the bounds, r the residuals in standard deviations of the
data and P the prior standard deviations: the most probable axle (Gauss-Newton in a trust region; J. Nocedal,
S. J. Wright, Numerical Optimization, 2006, chapter 10) that meets the constraints, each of which adds a steep
term outside its interval. Levels are ignored: its steps are continuous.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar, final

import numpy as np
from scipy.linalg import solve_triangular
from scipy.optimize import lsq_linear

from doe_kc.correlation.least_squares import ConstraintPenalty, bounded_step, normal_equations
from doe_kc.correlation.linearization import Linearization
from doe_kc.correlation.methods._base import Method, MethodSettings, best_design, register
from doe_kc.correlation.modelled.trust_region import RadiusRule, TrustRegion
from doe_kc.correlation.problem import Candidate, Evaluated, Problem, RatingForecast
from doe_kc.ground.typing import FloatArray
from doe_kc.solver.result import NotConverged

LEAST_DECREASE = 0.01
"""Predicted decrease of the sum of squares below which the fit stands: a tenth of a standard deviation."""
FIT_RADIUS = RadiusRule(
    first=1.0, smallest=1e-4, largest=1.0, shrinkage=0.25, growth=2.0, poor=0.25, good=0.75, floor="end"
)
INNER_STEPS = 50
"""Newton steps within one step's linearized problem."""
STEP_SHARES = tuple(0.5**k for k in range(12))
"""Of a Newton step, tried in turn."""


@final
@register
class GaussNewton(Method):
    """State: the incumbent with its residual and normal equations, and the trust region's radius.

    Constraints are walls of one-sided squares; a step knows by linearization which of them it leans on.
    """

    id: ClassVar[str] = "gauss_newton"
    label: ClassVar[str] = "Gauss-Newton with exact sensitivities"
    needs_exact: ClassVar[bool] = True

    def __init__(self, problem: Problem, settings: MethodSettings) -> None:
        del settings
        self._problem, self._data = problem, problem.likelihood
        self._walls = ConstraintPenalty.of(problem.search)
        self._origin = problem.space.start
        self._weight = problem.space.prior_sd**-2.0
        self._region = TrustRegion.first(FIT_RADIUS)
        self._stopped = ""
        self._incumbent: Evaluated | None = None
        self._cost = np.inf
        self._predicted = 0.0

    @property
    def stopped(self) -> str:
        """Converged, or the region has shrunk to nothing."""
        return self._stopped

    def ask(self) -> Sequence[Candidate]:
        """The minimizer of the linearized problem within bounds and region."""
        if self._incumbent is None:
            raise ValueError("ask() before the baseline was told")
        point = self._incumbent.point
        lower = np.maximum(-point, -self._region.radius)
        upper = np.minimum(1.0 - point, self._region.radius)
        step = self._step(self._incumbent, lower, upper)
        return [Candidate(point + step, self.id, self._prediction(self._incumbent, step))]

    def tell(self, evaluated: Sequence[Evaluated]) -> None:
        """Accept or shrink; stop when the expected gain is nothing."""
        if self._incumbent is None:
            self._accept(min((e for e in evaluated if e.index >= 0), key=self._cost_of))
            return
        answer = evaluated[-1]
        cost = self._cost_of(answer)
        ratio = (self._cost - cost) / max(self._predicted, 1e-300)
        length = float(np.abs(answer.point - self._incumbent.point).max())
        self._region = self._region.after(ratio, length=length)
        if cost < self._cost:
            self._accept(answer)
        if self._predicted < LEAST_DECREASE:
            self._stopped = "converged: the data ask for no further change"
        elif self._region.exhausted:
            self._stopped = "the trust region shrank to nothing without a better design"

    def best(self, history: Sequence[Evaluated]) -> int:
        """The most probable axle, which need not have the best rating; the best one that harms nothing where
        that one harms a curve, which has no wall."""
        if self._incumbent is not None and self._incumbent.harmless:
            return self._incumbent.index
        return best_design(history)

    def _step(self, incumbent: Evaluated, lower: FloatArray, upper: FloatArray) -> FloatArray:
        """The step of the linearized problem; sets what it promises.

        Piecewise quadratic and convex: Newton steps for the walls leant on, shortened while they do not gain.
        """
        values = incumbent.outcome.characteristics[self._walls.rows]
        slopes = self._expansion.characteristics[self._walls.rows]

        def cost(step: FloatArray) -> float:
            beyond = self._walls.excess(values + slopes @ step)
            return float(2.0 * self._gradient @ step + step @ self._hessian @ step + beyond @ beyond)

        step = np.zeros_like(self._gradient)
        before = value = cost(step)
        for _ in range(INNER_STEPS):
            sides = self._walls.sides(values + slopes @ step)
            on = sides != 0
            leaning = slopes[on] / self._walls.sd[on, None]
            following = self._leant(leaning, self._walls.distance(values, sides)[on], lower, upper)
            trials = (step + share * (following - step) for share in STEP_SHARES)
            better = next(
                ((t, c) for t in trials if (c := cost(t)) < value - LEAST_DECREASE / INNER_STEPS), None
            )
            if better is None:
                break
            step, value = better
        self._predicted = before - value
        return step

    def _leant(
        self, leaning: FloatArray, distance: FloatArray, lower: FloatArray, upper: FloatArray
    ) -> FloatArray:
        """The best step with squares of distance + leaning @ step; by rows, as the walls are far stiffer."""
        if not distance.size:
            return bounded_step(self._hessian, self._gradient, lower, upper)
        root = np.linalg.cholesky(self._hessian)
        rows = np.vstack([root.T, leaning])
        values = np.concatenate([-solve_triangular(root, self._gradient, lower=True), -distance])
        return np.asarray(lsq_linear(rows, values, (lower, upper), method="bvls").x)

    def _accept(self, answer: Evaluated) -> None:
        try:
            expansion = self._problem.linearize(answer.point)
        except NotConverged as error:
            self._stopped = f"no sensitivities at the last design: {error}"
            return
        jacobian = self._data.jacobian(expansion.curves, expansion.characteristics)
        residual = self._data.residual(answer.outcome.curves, answer.outcome.characteristics)
        self._incumbent, self._cost, self._expansion = answer, self._cost_of(answer), expansion
        self._hessian, self._gradient = normal_equations(
            jacobian, residual, self._weight, answer.point - self._origin
        )

    _expansion: Linearization
    _hessian: FloatArray
    _gradient: FloatArray

    def _cost_of(self, answer: Evaluated) -> float:
        if answer.outcome.failed:
            return np.inf
        residual = self._data.residual(answer.outcome.curves, answer.outcome.characteristics)
        moved = answer.point - self._origin
        beyond = self._walls.excess(answer.outcome.characteristics[self._walls.rows])
        return float(residual @ residual + self._weight @ moved**2 + beyond @ beyond)

    def _prediction(self, incumbent: Evaluated, step: FloatArray) -> RatingForecast:
        rows = self._problem.targets.rows
        values = incumbent.outcome.characteristics[rows] + self._expansion.characteristics[rows] @ step
        return RatingForecast(values, np.full(len(rows), np.nan), np.nan, np.nan)
