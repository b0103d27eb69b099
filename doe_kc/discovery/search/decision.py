"""One step of the search: what is refitted, and whether the best of it is taken."""

from __future__ import annotations

from collections.abc import Sequence, Set
from dataclasses import dataclass, replace

import numpy as np

from doe_kc.correlation.likelihood import Likelihood, Rewhitening
from doe_kc.discovery.fit import Fit
from doe_kc.discovery.screening.score_test import score_tests
from doe_kc.discovery.screening.screen import Screened, shape_of
from doe_kc.discovery.search.compatibility import compatible
from doe_kc.discovery.search.joined_places import joined_refits
from doe_kc.discovery.search.nominal_refits import refits_from_nominal
from doe_kc.discovery.search.proposals import LinearSets, SetProposal
from doe_kc.discovery.search.refits import (
    HypothesisFit,
    best_of_each_set,
    held_loss,
    joint_refits,
    leaders,
    overlooked,
    set_refits,
    stiffer_first,
    temper,
    untried,
)
from doe_kc.discovery.search.rig_faults import refits_of_the_car
from doe_kc.discovery.search.set_prior import SetPrior
from doe_kc.discovery.thresholds import (
    ACCEPTED_ODDS,
    FALSE_ALARM,
    LEADER_ROUNDS,
    NOISE_CHANCE,
    OVERLOOKED_MOST,
    PROMISING,
    PROPOSAL_GAIN,
    RESCREENED_MOST,
)
from doe_kc.discovery.workers import DiscoveryWorkers
from doe_kc.effects import EFFECTS
from doe_kc.effects.hypothesis import Hypothesis


@dataclass(frozen=True)
class HypothesisGain:
    """A hypothesis that a step looked at."""

    hypothesis: Hypothesis
    """The effect in its place; of several at once the last one."""
    gain: float
    """ln of the posterior odds of the model with it against that without it."""
    joint: bool
    """Whether that is of a joint refit, else of its screening."""
    beside: tuple[Hypothesis, ...] = ()
    """Further effects of that refit that the model did not have before."""


@dataclass(frozen=True)
class Step:
    """One step of the search: what it looked at and what it decided."""

    members: tuple[Hypothesis, ...]
    """Effects that were in the model before."""
    gap: float
    """Whitened RMS of all records before, in their own errors."""
    candidates: tuple[HypothesisGain, ...]
    """Best first, by what they gain with their new sizes held where those are believed."""
    temper: float
    """T >= 1: ln evidence is divided by T, the mean square of the residual map, when that exceeds 1."""
    added: tuple[Hypothesis, ...]
    """Effects that the step brought in."""
    accepted: bool
    """Whether its first refit, which may only have fewer effects, is the model from here on."""


@dataclass(frozen=True)
class Decision:
    """A screening, refits of what it proposes, the decision on the first; with all that was solved for it."""

    before: Fit
    """The fit that the step began with."""
    screened: tuple[Screened, ...]
    """Every hypothesis that the fit can take, added to it; the largest gain first."""
    trials: tuple[HypothesisFit, ...]
    """Joint refits, best first, by what they gain with their new sizes held where those are believed. One of
    several effects at once stands by the last of them."""
    temper: float
    """T >= 1: ln evidence is divided by T, the mean square of the residual map with the first refit, or
    before it where it does not pass, when that exceeds 1."""
    accepted: bool
    """Whether the first refit passes the threshold."""
    has_derivatives: bool = True
    """Whether its fits have their derivatives."""

    @property
    def without_derivatives(self) -> Decision:
        """What was looked at and decided, for the record; no fit can begin from it."""
        if not self.has_derivatives:
            return self
        return replace(
            self,
            has_derivatives=False,
            before=self.before.without_derivatives,
            screened=tuple(s.change_only for s in self.screened),
            trials=tuple(replace(t, fit=t.fit.without_derivatives) for t in self.trials),
        )

    @property
    def without_trials(self) -> Decision:
        """What was screened."""
        return replace(self, trials=())

    def step(self, own: Likelihood, prior: SetPrior) -> Step:
        """What is told of it. own: the records' own errors. prior: of sets."""
        before = self.before.model.members
        names = {h.name for h in before}
        refits = {t.hypothesis.name for t in self.trials}
        candidates = [HypothesisGain(t.hypothesis, t.gain, True, _beside(t, names)) for t in self.trials]
        others = [
            HypothesisGain(s.hypothesis, s.gain + prior.log_odds(before, s.hypothesis), False)
            for s in self.screened
            if s.hypothesis.name not in refits and not s.failed
        ]
        candidates += sorted(others, key=lambda c: -c.gain)
        after = self.trials[0].fit.model.members if self.accepted else ()
        added = tuple(h for h in after if h.name not in names)
        residual = Rewhitening(self.before.model.likelihood, own)(self.before.residual)
        gap = float(np.sqrt(np.mean(residual**2)))
        return Step(before, gap, tuple(candidates), self.temper, added, self.accepted)


