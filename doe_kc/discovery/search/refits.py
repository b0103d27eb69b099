"""The joint refits of the leading hypotheses: which are worth one, which are believed, which one leads."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from doe_kc.discovery.fit import Fit
from doe_kc.discovery.gauss_newton import FitStart
from doe_kc.discovery.projection import Changes
from doe_kc.discovery.screening.screen import Screened
from doe_kc.discovery.search.proposals import SetProposal
from doe_kc.discovery.search.set_prior import SetPrior
from doe_kc.discovery.thresholds import (
    ABSORBED_SHARE,
    CONFIDENT,
    PLACES_REFITTED,
    REFIT_SHARE,
    REFITS_MOST,
    RELEVANT,
    RIVAL_CORRELATION,
    TIED_EVIDENCE,
)
from doe_kc.discovery.workers import DiscoveryWorkers
from doe_kc.effects.hypothesis import Hypothesis, Size

Sized = Iterable[tuple[Size, float, float]]
"""Amplitude of a size in typical ones, and its standard deviation."""


@dataclass(frozen=True)
class HypothesisFit:
    """A hypothesis refitted jointly with parameters, nuisances and the other members."""

    hypothesis: Hypothesis
    """The effect in its place."""
    fit: Fit
    """The model with it as the last member."""
    gain: float
    """ln of the posterior odds of the set with it against that without it."""
    prior: float = 0.0
    """ln of those odds before the records, part of `gain`."""


def leaders(screened: Sequence[Screened], fit: Fit, least: float, *, decoy: bool = True) -> list[Screened]:
    """The best and its rivals, which would explain the same; with `decoy` one of another kind is among them.

    fit: the model that they were screened beside. Effects that explain something else are no rivals: they
    have their own step. How much of the same a rival explains, its gain says, or its correlation: the gain of
    an effect that is large is little where a trace of it, to first order, could be as large.
    """
    if not screened or screened[0].gain <= least:
        return []
    best = screened[0]
    out = [best]
    own = _explained(best, fit)
    for s in screened[1:]:
        if s.gain <= least or len(out) == REFITS_MOST:
            break
        if sum(o.hypothesis.effect == s.hypothesis.effect for o in out) == PLACES_REFITTED:
            continue
        alike = abs(_correlation(own, _explained(s, fit), fit))
        share = max(s.gain / best.gain, alike**2)
        if alike > RIVAL_CORRELATION and share > REFIT_SHARE:
            out.append(s)
    small = (
        best.amplitudes.size > 0 and float(np.abs(best.amplitudes[0])) < RELEVANT
    )  # a trace needs no decoy
    if decoy and not small and all(s.hypothesis.effect == best.hypothesis.effect for s in out):
        out += [s for s in screened if s.hypothesis.effect != best.hypothesis.effect and not s.failed][:1]
    return out


def overlooked(screened: Sequence[Screened], least: float) -> list[Screened]:
    """Hypotheses that a screening may have missed; a typical one would show by `least` of ln likelihood."""
    shows = float(np.sqrt(2.0 * least))
    return [s for s in screened if not s.failed and s.absorbed >= ABSORBED_SHARE and s.detectability >= shows]


def untried(screened: Sequence[Screened], trials: Sequence[HypothesisFit]) -> list[Screened]:
    """Of every effect that no refit had, what screening has first.

    Beside a free play, whose contact moves with every other effect, screening can say next to nothing of one
    that explains all that remains.
    """
    known = {t.hypothesis.effect for t in trials}
    first: dict[str, Screened] = {}
    for s in screened:
        if not s.failed and s.hypothesis.effect not in known:
            first.setdefault(s.hypothesis.effect, s)
    return list(first.values())


def _explained(screened: Screened, fit: Fit) -> Changes:
    """(M, 1) what the effect does at its size."""
    change = screened.columns @ screened.amplitudes if screened.amplitudes.size else screened.change
    return fit.changes(change)


def _correlation(one: Changes, other: Changes, fit: Fit) -> float:
    """Of two changes after re-tuning; 0 where nothing is left of one."""
    seen = fit.without_traces
    lengths = float(np.sqrt(seen.squares(one)[0] * seen.squares(other)[0]))
    return float(seen.inner(one, other)[0, 0]) / lengths if lengths > 0.0 else 0.0


def believable(sizes: Sized) -> bool:
    """Whether no size is surely beyond what such a part has."""
    return not any(abs(a) - CONFIDENT * sd > size.most for size, a, sd in sizes)


def more_than_trace(sizes: Sized) -> bool:
    """Whether a size is surely more than a trace; an effect without a size counts when it is there."""
    counted = list(sizes)
    return not counted or any(abs(a) - CONFIDENT * sd >= RELEVANT for _, a, sd in counted)


def no_more_than_trace(sizes: Sized) -> bool:
    """Whether every size is surely that of a trace; never an effect without a size."""
    counted = list(sizes)
    return bool(counted) and all(abs(a) + CONFIDENT * sd < RELEVANT for _, a, sd in counted)


def more_than_none(sizes: Sized) -> bool:
    """Whether a size is surely not none; an effect without a size counts when it is there."""
    counted = list(sizes)
    return not counted or any(abs(a) > CONFIDENT * sd for _, a, sd in counted)


def joint_refits(
    current: Fit,
    screened: Sequence[Screened],
    prior: SetPrior,
    workers: DiscoveryWorkers,
    least: float = -np.inf,
) -> list[HypothesisFit]:
    """The joint refits from the screened sizes, best first; those without a solution are left out.

    least: gain below which a refit is of no use, so that it need not come to its end. Such refits keep their
    derivatives only where no effect is in yet: the verdict on a single effect begins with them.
    """
    starts = [
        replace(start, ceiling=useful_cost(current, s.hypothesis, least, prior))
        for s, start in zip(screened, refit_starts(current, screened), strict=True)
    ]

    def useful(refit: Fit) -> bool:
        return not current.model.members or hypothesis_fit(refit, current, prior).gain > least

    fits = workers.fits(starts, "refitting leaders", derivatives=useful)
    trials = [hypothesis_fit(refit, current, prior) for refit in fits if refit is not None]
    return sorted(trials, key=lambda t: -t.gain)


def useful_cost(current: Fit, hypothesis: Hypothesis, least: float, prior: SetPrior) -> float:
    """Largest cost with which a set with one more effect can gain `least` ln posterior odds.

    Its sizes narrow the posterior or leave it as it is; a half of each prior is all that a bound takes away.
    """
    if np.isinf(least):
        return np.inf
    halves = sum(not s.any_sign for s in hypothesis.sizes) * float(np.log(2.0))
    odds = prior.log_odds(current.model.members, hypothesis)
    return current.cost - 2.0 * (least - odds - halves)


def refit_starts(current: Fit, screened: Sequence[Screened], ceiling: float = np.inf) -> list[FitStart]:
    """Where the joint refits begin: at the screened sizes. ceiling: see `fit`."""
    return [
        FitStart(
            current.model.extended(s.hypothesis), np.concatenate([current.z, s.amplitudes]), current, ceiling
        )
        for s in screened
    ]


def best_of_each_set(trials: Sequence[HypothesisFit]) -> list[HypothesisFit]:
    """Of refits of the same set from several starts the best one; the largest gain first."""
    best: dict[frozenset[str], HypothesisFit] = {}
    for trial in sorted(trials, key=lambda t: -t.gain):
        best.setdefault(frozenset(h.name for h in trial.fit.model.members), trial)
    return list(best.values())


def set_refits(
    current: Fit, proposals: Sequence[SetProposal], prior: SetPrior, workers: DiscoveryWorkers
) -> list[HypothesisFit]:
    """The joint refits of whole sets, each against the set of `current`."""
    fixed = current.z[: current.model.dimension]
    starts = [
        FitStart(replace(current.model, members=p.members), np.concatenate([fixed, p.amplitudes]), current)
        for p in proposals
    ]
    fits = workers.fits(starts, "refitting sets")
    return [set_fit(refit, current, prior) for refit in fits if refit is not None and refit.model.members]


def set_fit(fit: Fit, current: Fit, prior: SetPrior) -> HypothesisFit:
    """A fit of a whole set, by its last member, against the set of `current`."""
    members = fit.model.members
    odds = prior.log(members) - prior.log(current.model.members)
    return HypothesisFit(members[-1], fit, fit.evidence - current.evidence + odds, odds)


def hypothesis_fit(fit: Fit, without: Fit, prior: SetPrior) -> HypothesisFit:
    """A fit's last member against the fit without it."""
    *others, own = fit.model.members
    odds = prior.log_odds(others, own)
    return HypothesisFit(own, fit, fit.evidence - without.evidence + odds, odds)


