"""The search: one effect after the other, each by the evidence of its joint refit against its rivals'."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from doe_kc.axle.model import Axle
from doe_kc.correlation.likelihood import Likelihood
from doe_kc.discovery.fit import Fit, fit, to_errors
from doe_kc.discovery.model import EffectModel
from doe_kc.discovery.nuisances import side_differences
from doe_kc.discovery.screening.disagreement import Map, remaining_map
from doe_kc.discovery.screening.screen import Screened, rescreened
from doe_kc.discovery.search.law_discrepancy import fit_discrepancy, without_own_discrepancy
from doe_kc.discovery.search.pruning import pruned
from doe_kc.discovery.search.refits import (
    HypothesisFit,
    compatible,
    leaders,
    overlooked,
    plausible,
    stiffer_first,
    tried,
)
from doe_kc.discovery.thresholds import EFFECTS_MOST, FALSE_ALARM, LOOP_EVIDENCE, MOST_STEPS, PROMISING
from doe_kc.discovery.workers import DiscoveryWorkers
from doe_kc.effects.hypothesis import Hypothesis


@dataclass(frozen=True)
class Step:
    """One step of the search. before: the model that it began with, its map and the screening there.

    trials: best first, those of a size that is believed before others. temper: what ln evidence is divided
    by, because what remains is not noise alone.
    """

    before: Fit
    map: Map
    screened: tuple[Screened, ...]
    trials: tuple[HypothesisFit, ...]
    temper: float
    accepted: bool


@dataclass(frozen=True)
class EffectSearch:
    """tuned: without any effect. final: with all accepted ones, the shape of their laws granted.

    plain: fitted to the records' own errors alone, from there: what is handed over, with the smallest gap.
    shares: member's name -> by how much of what it makes of a curve its law departs from the model's.
    without_law: of a member whose law is open, the final errors without what is granted to that.
    """

    tuned: Fit
    steps: tuple[Step, ...]
    final: Fit
    plain: Fit
    shares: Mapping[str, float]
    without_law: Mapping[str, Likelihood]


def search(model: EffectModel, library: Sequence[Hypothesis], bench: DiscoveryWorkers) -> EffectSearch:
    """Tune, then add effects as long as the evidence asks for them.

    NotConverged when the nominal axle has no equilibrium.
    """
    tuned = current = tune(model)
    bench.watch("re-tuning", 1)
    steps: list[Step] = []
    shares: dict[str, float] = {}
    without_law: dict[str, Likelihood] = {}
    while True:
        step = _step(current, library, bench, steps[-1] if steps else None)
        steps.append(step)
        full = step.accepted and len(step.trials[0].fit.model.members) > EFFECTS_MOST
        if not step.accepted or full or len(steps) == MOST_STEPS:
            break
        current = pruned(step.trials[0].fit, threshold(len(library)), bench, without_law)
        exact = to_errors(with_conditioning(current, model.axle, bench), model.likelihood)
        current, shares = fit_discrepancy(exact)
        without_law = without_own_discrepancy(exact, shares)
        if current.model.likelihood is not step.trials[0].fit.model.likelihood:
            current = settled(current, bench)
    plain = to_errors(current, model.likelihood)
    return EffectSearch(tuned, tuple(steps), current, plain, shares, without_law)


def with_conditioning(current: Fit, own: Axle, bench: DiscoveryWorkers) -> Fit:
    """The fit with one loop before the record or with none, as the records with friction ask for.

    A rig runs until loops close; a simulated record may begin right after the first rise. Nothing in the
    files tells. Effects are looked for beside the better of the two. own: the axle as given, whose load cases
    stand where no friction is left, and loops change nothing.
    """
    model = current.model
    if not model.with_effects(current.z).topology.frictional:
        given = replace(model.axle, load_cases=own.load_cases)
        return replace(current, model=replace(model, axle=given))
    other = replace(model, axle=model.axle.conditioned(0 if model.axle.conditioning else 1))
    (found,) = bench.fitted([(other, current.z)], "loops before the record", current.jacobian)
    if found is None or found.evidence < current.evidence + LOOP_EVIDENCE:
        return current
    return found


def settled(current: Fit, bench: DiscoveryWorkers) -> Fit:
    """The fit at its own optimum, on derivatives taken there.

    What parameters hide almost wholly shows by what is left between two large columns, which derivatives of
    a model nearby do not give.
    """
    (found,) = bench.fitted([(current.model, current.z)], "settling", current.jacobian)
    return found or current


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
    bench: DiscoveryWorkers,
    last: Step | None,
) -> Step:
    """last: the step before; its columns tell which hypotheses are worth a screening anew."""
    project, shapes = current.projection, current.model.contrasts
    before = remaining_map(shapes, current.residual, project)
    candidates = [h for h in library if compatible(current.model, h)]
    known = _in_errors(last, current.model.likelihood) if last else ()
    quick = {s.hypothesis.name: rescreened(current, s) for s in known}
    again = [h for h in candidates if h.name not in quick or quick[h.name].gain > PROMISING]
    full = {s.hypothesis.name: s for s in bench.screened(current, again)}
    screened = [full.get(h.name) or quick[h.name] for h in candidates]
    screened.sort(key=lambda s: -s.gain)
    least = threshold(len(library))
    trials = tried(current, leaders(screened, project, least / 2.0), bench)
    if not before.agrees and all(t.gain <= least for t in trials):
        done = {t.hypothesis.name for t in trials}
        more = [s for s in overlooked(screened, least) if s.hypothesis.name not in done]
        trials = sorted([*trials, *tried(current, more, bench)], key=lambda t: -t.gain)
    trials.sort(key=lambda t: t.gain > least and plausible(t), reverse=True)
    trials = stiffer_first(trials)
    if not trials:
        return Step(current, before, tuple(screened), (), 1.0, False)
    after = remaining_map(shapes, trials[0].fit.residual, trials[0].fit.projection)
    temper = max(1.0, after.mean_square)
    passes = trials[0].gain / temper > least
    return Step(current, before, tuple(screened), tuple(trials), temper, passes)


def _in_errors(step: Step, likelihood: Likelihood) -> list[Screened]:
    """What a step screened, in other errors of the records."""
    return [s.with_errors(step.before.model.likelihood, likelihood) for s in step.screened]