def _beside(trial: HypothesisFit, names: Set[str]) -> tuple[Hypothesis, ...]:
    """Effects of a refit but its own, and but those of some names."""
    own = trial.hypothesis.name
    return tuple(h for h in trial.fit.model.members if h.name != own and h.name not in names)


def threshold(count: int) -> float:
    """ln evidence that one of so many hypotheses must reach to be noticed by itself (Bonferroni)."""
    return float(np.log(count / FALSE_ALARM))


def next_decision(
    current: Fit,
    library: Sequence[Hypothesis],
    prior: SetPrior,
    workers: DiscoveryWorkers,
    known: Sequence[Screened],
    first_screened: Sequence[Screened],
    *,
    runners_up: Set[str],
    laws_open: bool,
) -> Decision:
    """known: every hypothesis as it was screened last, in the errors of `current`. first_screened: as at the
    first step. runners_up: names of those, see the function. laws_open: whether other laws of the frictions
    in the set have yet to be tried.

    A decoy of another kind is refitted beside the first effect alone: beside further ones the verdict does so
    at the last set.
    """
    least = threshold(len(library))
    screened = _screened(current, known, workers)
    trials = set_refits(current, _proposed(current, screened, prior), prior, workers)
    if not any(_passes(t, current) for t in trials):
        trials += _leader_refits(current, screened, least, prior, workers)
    trials += refits_from_nominal(current, screened, first_screened, trials, prior, workers)
    trials += refits_of_the_car(current, screened, least / 2.0, trials, prior, workers)
    if current.residual_map.chance < NOISE_CHANCE and not any(_passes(t, current) for t in trials):
        done = {t.hypothesis.name for t in trials}
        more = [s for s in overlooked(screened, least) if s.hypothesis.name not in done]
        trials += joint_refits(current, more[:OVERLOOKED_MOST], prior, workers, ACCEPTED_ODDS)
    if not laws_open and not any(_accepted(t, current) for t in trials):
        further = _further_candidates(current, screened, trials, runners_up)
        trials += joint_refits(current, further, prior, workers, ACCEPTED_ODDS)
    best = max(trials, key=lambda t: _believed_gain(t, current), default=None)
    if best is not None and _passes(best, current):
        trials += joined_refits(current, best, library, prior, workers)
    trials = best_of_each_set(trials)
    trials.sort(key=lambda t: (_believed_gain(t, current), t.gain), reverse=True)
    trials = stiffer_first(trials)
    if not trials:
        return Decision(current, tuple(screened), (), temper(current), False)
    first = trials[0]
    divisor = temper(first.fit if first.gain > ACCEPTED_ODDS else current)
    return Decision(current, tuple(screened), tuple(trials), divisor, first.gain / divisor > ACCEPTED_ODDS)


def runners_up(steps: Sequence[Step]) -> Set[str]:
    """Names of effects that would have been accepted, beside others, where another one was; by their last
    refit.

    Tyres of 267 N/mm, beside a free play of 0.33 mm, gained 20 of ln odds where a gain of the camber sensor
    gained 20.3. Beside the laws that came last they had -5 by their screening, which says little beside a
    free play, and 28 by a refit; they were told as none below 730 N/mm.
    """
    last = {c.hypothesis.name: c.gain for s in steps if s.members for c in s.candidates if _alone(c)}
    return {name for name, gain in last.items() if gain > ACCEPTED_ODDS}