def plausible(trial: HypothesisFit) -> bool:
    """Whether the effect's sizes are believed."""
    return believable(amounts(trial))


def temper(fit: Fit) -> float:
    """T >= 1 by which ln evidence is divided: the mean square of the residual map, when that exceeds 1."""
    return max(1.0, fit.residual_map.mean_square)


def held_loss(fit: Fit, others: Sequence[Hypothesis]) -> float:
    """ln likelihood >= 0 that a fit would lose if the sizes of all members but some others were held at the
    most that is believed of them, to second order, with the slope of the cost at the fit's own bound.

    What the model lacks yet shifts sizes. Beside a tyre that was rigid still, the contact of a free play was
    too soft to be believed: held at the limit it lost 46 of 26 000, and where it was refused for that, a free
    play on both sides came in that nothing found back from. The toe of a hub beside a mount of the rack ended
    at the fit's bound: held it lost 120 of 38 700, and a clamp and tyres came in where it was refused.
    """
    names = {h.name for h in others}
    places, beyond, slopes = [], [], []
    for member, place in fit.model.places():
        for i, size in enumerate(member.sizes, start=place.start):
            excess = float(fit.z[i] - np.clip(fit.z[i], -size.most, size.most))
            if member.name in names or size.shape or excess == 0.0:
                continue
            places.append(i)
            beyond.append(excess)
            at_bound = fit.z[i] in (fit.model.lower[i], fit.model.upper[i])
            slopes.append(min(0.0, float(fit.gradient[i]) * excess) if at_bound else 0.0)
    if not places:
        return 0.0
    apart = np.array(beyond)
    return 0.5 * float(apart @ np.linalg.solve(fit.covariance[np.ix_(places, places)], apart)) - sum(slopes)


def amounts(trial: HypothesisFit) -> list[tuple[Size, float, float]]:
    """Sizes of the trial's effect that say how much, in typical ones, with their standard deviations."""
    sizes = trial.hypothesis.sizes
    sd = np.sqrt(np.diag(trial.fit.covariance))
    known = [(s, float(trial.fit.z[i]), float(sd[i])) for i, s in enumerate(sizes, start=-len(sizes))]
    return [item for item in known if not item[0].shape]


def stiffer_first(trials: list[HypothesisFit]) -> list[HypothesisFit]:
    """Of one signed effect at two places that say the same, the one of positive size leads, by convention.

    A bushing that is stiffer on the left is, with both re-tuned, one that is softer on the right.
    """
    if len(trials) < 2:
        return trials
    first, second, *rest = trials
    same = first.hypothesis.effect == second.hypothesis.effect and first.gain - second.gain < TIED_EVIDENCE
    one = len(first.hypothesis.sizes) == len(second.hypothesis.sizes) == 1
    if same and one and first.fit.z[-1] < 0.0 < second.fit.z[-1]:
        return [second, first, *rest]
    return trials
