"""The model discrepancy of an effect's law, a further error of the records.

An effect that is in the model follows a law of its own in the car: a compliance stiffens, a friction breaks
away more softly. Without this, the difference would be taken for another effect (M. C. Kennedy, A. O'Hagan,
Journal of the Royal Statistical Society B 63, 2001).
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.linalg import cho_factor, cho_solve

from doe_kc.correlation.curve_data import Branches, CurveData, CurveGroup
from doe_kc.correlation.likelihood import Likelihood
from doe_kc.curves import TYRE_LOAD
from doe_kc.discovery.fit import Fit, rewhitened_fit
from doe_kc.discovery.gauss_newton import chord_fit
from doe_kc.discovery.model import EffectModel
from doe_kc.discovery.thresholds import DISCREPANCY_LENGTH, DISCREPANCY_SHARES
from doe_kc.discovery.workers import DiscoveryWorkers
from doe_kc.effects import EFFECTS
from doe_kc.effects.hypothesis import Hypothesis
from doe_kc.ground.in_turn import in_turn
from doe_kc.ground.typing import FloatArray
from doe_kc.measurement.noise import smooth_correlation


@dataclass(frozen=True)
class EffectSignal:
    """What one member makes of the curves."""

    changes: tuple[FloatArray, ...]
    """Change (n,) of every curve, in the curve's unit."""
    largest: Mapping[tuple[str, Branches], float]
    """Response and branches -> the largest |change| of their curves."""
    friction: bool
    """Whether it is a friction, whose smaller loops hang on the shape of its law, so that each curve's scale
    is open too. An elastic law's scale is the same in every curve, which is what tells effects apart."""
    square: float
    """Sum of squares of all changes, in the records' errors."""


def fit_discrepancy(exact: Fit, signals: Sequence[EffectSignal]) -> tuple[Fit, dict[str, float]]:
    """The fit with the discrepancy of its effects' laws that the records ask for, and each member's share.

    exact: to the records' own errors; signals: `effect_signals` of it. The share of each effect is raised
    along DISCREPANCY_SHARES as long as the evidence grows, one effect after the other, largest first: the
    errors of the records grow by what its law may do to the curves, and with them their determinant, so that
    a law that fits is left as it is.
    """
    shares, own = [0.0] * len(signals), exact.model.likelihood
    best, most = exact, marginal(exact)

    def wider(candidate: Sequence[float]) -> tuple[Fit, float]:
        fit = rewhitened_fit(exact, with_discrepancy(own, signals, candidate))
        return fit, marginal(fit)

    for i in sorted(range(len(signals)), key=lambda i: -signals[i].square):
        candidates = [[*shares[:i], share, *shares[i + 1 :]] for share in DISCREPANCY_SHARES[1:]]
        for candidate, (fit, evidence) in zip(
            candidates, in_turn(wider, candidates, exact.model.solutions.pool), strict=False
        ):
            if evidence <= most:
                break
            best, most, shares = fit, evidence, candidate
    names = [h.name for h in exact.model.members]
    settled = exact if best is exact else chord_fit(best, best.model)
    return settled, dict(zip(names, shares, strict=True))


@dataclass(frozen=True, eq=False)
class ErrorsWithoutOwn(Mapping[str, Likelihood]):
    """Name of each member with a discrepancy -> the records' errors with the discrepancies of all others.

    Made each time that they are asked for: most never are, and each is 4 MB.
    """

    likelihood: Likelihood
    """The records' own errors."""
    signals: Mapping[str, EffectSignal]
    """By member's name what it makes."""
    shares: Mapping[str, float]
    """By member's name the share of its discrepancy."""

    def __getitem__(self, name: str) -> Likelihood:
        if not self.shares[name]:
            raise KeyError(name)
        others = [share * (n != name) for n, share in self.shares.items()]
        return with_discrepancy(self.likelihood, [self.signals[n] for n in self.shares], others)

    def __iter__(self) -> Iterator[str]:
        return (name for name, share in self.shares.items() if share)

    def __len__(self) -> int:
        return sum(1 for _ in self)


