"""Joint fit of parameters and effects: the most probable axle, its covariance, and the evidence for it.

Of the cost |r(z)|^2 + |(z - z0) / P|^2 between bounds. Evidence by Laplace's approximation,
ln Z = -1/2 min - 1/2 ln det(1 + P J'J P) + ln(share of each posterior inside its half-line over that of its
prior), relative to constants that all models of the same data share. What a bound holds back is integrated
along its half-line, from the bound on.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import cho_factor, cho_solve
from scipy.special import log_ndtr

from doe_kc.correlation.likelihood import Likelihood, Rewhitening
from doe_kc.discovery.half_lines import log_kept
from doe_kc.discovery.jacobian import Jacobian
from doe_kc.discovery.model import EffectModel
from doe_kc.discovery.nuisances import INPUT_EFFECT, input_gain_amplitude
from doe_kc.discovery.projection import Changes, Projection, changes
from doe_kc.discovery.screening.disagreement import Map, residual_map
from doe_kc.discovery.thresholds import TRACE_SD
from doe_kc.effects.hypothesis import Hypothesis
from doe_kc.ground.fields_only import FieldsOnly
from doe_kc.ground.typing import FloatArray


@dataclass(frozen=True)
class Fit(FieldsOnly):
    """A model at its most probable point."""

    model: EffectModel
    """The model, its members and the errors of the records."""
    z: FloatArray
    """(d + m,) the point: parameters, nuisances, amplitudes."""
    residual: FloatArray
    """(M,) model minus records, in standard deviations of the records."""
    jacobian: Jacobian
    """(M, d + m) derivative of the residual to z; of a point nearby where a fit ended on that."""
    cost: float
    """Sum of squares of the data that the fit looks at, with the prior's."""
    evaluations: int
    """Suites of load cases that were solved for it."""
    converged: bool
    """Whether the predicted decrease fell below its limit before the steps ran out."""
    slope: FloatArray | None = None
    """(d + m,) half the slope of the cost, where the derivatives are not kept."""

    @cached_property
    def hessian(self) -> FloatArray:
        """(d + m, d + m) J'J + P^-2 over the data that the fit looks at."""
        out = self.jacobian.gram + np.diag(self.model.prior_sd**-2.0)
        if self.model.left_out is None:
            return out
        unseen = self.jacobian.rows(~self.model.used)
        return np.asarray(out - unseen.T @ unseen)

    @cached_property
    def gradient(self) -> FloatArray:
        """(d + m,) half the slope of the cost."""
        if self.slope is not None:
            return self.slope
        model = self.model
        pulled = model.prior_sd**-2.0 * (self.z - model.centre)
        return self.jacobian.pulled(np.where(model.used, self.residual, 0.0)) + pulled

    @cached_property
    def covariance(self) -> FloatArray:
        """(d + m, d + m) of the Gaussian approximation."""
        return np.asarray(cho_solve(cho_factor(self.hessian), np.eye(self.z.size)))

    @property
    def without_derivatives(self) -> Fit:
        """The fit as far as its point, covariance and evidence go: a fiftieth of the memory.

        Of all records: one with a load case left out takes the derivatives for its covariance. Its model
        has no columns of linear nuisances: nothing is solved with it.
        """
        jacobian, known = self.jacobian.normal_only, self.model.nuisances
        model = self.model if known is None else replace(self.model, nuisances=jacobian.nuisances)
        return replace(self, model=model, jacobian=jacobian, slope=self.gradient)

    @cached_property
    def projection(self) -> Projection:
        """Complement of what tuning, traces and the sizes of the effects can explain."""
        return self._projection(np.arange(self.z.size))

    @cached_property
    def without_traces(self) -> Projection:
        """Complement of what tuning and the sizes of the effects can explain, traces held."""
        return self._projection(np.delete(np.arange(self.z.size), self.model.traces))

    def changes(self, rows: FloatArray) -> Changes:
        """Changes (M,) or (M, k) of the residual, for the projections of this fit."""
        return changes(self.jacobian, rows)

    @cached_property
    def remainder(self) -> Changes:
        """The residual, for the projections of this fit."""
        return changes(self.jacobian, self.residual, is_residual=True)

    @cached_property
    def misfit_left(self) -> float:
        """Square of what the projection leaves of the residual: the cost after re-tuning to first order."""
        return float(self.projection.squares(self.remainder)[0])

    @cached_property
    def residual_map(self) -> Map:
        """Where model and records disagree beyond what re-tuning could absorb."""
        return residual_map(self.model.contrasts, self.remainder, self.projection)

    @cached_property
    def sizes_held(self) -> Projection:
        """Complement of what tuning and traces can explain, the sizes of the effects held."""
        return self._projection(np.arange(self.model.dimension))

    @cached_property
    def tuning_projection(self) -> Projection:
        """Complement of what tuning can explain, traces and the sizes of the effects held."""
        return self._projection(np.arange(self.model.traces.start))

    def _projection(self, free: NDArray[np.int_]) -> Projection:
        """free: places in z that may move."""
        prior = self.model.prior_sd[free]
        offset = (self.z[free] - self.model.centre[free]) / prior
        gram = self.jacobian.gram[np.ix_(free, free)] + np.diag(prior**-2.0)
        return Projection(self.jacobian, prior, offset, free, gram)

    @property
    def misfit(self) -> float:
        """Sum of squared residuals."""
        return float(self.residual @ self.residual)

    @property
    def rms(self) -> float:
        """Whitened RMS of the residuals; 1 is noise."""
        return float(np.sqrt(np.mean(self.residual**2)))

    @property
    def amplitudes(self) -> FloatArray:
        """(m,) sizes of the effects, in typical sizes."""
        return self.z[self.model.dimension :]

    @cached_property
    def evidence(self) -> float:
        """ln Z, see the module."""
        total = -0.5 * self.cost - 0.5 * float(np.linalg.slogdet(self.hessian)[1])
        total -= float(np.sum(np.log(self.model.prior_sd)))
        total += log_kept(self.covariance, self.gradient, self.held)
        sd, held = np.sqrt(np.diag(self.covariance)), self.held
        for i, size in enumerate(self.model.sizes, start=self.model.dimension):
            if not size.any_sign:
                total += float(np.log(2.0)) + (0.0 if held[i] else float(log_ndtr(self.z[i] / sd[i])))
        return total

    @cached_property
    def held(self) -> NDArray[np.bool_]:
        """(d + m,) whether a bound holds it back: it is there, and the cost falls beyond."""
        low, high = self.z <= self.model.lower, self.z >= self.model.upper
        return np.asarray((low & (self.gradient > 0.0)) | (high & (self.gradient < 0.0)))


