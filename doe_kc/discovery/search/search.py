"""The search: one effect after the other, each by the evidence of its joint refit against its rivals'."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from doe_kc.axle.model import Axle
from doe_kc.correlation.likelihood import Likelihood
from doe_kc.discovery.fit import Fit, fit, refit_to_errors
from doe_kc.discovery.model import EffectModel
from doe_kc.discovery.nuisances import side_differences
from doe_kc.discovery.screening.disagreement import Map
from doe_kc.discovery.screening.screen import Screened, score_test
from doe_kc.discovery.search.law_discrepancy import fit_discrepancy, without_own_discrepancy
from doe_kc.discovery.search.pruning import backward_elimination
from doe_kc.discovery.search.refits import (
    HypothesisFit,
    compatible,
    joint_refits,
    leaders,
    overlooked,
    plausible,
    stiffer_first,
)
from doe_kc.discovery.thresholds import EFFECTS_MOST, FALSE_ALARM, LOOP_EVIDENCE, MOST_STEPS, PROMISING
from doe_kc.discovery.workers import DiscoveryWorkers
from doe_kc.effects.hypothesis import Hypothesis


@dataclass(frozen=True)
class Step:
    """One step of the search: a screening, refits of its leaders, the decision on the first."""

    before: Fit
    """The fit that the step began with."""
    map: Map
    """Where that fit and the records disagree."""
    screened: tuple[Screened, ...]
    """Every hypothesis that the fit can take, added to it; the largest gain first."""
    trials: tuple[HypothesisFit, ...]
    """Joint refits, best first, those of a plausible size that pass the threshold before all others."""
    temper: float
    """T >= 1: ln evidence is divided by T, the mean square of the residual map, when that exceeds 1."""
    accepted: bool
    """Whether the first refit passes the threshold, so that its effect is in the model from here on."""


@dataclass(frozen=True)
class EffectSearch:
    """Forward selection of effects with backward elimination, and the fits that it ends with."""

    tuned: Fit
    """The re-tuned axle without any effect, the baseline of every comparison."""
    steps: tuple[Step, ...]
    """In their order; the last one accepts nothing, or reached the largest number of effects or of steps."""
    with_law_discrepancy: Fit
    """With all accepted effects; the errors of the records hold the discrepancy of the effects' laws."""
    with_effects: Fit
    """With the same effects, fitted to the records' own errors alone, from there: what is handed over."""
    discrepancy_shares: Mapping[str, float]
    """Member's name -> standard deviation of its law's discrepancy, relative to what it makes of a curve."""
    without_own_discrepancy: Mapping[str, Likelihood]
    """Name of a member with such a discrepancy -> the last errors of the records without its own."""


def search(model: EffectModel, library: Sequence[Hypothesis], workers: DiscoveryWorkers) -> EffectSearch:
    """Tune, then add effects as long as the evidence asks for them.

    NotConverged when the nominal axle has no equilibrium.
    """
    tuned = current = tune(model)
    workers.watch("re-tuning", 1)
    steps: list[Step] = []
    shares: dict[str, float] = {}
    without_own: dict[str, Likelihood] = {}
    while True:
        step = _step(current, library, workers, steps[-1] if steps else None)
        steps.append(step)
        full = step.accepted and len(step.trials[0].fit.model.members) > EFFECTS_MOST
        if not step.accepted or full or len(steps) == MOST_STEPS:
            break
        current = backward_elimination(step.trials[0].fit, threshold(len(library)), workers, without_own)
        exact = refit_to_errors(with_conditioning(current, model.axle, workers), model.likelihood)
        current, shares = fit_discrepancy(exact)
        without_own = without_own_discrepancy(exact, shares)
        if current.model.likelihood is not step.trials[0].fit.model.likelihood:
            current = converged_fit(current, workers)
    with_effects = refit_to_errors(current, model.likelihood)
    return EffectSearch(tuned, tuple(steps), current, with_effects, shares, without_own)


