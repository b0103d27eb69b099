"""Backward elimination: effects that later ones have made needless."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from doe_kc.discovery.fit import Fit
from doe_kc.discovery.gauss_newton import FitStart
from doe_kc.discovery.search.convergence import at_optima, fit_to_errors, fits_near
from doe_kc.discovery.search.member_state import MemberState, TriedRemoval
from doe_kc.discovery.search.set_prior import SetPrior
from doe_kc.discovery.thresholds import BEYOND_DOUBT, REMOVAL_FACTOR
from doe_kc.discovery.workers import DiscoveryWorkers
from doe_kc.effects.hypothesis import Hypothesis


@dataclass(frozen=True)
class Elimination:
    """A set without the members that it makes needless."""

    fit: Fit
    """Of the members that stay."""
    removals: dict[str, TriedRemoval]
    """How the removals of all members ended that were tried, now or before."""
    beside: Fit | None
    """What was fitted beside the removals, at its optimum; None where no removal was tried, or a member
    went."""


def backward_elimination(
    fit: Fit,
    least: float,
    workers: DiscoveryWorkers,
    known: MemberState,
    prior: SetPrior,
    beside: Fit | None = None,
) -> Elimination:
    """The fit without the members whose posterior odds against their removal are below `least`, ln.

    known: of the set before, its `without_own` also of this one: with its own discrepancy among the errors,
    what a member makes would pass for an error of the records. beside: a fit of the same set that is of use
    if all members stay, brought to its optimum while a worker would be idle.
    """
    removals, exact = dict(known.removals), None
    while fit.model.members:
        members = fit.model.members
        needed = {h.name: least - _odds(members, h, prior) for h in members}
        tried, nears = _doubtful(fit, needed, replace(known, removals=removals))
        withs = at_optima(nears, workers)
        starts = [
            FitStart(w.model.without(h), np.delete(w.z, np.r_[place]), fit, w.cost + 2.0 * BEYOND_DOUBT)
            for w, (h, place) in zip(withs, tried, strict=True)
        ]
        also = [beside] if beside is not None and starts and not beside.converged else []
        fewer = workers.fits([*starts, *(FitStart(f.model, f.z, f) for f in also)], "taking effects out")
        if also:
            *fewer, reached = fewer
            exact = reached or beside
        spare: dict[str, float] = {}
        for (member, place), near, refit in zip(tried, withs, fewer, strict=True):
            if refit is not None:
                lost = near.evidence - refit.evidence
                removals[member.name] = TriedRemoval(_carried(near, place), lost)
                spare[member.name] = lost - needed[member.name]
        least_lost = min(spare, key=lambda name: spare[name], default="")
        if not least_lost or spare[least_lost] > 0.0:
            break
        beside = exact = None
        (without,) = (f for (h, _), f in zip(tried, fewer, strict=True) if h.name == least_lost)
        assert without is not None
        fit = fit_to_errors(without, fit.model.likelihood, workers)
    return Elimination(fit, removals, exact)


def _doubtful(
    fit: Fit, needed: Mapping[str, float], known: MemberState
) -> tuple[list[tuple[Hypothesis, slice]], list[Fit]]:
    """Members that are tried without, with their places, and each one's fit to errors that do not hold its
    law. The others would come in again: in either errors they carry many times what it takes, or not much
    less than when their removal was last tried and lost that. What one without a size carries is not known
    until it is tried: what it lost then counts from there on."""

    def weak(near: Fit, member: Hypothesis, place: slice) -> bool:
        loss, tried = _carried(near, place), known.removals.get(member.name)
        if tried is not None and not member.sizes:
            loss = min(tried.lost, BEYOND_DOUBT)
        elif tried is not None and tried.carried > 0.0:
            loss *= max(1.0, min(tried.lost, BEYOND_DOUBT) / tried.carried)
        return loss < REMOVAL_FACTOR * needed[member.name]

    members = [(h, place) for h, place in fit.model.places() if weak(fit, h, place)]
    nears = fits_near(fit, [known.without_own.get(h.name, fit.model.likelihood) for h, _ in members])
    doubtful = [(one, near) for one, near in zip(members, nears, strict=True) if weak(near, *one)]
    return [one for one, _ in doubtful], [near for _, near in doubtful]


def _odds(members: Sequence[Hypothesis], member: Hypothesis, prior: SetPrior) -> float:
    """ln of the odds of a set against that without one of its members, before the records."""
    return prior.log_odds([h for h in members if h != member], member)


def _carried(fit: Fit, place: slice) -> float:
    """ln likelihood that a member's sizes carry, to second order (Wald); 0 for one without sizes."""
    amplitudes = fit.z[place]
    if not amplitudes.size:
        return 0.0
    return 0.5 * float(amplitudes @ np.linalg.inv(fit.covariance[place, place]) @ amplitudes)