def cost_of(model: EffectModel, z: FloatArray, residual: FloatArray) -> float:
    """Sum of squares of the data that fits look at, with the prior's."""
    seen = residual[model.used]
    return float(seen @ seen + np.sum(((z - model.centre) / model.prior_sd) ** 2))


def rewhitened_fit(fit: Fit, likelihood: Likelihood) -> Fit:
    """The fit's point against the same records with other errors; nothing is solved."""
    units = Rewhitening(fit.model.likelihood, likelihood)
    model = fit.model.with_likelihood(likelihood, units)
    residual = units(fit.residual)
    jacobian = model.jacobian(units(fit.jacobian.own))
    return replace(
        fit, model=model, residual=residual, jacobian=jacobian, cost=cost_of(model, fit.z, residual)
    )


def amplitude_estimates(fit: Fit, hypothesis: Hypothesis) -> tuple[FloatArray, FloatArray]:
    """(s,) amplitudes of a member, see `size_weights`, and (s,) their standard deviations."""
    weights = size_weights(fit.model, hypothesis)
    covariance = weights @ fit.covariance @ weights.T
    return np.asarray(weights @ fit.z), np.asarray(np.sqrt(np.diag(covariance)))


def member_detectability(fit: Fit, member: Hypothesis) -> float:
    """Standard deviations of the records that a member makes at its size, all else re-tuned."""
    place = fit.model.place(member)
    covariance = fit.covariance[place, place]
    information = np.linalg.inv(covariance) - np.eye(covariance.shape[0])
    sizes = fit.z[place]
    return float(np.sqrt(max(0.0, float(sizes @ information @ sizes))))


def size_weights(model: EffectModel, hypothesis: Hypothesis) -> FloatArray:
    """(s, d + m) what of the unknowns makes each amplitude of a member, in typical sizes.

    The records show only the sum of a wrong input and of its load case's calibration: that is what counts. So
    do they of an effect on both sides and of its traces on either, whose mean counts: a free play of 0.1268
    mm was told as 0.1274 +- 0.0043 mm, where the mean of both sides is 0.1265 +- 0.0007. And of an effect on
    one side and of its trace on both: what the side has counts, whichever it is of.
    """
    place = model.place(hypothesis)
    weights = np.eye(model.dimension + len(model.sizes))[place]
    if hypothesis.effect == INPUT_EFFECT and hypothesis.location in model.cases:
        (size,) = hypothesis.sizes
        calibration = model.calibrations.start + model.cases.index(hypothesis.location)
        weights[0, calibration] = input_gain_amplitude(size)
    if model.nuisances is None or hypothesis.location is None:
        return weights
    names = [size.name for size in hypothesis.sizes]
    for at, trace in enumerate(model.nuisances.traces, start=model.traces.start):
        own, name = trace.hypothesis, trace.size.name
        if own.effect == hypothesis.effect and own.location is not None and name in names:
            share = _share_of_trace(hypothesis.location, own.location)
            weights[names.index(name), at] = share * TRACE_SD
    return weights


def _share_of_trace(member: str, trace: str) -> float:
    """Of a trace in one place, what a member in another has of it: half where that is on both sides of this,
    all where this is on both sides of that."""
    if trace in (f"{member}_L", f"{member}_R"):
        return 0.5
    return 1.0 if member in (f"{trace}_L", f"{trace}_R") else 0.0


def last_member(fit: Fit, hypothesis: Hypothesis) -> Fit:
    """The same fit with one member's sizes behind those of all others."""
    model = fit.model
    place = model.place(hypothesis)
    own = np.r_[place]
    order = np.concatenate([np.delete(np.arange(fit.z.size), own), own])
    moved = model.without(hypothesis).extended(hypothesis)
    return replace(fit, model=moved, z=fit.z[order], jacobian=fit.jacobian.ordered(order))