def with_conditioning(current: Fit, own: Axle, workers: DiscoveryWorkers) -> Fit:
    """The fit with one loop before the record or with none, as the records with friction ask for.

    A rig runs until loops close; a simulated record may begin right after the first rise. Nothing in the
    files tells. Effects are looked for beside the better of the two. own: the axle as given, whose load cases
    stand where no friction is left, and loops change nothing.
    """
    model = current.model
    if not model.with_effects(current.z).topology.frictional:
        axle = replace(model.axle, load_cases=own.load_cases)
        return replace(current, model=replace(model, axle=axle))
    other = replace(model, axle=model.axle.conditioned(0 if model.axle.conditioning else 1))
    (refit,) = workers.fits([(other, current.z)], "loops before the record", current.jacobian)
    if refit is None or refit.evidence < current.evidence + LOOP_EVIDENCE:
        return current
    return refit


def converged_fit(current: Fit, workers: DiscoveryWorkers) -> Fit:
    """The fit at its own optimum, on derivatives taken there.

    What parameters hide almost wholly shows by what is left between two large columns, which derivatives of
    a model nearby do not give.
    """
    (refit,) = workers.fits([(current.model, current.z)], "settling", current.jacobian)
    return refit or current


def tune(model: EffectModel) -> Fit:
    """The best axle without a further effect, the differences between its sides linear about it."""
    first = fit(model, model.centre)
    sides = side_differences(model.axle_at(first.z), model.space, model.likelihood)
    sided = replace(model, sides=sides)
    start = np.concatenate([first.z, np.zeros(sided.dimension - model.dimension)])
    return fit(sided, start, tuning=np.hstack([first.jacobian, sides]), aged=0.0)


def threshold(count: int) -> float:
    """ln evidence that one of so many hypotheses must reach (Bonferroni on the family)."""
    return float(np.log(count / FALSE_ALARM))


def accepted_steps(search: EffectSearch) -> list[Step]:
    """Steps that brought in an effect, the latest first."""
    return [s for s in reversed(search.steps) if s.accepted]


def accepted_at(search: EffectSearch, hypothesis: Hypothesis) -> Step:
    """The step that brought a member in, the latest one."""
    return next(s for s in accepted_steps(search) if s.trials[0].hypothesis == hypothesis)


def _step(
    current: Fit,
    library: Sequence[Hypothesis],
    workers: DiscoveryWorkers,
    last: Step | None,
) -> Step:
    """last: the step before; its columns tell which hypotheses are worth a screening anew."""
    before = current.residual_map
    candidates = [h for h in library if compatible(current.model, h)]
    known = _rewhitened(last, current.model.likelihood) if last else ()
    quick = {s.hypothesis.name: score_test(current, s) for s in known}
    again = [h for h in candidates if h.name not in quick or quick[h.name].gain > PROMISING]
    full = {s.hypothesis.name: s for s in workers.screenings(current, again)}
    screened = [full.get(h.name) or quick[h.name] for h in candidates]
    screened.sort(key=lambda s: -s.gain)
    least = threshold(len(library))
    trials = joint_refits(current, leaders(screened, current.projection, least / 2.0), workers)
    if not before.agrees and all(t.gain <= least for t in trials):
        done = {t.hypothesis.name for t in trials}
        more = [s for s in overlooked(screened, least) if s.hypothesis.name not in done]
        trials = sorted([*trials, *joint_refits(current, more, workers)], key=lambda t: -t.gain)
    trials.sort(key=lambda t: t.gain > least and plausible(t), reverse=True)
    trials = stiffer_first(trials)
    if not trials:
        return Step(current, before, tuple(screened), (), 1.0, False)
    temper = max(1.0, trials[0].fit.residual_map.mean_square)
    passes = trials[0].gain / temper > least
    return Step(current, before, tuple(screened), tuple(trials), temper, passes)


def _rewhitened(step: Step, likelihood: Likelihood) -> list[Screened]:
    """What a step screened, in other errors of the records."""
    return [s.rewhitened(step.before.model.likelihood, likelihood) for s in step.screened]
