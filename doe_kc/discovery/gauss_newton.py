"""Gauss-Newton steps in a trust region between bounds: to the most probable point of a model.

Derivatives of a model nearby serve the first steps, and a step that goes as promised brings a secant update
in place of new ones.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from doe_kc.correlation.least_squares import bounded_step
from doe_kc.correlation.likelihood import Likelihood
from doe_kc.discovery.derivatives import amplitude_columns, own_columns
from doe_kc.discovery.fit import Fit, cost_of, rewhitened_fit
from doe_kc.discovery.model import EffectModel
from doe_kc.discovery.thresholds import (
    BEYOND_DOUBT,
    CHORD_STEPS,
    FIT_DECREASE,
    FIT_GOOD_RATIO,
    FIT_POOR_RATIO,
    FIT_STEPS,
    FRESH_DECREASE,
    HOPELESS_SHARE,
    LARGEST_RADIUS,
    LAST_STEP_DECREASE,
    LEAST_STEP,
    REUSE_DECREASE,
)
from doe_kc.ground.typing import FloatArray
from doe_kc.solver.result import NotConverged


@dataclass(frozen=True)
class FitStart:
    """Where a fit begins."""

    model: EffectModel
    """What is fitted."""
    z: FloatArray
    """(d + m,) the point."""
    near: Fit
    """Whose derivatives serve the first steps."""
    ceiling: float = np.inf
    """Cost above which the fit is of no use, see `fit`."""


def fit(
    model: EffectModel,
    start: FloatArray,
    *,
    steps: int = FIT_STEPS,
    known: FloatArray | None = None,
    aged: float = np.inf,
    ceiling: float = np.inf,
) -> Fit:
    """The most probable point reached from `start` (d + m,). NotConverged when the start has no solution.

    known: (M, p + m) derivatives that are known, see `known_columns`. aged: decrease of the sum of squares
    since they were taken; by default they are those of a model nearby, good enough for the first step.
    ceiling: cost above which the fit is of no use; one whose steps promise no less is given up, where that is
    close not before it has derivatives of its own.
    """
    z = np.clip(start, model.lower, model.upper)
    current = _expanded(model, z, model.residual(z), 1, known)
    radius, aged = 1.0, 0.0 if known is None else aged
    by_records = False
    for taken in range(steps):
        gradient, hessian = current.gradient, current.hessian
        reach = radius * (_seen(current) if by_records else np.ones(z.size))
        low, high = np.maximum(model.lower - current.z, -reach), np.minimum(model.upper - current.z, reach)
        step = bounded_step(hessian, gradient, low, high)
        predicted = float(-(2.0 * gradient @ step + step @ hessian @ step))
        if predicted < LAST_STEP_DECREASE and aged > FRESH_DECREASE:
            if (anew := _renewed(current)) is None:
                return current
            current, aged = anew, 0.0
            continue
        if predicted < FIT_DECREASE:
            return replace(current, converged=True)
        if taken and _hopeless(current, ceiling):
            if aged <= FRESH_DECREASE or _hopeless(current, ceiling + 2.0 * BEYOND_DOUBT):
                return current
            if (anew := _renewed(current)) is None:
                return current
            current, aged = anew, 0.0
            continue
        trial, residual = current.z + step, None
        try:
            residual = model.residual(trial)
            cost = cost_of(model, trial, residual)
        except NotConverged:
            cost = np.inf
        current = replace(current, evaluations=current.evaluations + 1)
        ratio = (current.cost - cost) / predicted
        poor = ratio < FIT_POOR_RATIO
        unseen = poor and not (by_records or _seen(current).all())
        if poor and not unseen and max(predicted, aged) < FRESH_DECREASE:  # a law with corners: rough
            if residual is not None and cost < current.cost:
                current = replace(current, z=trial, residual=residual, cost=cost)
            return replace(current, converged=True)
        if unseen:
            by_records = True
        elif poor:
            radius = min(radius, float(np.abs(step).max())) / 4.0
        elif ratio > FIT_GOOD_RATIO:
            radius = min(LARGEST_RADIUS, 2.0 * radius)
        if residual is not None and cost < current.cost:
            if predicted < LAST_STEP_DECREASE:
                return replace(current, z=trial, residual=residual, cost=cost, converged=True)
            gained = current.cost - cost
            if gained < REUSE_DECREASE and abs(ratio - 1.0) < 1.0 - FIT_GOOD_RATIO:
                missed = residual - current.residual - current.jacobian.moved(step)
                jacobian = current.jacobian.secant(missed, step)
                current = replace(current, z=trial, residual=residual, jacobian=jacobian, cost=cost)
                aged += gained
                continue
            if (there := _renewed(replace(current, z=trial, residual=residual))) is not None:
                current, aged = there, 0.0
            else:  # at the edge of what the axle can do: less far
                radius = min(radius, float(np.abs(step).max())) / 4.0
        elif aged > FRESH_DECREASE:
            if (anew := _renewed(current)) is None:
                return current
            current, aged = anew, 0.0
        if radius < LEAST_STEP:
            return current
    return current


def _seen(fit: Fit) -> NDArray[np.bool_]:
    """(d + m,) whether the records say more of it than was known before, or ask it to move; of linear
    nuisances always.

    Nothing but the prior moves all others, as a stop's clearance before the stop touches. Where it does
    touch, the cost leaps: steps with it failed at any length, and a fit ended 440 of cost above one without
    it.
    """
    model = fit.model
    before = model.prior_sd**-2.0
    shown = np.diag(fit.hessian) - before
    asked = fit.gradient - before * (fit.z - model.centre)
    out = (shown > before) | (asked**2 > FIT_DECREASE * (shown + before))
    out[model.linear] = True
    return np.asarray(out)


def _hopeless(fit: Fit, ceiling: float) -> bool:
    """Whether even half as much again as the whole Gauss-Newton step promises stays above a cost."""
    if np.isinf(ceiling):
        return False
    model = fit.model
    step = bounded_step(fit.hessian, fit.gradient, model.lower - fit.z, model.upper - fit.z)
    promised = float(-(2.0 * fit.gradient @ step + step @ fit.hessian @ step))
    return fit.cost - (1.0 + HOPELESS_SHARE) * promised > ceiling


def refit_to_errors(fit: Fit, likelihood: Likelihood) -> Fit:
    """The fit to the same records with other errors, by the chord method from where it is."""
    if fit.model.likelihood is likelihood:
        return fit
    rewhitened = rewhitened_fit(fit, likelihood)
    return chord_fit(rewhitened, rewhitened.model)


def known_columns(fit: Fit, model: EffectModel) -> FloatArray:
    """(M, p + m) derivatives at a fit as far as they serve another model of the same records.

    Those to parameters and calibrations, p together, then those to the sizes of its members; nan where the
    fit's model has not got the member.
    """
    own, end, first = fit.jacobian.own, fit.model.calibrations.stop, fit.model.linear
    places = {h.name: p for h, p in fit.model.places()}
    columns = [own[:, :end]]
    for member in model.members:
        place = places.get(member.name, slice(first.stop, first.stop))
        known = own[:, end + place.start - first.stop : end + place.stop - first.stop]
        none = np.full((fit.residual.size, len(member.sizes)), np.nan)
        columns.append(known if known.shape[1] == len(member.sizes) else none)
    return np.hstack(columns)


def _renewed(fit: Fit) -> Fit | None:
    """With derivatives at its point, all anew; None where one of them asks for an axle without an
    equilibrium."""
    try:
        return _expanded(fit.model, fit.z, fit.residual, fit.evaluations)
    except NotConverged:
        return None


def _expanded(
    model: EffectModel,
    z: FloatArray,
    residual: FloatArray,
    evaluations: int,
    known: FloatArray | None = None,
) -> Fit:
    """With derivatives at z, those that are `known` taken from there."""
    own = own_columns(model, z, residual) if known is None else known.copy()
    missing = np.flatnonzero(np.isnan(own[0]))
    places = missing - model.calibrations.stop + model.dimension
    own[:, missing] = amplitude_columns(model, z, residual, places.tolist())
    cost = cost_of(model, z, residual)
    return Fit(model, z, residual, model.jacobian(own), cost, evaluations + missing.size, False)


def chord_fit(fit: Fit, model: EffectModel) -> Fit:
    """The fit of the same model to other data, by the chord method: steps along the derivatives of `fit`.

    For small changes, such as a load case left out: no new derivatives are taken. Not `converged` where those
    of `fit` did not lead to an end.
    """
    cost = cost_of(model, fit.z, fit.residual)
    current = replace(fit, model=model, cost=cost, converged=False)
    hessian = current.hessian
    for _ in range(CHORD_STEPS):
        low, high = model.lower - current.z, model.upper - current.z
        gradient = current.gradient
        step = bounded_step(hessian, gradient, low, high)
        if -(2.0 * gradient @ step + step @ hessian @ step) < FIT_DECREASE:
            return replace(current, converged=True)
        try:
            residual = model.residual(current.z + step)
        except NotConverged:
            break
        cost = cost_of(model, current.z + step, residual)
        if cost >= current.cost:
            break
        current = replace(current, z=current.z + step, residual=residual, cost=cost)
    return current