def _alone(candidate: HypothesisGain) -> bool:
    return candidate.joint and not candidate.beside


def _further_candidates(
    current: Fit, screened: Sequence[Screened], trials: Sequence[HypothesisFit], runners_up: Set[str]
) -> list[Screened]:
    """What has no refit although screening says too little of it: where noise does not explain what is left,
    what that has first of every effect; else the runners-up of earlier steps."""
    if current.residual_map.chance < NOISE_CHANCE:
        return untried(screened, trials)
    done = {t.hypothesis.name for t in trials}
    return [s for s in screened if s.hypothesis.name in runners_up - done and not s.failed]


def _leader_refits(
    current: Fit, screened: Sequence[Screened], least: float, prior: SetPrior, workers: DiscoveryWorkers
) -> list[HypothesisFit]:
    """Refits of what screening has first; where none of them passes, of what it has first among the others.

    A friction that changes little is hardly linear, and can promise hundreds that its refit does not keep.
    """
    trials: list[HypothesisFit] = []
    left, decoy = list(screened), not current.model.members
    useful = -np.inf if decoy else ACCEPTED_ODDS  # the verdict on a single effect asks for all to their end
    for _ in range(LEADER_ROUNDS):
        near = leaders(left, current, least / 2.0, decoy=decoy)
        trials += joint_refits(current, near, prior, workers, useful)
        if not near or any(_passes(t, current) for t in trials):
            break
        done = {s.hypothesis.name for s in near}
        left, decoy = [s for s in left if s.hypothesis.name not in done], False
    return trials


def _passes(trial: HypothesisFit, current: Fit) -> bool:
    """Whether a refit is worth a step, all new sizes held where they are believed."""
    return _believed_gain(trial, current) > ACCEPTED_ODDS


def _believed_gain(trial: HypothesisFit, current: Fit) -> float:
    """ln posterior odds of a refit whose new sizes are held where they are believed."""
    return trial.gain - held_loss(trial.fit, current.model.members)


def _accepted(trial: HypothesisFit, current: Fit) -> bool:
    """Whether it would be accepted if it came first."""
    return _passes(trial, current) and trial.gain / temper(trial.fit) > ACCEPTED_ODDS


def _screened(current: Fit, known: Sequence[Screened], workers: DiscoveryWorkers) -> list[Screened]:
    """Every hypothesis that the fit can take; those that promise most on true solutions."""
    there = [s for s in known if compatible(current.model, s.hypothesis)]
    if current.model.members:  # without any, they are screened at the very same axle
        there = sorted(score_tests(current, there), key=lambda s: -s.gain)
        again = [s for s in there[:RESCREENED_MOST] if s.gain > PROMISING]
        shapes = [shape_of(s) for s in again]
        full = {
            s.hypothesis.name: s
            for s in workers.screenings(current, [s.hypothesis for s in again], shapes=shapes)
        }
        there = [full.get(s.hypothesis.name, s) for s in there]
    return sorted(there, key=lambda s: -s.gain)


def _proposed(current: Fit, screened: Sequence[Screened], prior: SetPrior) -> list[SetProposal]:
    """The most probable set to first order, if that is not just one effect more, of which the rivals count.

    A friction comes in alone: what its law leaves behind must not bring in another effect.
    """
    sets = LinearSets.of(current, screened, prior)
    best = next(iter(sets.proposals()), None)
    if best is None or best.gain <= ACCEPTED_ODDS:
        return []
    before = {h.name for h in current.model.members}
    added = [h for h in best.members if h.name not in before]
    removed = len(before) - (len(best.members) - len(added))
    sure = all(sets.loss(best, h) >= PROPOSAL_GAIN for h in added)
    friction = any(EFFECTS[h.effect].frictional and EFFECTS[h.effect].laws for h in added)
    return [best] if removed or (len(added) > 1 and sure and not friction) else []
