"""The search: one effect after the other, each by the evidence of its joint refit against its rivals'."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from doe_kc.correlation.likelihood import Likelihood
from doe_kc.discovery.belief import believed
from doe_kc.discovery.bench import Bench
from doe_kc.discovery.contrasts import contrasts
from doe_kc.discovery.disagreement import Map, remaining_map
from doe_kc.discovery.fit import Fit, fit, followed, rewhitened
from doe_kc.discovery.granted import opened
from doe_kc.discovery.leaders import compatible, leaders
from doe_kc.discovery.model import EffectModel
from doe_kc.discovery.projection import projection
from doe_kc.discovery.screen import Screened, rescreened
from doe_kc.discovery.sides import side_differences
from doe_kc.effects import EFFECTS
from doe_kc.effects.hypothesis import Hypothesis

MOST = 6
"""Effects, named ones and traces, after which the search ends."""
DOUBTFUL = 10.0
"""Times the threshold: a member that carries more is not tried without."""
FALSE_ALARM = 0.01
"""Chance that noise alone brings in any effect at a step."""
TIED = 1.0
"""ln evidence up to which two places are taken for equally good."""
ASKED = 2.3
"""ln evidence, ten to one, for which the loops before the record are changed: a loop more takes its time."""
PROMISING = 1.0
"""ln evidence to first order from which a hypothesis is screened anew at a later step."""


@dataclass(frozen=True)
class Trial:
    """A hypothesis refitted jointly. gain: ln of the evidence over the model without it, times its odds."""

    hypothesis: Hypothesis
    fit: Fit
    gain: float


@dataclass(frozen=True)
class Step:
    """One step of the search. before: the model that it began with, its map and the screening there.

    trials: best first, those of a size that is believed before others. temper: what ln evidence is divided
    by, because what remains is not noise alone.
    """

    before: Fit
    map: Map
    screened: tuple[Screened, ...]
    trials: tuple[Trial, ...]
    temper: float
    accepted: bool


@dataclass(frozen=True)
class Search:
    """tuned: without any effect. final: with all accepted ones, the shape of their laws granted.

    plain: fitted to the records' own errors alone, from there: what is handed over, with the smallest gap.
    losses: member's name -> ln evidence that would be lost without it, all others refitted.
    shares: member's name -> by how much of what it makes of a curve its law departs from the model's.
    """

    tuned: Fit
    steps: tuple[Step, ...]
    final: Fit
    plain: Fit
    losses: Mapping[str, float]
    shares: Mapping[str, float]


def search(model: EffectModel, library: Sequence[Hypothesis], bench: Bench) -> Search:
    """Tune, then add effects as long as the evidence asks for them.

    NotConverged when the nominal axle has no equilibrium.
    """
    tuned = current = tune(model)
    bench.watch("re-tuning", 1)
    steps: list[Step] = []
    losses: dict[str, float] = {}
    shares: dict[str, float] = {}
    while True:
        step = _step(current, library, bench, steps[-1].screened if steps else ())
        steps.append(step)
        if not step.accepted or len(step.trials[0].fit.model.members) > MOST:
            break
        current, lost = pruned(step.trials[0].fit, threshold(len(library)), bench)
        losses |= {step.trials[0].hypothesis.name: step.trials[0].gain, **lost}
        current, shares = opened(to_records(with_conditioning(current, bench), model.likelihood))
    return Search(tuned, tuple(steps), current, to_records(current, model.likelihood), losses, shares)


def with_conditioning(current: Fit, bench: Bench) -> Fit:
    """The fit with one loop before the record or with none, as the records with friction ask for.

    A rig runs until loops close; a simulated record may begin right after the first rise. Nothing in the
    files tells. Effects are looked for beside the better of the two.
    """
    model = current.model
    if not model.with_effects(current.z).topology.frictional:
        return current
    other = replace(model, axle=model.axle.conditioned(1 - model.axle.conditioning))
    (found,) = bench.fitted([(other, current.z)], "loops before the record", current.jacobian)
    if found is None or found.evidence < current.evidence + ASKED:
        return current
    return found


def to_records(current: Fit, likelihood: Likelihood) -> Fit:
    """The fit to the records' own errors alone, from where it is."""
    own = replace(current.model, likelihood=likelihood)
    return followed(rewhitened(current, own), own)


def tune(model: EffectModel) -> Fit:
    """The best axle without a further effect, the differences between its sides linear about it."""
    first = fit(model, model.centre)
    sided = replace(model, sides=side_differences(model, first.z))
    start = np.concatenate([first.z, np.zeros(sided.dimension - model.dimension)])
    return fit(sided, start)


def threshold(count: int) -> float:
    """ln evidence that one of so many hypotheses must reach (Bonferroni on the family)."""
    return float(np.log(count / FALSE_ALARM))


