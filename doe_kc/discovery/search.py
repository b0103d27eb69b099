"""The search: one effect after the other, each by the evidence of its joint refit against its rivals'."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from doe_kc.correlation.likelihood import Likelihood
from doe_kc.discovery.bench import Bench
from doe_kc.discovery.contrasts import contrasts
from doe_kc.discovery.disagreement import Map, remaining_map
from doe_kc.discovery.fit import Fit, fit, followed, rewhitened
from doe_kc.discovery.granted import granted
from doe_kc.discovery.leaders import compatible, leaders
from doe_kc.discovery.model import EffectModel
from doe_kc.discovery.projection import projection
from doe_kc.discovery.screen import Screened, rescreened
from doe_kc.discovery.sides import side_differences
from doe_kc.effects import EFFECTS
from doe_kc.effects.hypothesis import Hypothesis

MOST = 6
"""Effects, named ones and traces, after which the search ends."""
LARGEST_BELIEVED = 3.0
"""Typical sizes."""
CONFIDENT = 2.0
"""Standard deviations beyond them from which an effect is not believed."""
DOUBTFUL = 10.0
"""Times the threshold: a member that carries more is not tried without."""
FALSE_ALARM = 0.01
"""Chance that noise alone brings in any effect at a step."""
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
    """

    tuned: Fit
    steps: tuple[Step, ...]
    final: Fit
    plain: Fit


def search(model: EffectModel, library: Sequence[Hypothesis], bench: Bench) -> Search:
    """Tune, then add effects as long as the evidence asks for them.

    NotConverged when the nominal axle has no equilibrium.
    """
    tuned = current = tune(model)
    bench.watch("re-tuning", 1)
    steps: list[Step] = []
    while True:
        step = _step(current, library, bench, steps[-1].screened if steps else ())
        steps.append(step)
        if not step.accepted or len(step.trials[0].fit.model.members) > MOST:
            break
        current = pruned(step.trials[0].fit, threshold(len(library)), bench)
        current = with_open_laws(current, model.likelihood)
    own = replace(current.model, likelihood=model.likelihood)
    return Search(tuned, tuple(steps), current, followed(rewhitened(current, own), own))


def with_open_laws(current: Fit, likelihood: Likelihood) -> Fit:
    """The fit with the laws of its effects left open, unless they explain the records as they are."""
    model = replace(current.model, likelihood=likelihood)
    exact = followed(rewhitened(current, model), model)
    if remaining_map(contrasts(likelihood), exact.residual, projection(exact)).agrees:
        return exact
    wider = granted(model, likelihood, exact.z)
    return followed(rewhitened(exact, wider), wider)


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
    if not trials:
        return Step(current, before, tuple(screened), (), 1.0, False)
    after = remaining_map(shapes, trials[0].fit.residual, projection(trials[0].fit))
    temper = max(1.0, after.mean_square)
    passes = trials[0].gain / temper > least
    return Step(current, before, tuple(screened), tuple(trials), temper, passes)


def plausible(trial: Trial) -> bool:
    """Whether the effect's sizes are believed: none surely beyond three typical ones."""
    sd = np.sqrt(np.diag(trial.fit.covariance))
    count = len(trial.hypothesis.sizes)
    sizes = zip(trial.hypothesis.sizes, trial.fit.z[-count:], sd[-count:], strict=True) if count else ()
    return not any(s.growth != "shape" and abs(a) - CONFIDENT * e > LARGEST_BELIEVED for s, a, e in sizes)


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


def pruned(found: Fit, least: float, bench: Bench) -> Fit:
    """Backward elimination: members that the later ones have made needless are taken out."""
    while len(found.model.members) > 1:
        members = [(h, p) for h, p in list(found.model.places())[:-1] if _loss(found, p) < DOUBTFUL * least]
        starts = [(found.model.without(h), np.delete(found.z, np.r_[place])) for h, place in members]
        tuning = found.jacobian[:, : found.model.dimension]
        fewer = [f for f in bench.fitted(starts, "taking effects out", tuning) if f is not None]
        best = max(fewer, key=lambda f: f.evidence, default=None)
        if best is None or found.evidence - best.evidence > least:
            return found
        found = best
    return found


def _loss(found: Fit, place: slice) -> float:
    """ln likelihood that a member's sizes carry, to second order (Wald); 0 for one without sizes."""
    amplitudes = found.z[place]
    if not amplitudes.size:
        return 0.0
    return 0.5 * float(amplitudes @ np.linalg.inv(found.covariance[place, place]) @ amplitudes)
