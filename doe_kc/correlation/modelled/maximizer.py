"""Gauss-Newton proposals: the best rating that the surrogates let expect inside a box."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from doe_kc.correlation.least_squares import bounded_step, with_prior
from doe_kc.correlation.modelled.composite import Composite
from doe_kc.correlation.modelled.trust_region import TrustBox
from doe_kc.correlation.prior import Prior
from doe_kc.ground.typing import FloatArray
from doe_kc.surrogates.interface import Fitted

PROPOSAL_STEPS = 30
STEP_GAIN = 1e-4
"""Relative gain of a step below which the search has settled."""
ROUGH = 10
"""Iterations of each step's bounds: the next step goes on where they end."""


def gauss_newton(
    model: Fitted, composite: Composite, box: TrustBox, first: FloatArray, prior: Prior, *, doubt: float = 1.0
) -> FloatArray:
    """(d,) maximizer of the expected rating by majorized Gauss-Newton steps from `first`.

    doubt: factor of the predicted variances; 0 = the predictions are taken for true.
    """
    point = box.clip(first)

    def merit(x: FloatArray) -> float:
        variance = doubt * model.variance(x[None])[0] if doubt else np.zeros(model.outputs)
        expected = composite.expected(model.predict(x[None]), variance)
        return float(expected[0] - prior.cost(x))

    value = merit(point)
    for _ in range(PROPOSAL_STEPS):
        known = model.predict_all(point[None])
        near = composite.majorizer(known.mean[0], doubt * known.variance[0])
        jacobian = known.gradient[0]
        gradient = jacobian.T @ near.gradient + doubt * known.variance_gradient[0].T @ near.variance
        hessian, gradient = with_prior(
            jacobian.T @ near.hessian @ jacobian, gradient, prior.weight, point - prior.centre
        )
        step = bounded_step(hessian, gradient, box.lower - point, box.upper - point, iterations=ROUGH)
        point, gained = _line_search(merit, point, step, value)
        if gained <= STEP_GAIN * max(1.0, abs(value)):
            break
        value += gained
    return point


def _line_search(
    merit: Callable[[FloatArray], float], point: FloatArray, step: FloatArray, value: float
) -> tuple[FloatArray, float]:
    """The first share of the step that gains, and its gain; no step and 0 when none does."""
    for share in (1.0, 0.5, 0.25, 0.1, 0.02):
        trial_value = merit(point + share * step)
        if trial_value > value:
            return point + share * step, trial_value - value
    return point, 0.0