def without_own_discrepancy(
    exact: Fit, signals: Sequence[EffectSignal], shares: Mapping[str, float]
) -> ErrorsWithoutOwn:
    """exact, signals: as of `fit_discrepancy`; shares: what that gives."""
    names = [h.name for h in exact.model.members]
    return ErrorsWithoutOwn(exact.model.likelihood, dict(zip(names, signals, strict=True)), shares)


def marginal(fit: Fit) -> float:
    """ln density of the records under a model of effects, those of different errors comparable.

    At the minimum of the quadratic through the fit's point, along what no bound holds back.
    """
    free = np.flatnonzero(~fit.held)
    gradient, hessian = fit.gradient[free], fit.hessian[np.ix_(free, free)]
    lower = 0.5 * float(gradient @ cho_solve(cho_factor(hessian), gradient))
    roots = sum(float(np.sum(np.log(np.diag(c.root)))) for c in fit.model.likelihood.curves)
    return fit.evidence + lower - roots


def with_discrepancy(
    likelihood: Likelihood, signals: Sequence[EffectSignal], shares: Sequence[float]
) -> Likelihood:
    """The same records with errors that hold those of the laws of a set's effects; the same object where no
    share is.

    signals: what each member makes, see `effect_signals`. shares: one a member.
    """
    if not any(shares):
        return likelihood
    curves: list[CurveData] = []
    for group in likelihood.groups:
        at = slice(len(curves), len(curves) + len(group.curves))
        curves += _widened(group, at, signals, shares)
    return replace(likelihood, curves=tuple(curves))


def effect_signals(exact: Fit, workers: DiscoveryWorkers) -> list[EffectSignal]:
    """What each member of a fit to the records' own errors makes of their curves.

    NotConverged where the axle has no equilibrium without one of them.
    """
    model, places = exact.model, list(exact.model.places())
    points = [(model.without(member), np.delete(exact.z, np.r_[place])) for member, place in places]
    without = zip(points, workers.residuals(points), strict=True)
    left = [fewer.residual(z) if residual is None else residual for (fewer, z), residual in without]
    return [_signal(model, h, exact.residual - r) for (h, _), r in zip(places, left, strict=True)]


def _signal(model: EffectModel, member: Hypothesis, whitened: FloatArray) -> EffectSignal:
    changes = tuple(curve.root @ whitened[at] for curve, at in model.likelihood.slices())
    largest: dict[tuple[str, Branches], float] = {}
    for curve, change in zip(model.likelihood.curves, changes, strict=True):
        key = (curve.response, curve.branches)
        largest[key] = max(largest.get(key, 0.0), float(np.abs(change).max()))
    friction = EFFECTS[member.effect].frictional
    return EffectSignal(changes, largest, friction, float(whitened @ whitened))


def balanced_correlation(relative: FloatArray) -> FloatArray:
    """(n, n) of the discrepancy of an elastic law, smooth and without a mean. relative: (n,) input over its
    amplitude."""
    centred = np.eye(relative.size) - 1.0 / relative.size
    return np.asarray(centred @ smooth_correlation(relative, DISCREPANCY_LENGTH) @ centred)


def _widened(
    group: CurveGroup, at: slice, signals: Sequence[EffectSignal], shares: Sequence[float]
) -> Iterator[CurveData]:
    """Its curves, whose places among all curves are `at`, with the wider errors."""
    first = group.first
    relative = first.input / np.abs(first.input).max()
    smooth = smooth_correlation(relative, DISCREPANCY_LENGTH)
    balanced = balanced_correlation(relative)
    shape = 1.0 - relative**2 if first.branches == "half_width" else relative
    roots = np.array([curve.root for curve in group.curves])
    covariance = roots @ roots.transpose(0, 2, 1)
    loaded = [i for i, curve in enumerate(group.curves) if curve.response == TYRE_LOAD]
    for one, share in zip(signals, shares, strict=True):
        if not share:
            continue
        change = share * np.array(one.changes[at])
        covariance += (smooth if one.friction else balanced) * change[:, :, None] * change[:, None, :]
        if one.friction:
            level = share * np.array([one.largest[c.response, c.branches] for c in group.curves])
            covariance += smooth * np.outer(shape, shape) * level[:, None, None] ** 2
            covariance[loaded] += level[loaded, None, None] ** 2
    for curve, root in zip(group.curves, np.linalg.cholesky(covariance), strict=True):
        yield replace(curve, root=root)