def accepted_steps(found: Search) -> list[Step]:
    """Steps that brought in an effect, the latest first."""
    return [s for s in reversed(found.steps) if s.accepted]


def _step(
    current: Fit,
    library: Sequence[Hypothesis],
    bench: Bench,
    known: Sequence[Screened],
) -> Step:
    """known: the step before; its columns tell which hypotheses are worth a screening anew."""
    project, shapes = projection(current), contrasts(current.model.likelihood)
    before = remaining_map(shapes, current.residual, project)
    candidates = [h for h in library if compatible(current.model, h)]
    quick = {s.hypothesis.name: rescreened(current, project, s) for s in known}
    again = [h for h in candidates if h.name not in quick or quick[h.name].gain > PROMISING]
    full = {s.hypothesis.name: s for s in bench.screened(current, again)}
    screened = [full.get(h.name) or quick[h.name] for h in candidates]
    screened.sort(key=lambda s: -s.gain)
    trials = tried(current, leaders(screened, project, threshold(len(library)) / 2.0), bench)
    least = threshold(len(library))
    trials.sort(key=lambda t: t.gain > least and plausible(t), reverse=True)
    trials = stiffer_first(trials)
    if not trials:
        return Step(current, before, tuple(screened), (), 1.0, False)
    after = remaining_map(shapes, trials[0].fit.residual, projection(trials[0].fit))
    temper = max(1.0, after.mean_square)
    passes = trials[0].gain / temper > least
    return Step(current, before, tuple(screened), tuple(trials), temper, passes)


def plausible(trial: Trial) -> bool:
    """Whether the effect's sizes are believed."""
    sd = np.sqrt(np.diag(trial.fit.covariance))
    count = len(trial.hypothesis.sizes)
    sizes = zip(trial.hypothesis.sizes, trial.fit.z[-count:], sd[-count:], strict=True) if count else ()
    return believed((float(a), float(e)) for s, a, e in sizes if s.growth != "shape")


def stiffer_first(trials: list[Trial]) -> list[Trial]:
    """Of one signed effect at two places that say the same, the one of positive size leads, by convention.

    A bushing that is stiffer on the left is, with both re-tuned, one that is softer on the right.
    """
    if len(trials) < 2:
        return trials
    first, second, *rest = trials
    same = first.hypothesis.effect == second.hypothesis.effect and first.gain - second.gain < TIED
    one = len(first.hypothesis.sizes) == len(second.hypothesis.sizes) == 1
    if same and one and first.fit.z[-1] < 0.0 < second.fit.z[-1]:
        return [second, first, *rest]
    return trials


def tried(current: Fit, screened: Sequence[Screened], bench: Bench) -> list[Trial]:
    """The joint refits from the screened sizes, best first; those without a solution are left out."""
    starts = [
        (current.model.extended(s.hypothesis), np.concatenate([current.z, s.amplitudes])) for s in screened
    ]
    fits = bench.fitted(starts, "refitting leaders", current.jacobian)
    trials = []
    for s, found in zip(screened, fits, strict=True):
        if found is not None:
            odds = float(np.log(EFFECTS[s.hypothesis.effect].odds))
            trials.append(Trial(s.hypothesis, found, found.evidence - current.evidence + odds))
    return sorted(trials, key=lambda t: -t.gain)


def pruned(found: Fit, least: float, bench: Bench) -> tuple[Fit, dict[str, float]]:
    """Backward elimination: members that the later ones have made needless are taken out.

    Also what the model would lose without each but the latest, ln evidence.
    """
    losses: dict[str, float] = {}
    while len(found.model.members) > 1:
        losses = {h.name: _loss(found, place) for h, place in list(found.model.places())[:-1]}
        members = [(h, p) for h, p in found.model.places() if losses.get(h.name, np.inf) < DOUBTFUL * least]
        starts = [(found.model.without(h), np.delete(found.z, np.r_[place])) for h, place in members]
        tuning = found.jacobian[:, : found.model.dimension]
        fewer = bench.fitted(starts, "taking effects out", tuning)
        for (h, _), f in zip(members, fewer, strict=True):
            if f is not None:
                losses[h.name] = found.evidence - f.evidence
        kept = [f for f in fewer if f is not None]
        best = max(kept, key=lambda f: f.evidence, default=None)
        if best is None or found.evidence - best.evidence > least:
            break
        found = best
    return found, losses


def _loss(found: Fit, place: slice) -> float:
    """ln likelihood that a member's sizes carry, to second order (Wald); 0 for one without sizes."""
    amplitudes = found.z[place]
    if not amplitudes.size:
        return 0.0
    return 0.5 * float(amplitudes @ np.linalg.inv(found.covariance[place, place]) @ amplitudes)
