"""What could be in the place of each effect of the last set, all others in it: nothing, or another effect.

The step that brought an effect in says nothing of that: other effects were missing then, and what looked like
a rival may have come in beside it. So each is taken out of the last set, and each plausible rival that would
explain the same is put in its place, all else refitted.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from doe_kc.discovery.fit import Fit, last_member, refit_to_errors
from doe_kc.discovery.screening.disagreement import Map
from doe_kc.discovery.screening.screen import Screened, score_test
from doe_kc.discovery.search.compatibility import compatible
from doe_kc.discovery.search.refits import (
    HypothesisFit,
    hypothesis_fit,
    joint_refits,
    leaders,
    plausible,
)
from doe_kc.discovery.search.search import EffectSearch, Step, accepted_at, threshold
from doe_kc.discovery.search.set_prior import SetPrior
from doe_kc.discovery.workers import DiscoveryWorkers
from doe_kc.effects.hypothesis import Hypothesis


@dataclass(frozen=True)
class Alternatives:
    """One effect of the last set, its removal and its rivals."""

    without: Fit
    """The set without it, refitted; the errors hold the discrepancy of all others' laws, not that of its own
    nor of its rivals'."""
    screened: tuple[Screened, ...]
    """Itself, then the library without the other members, added to `without`."""
    trials: tuple[HypothesisFit, ...]
    """Itself, then the plausible rivals in its place, refitted, best first; gains are over `without`."""
    temper: float
    """T >= 1: ln evidence is divided by T, the mean square of the residual map, when that exceeds 1."""

    @property
    def hypothesis(self) -> Hypothesis:
        """The effect itself."""
        return self.trials[0].hypothesis

    @property
    def loss(self) -> float:
        """ln evidence lost by its removal."""
        own = self.trials[0]
        return own.gain - own.prior

    @property
    def map(self) -> Map:
        """Where model and records disagree without it."""
        return self.without.residual_map


def alternatives(search: EffectSearch, temper: float, workers: DiscoveryWorkers) -> tuple[Alternatives, ...]:
    """The alternatives of every member of the last set, in its order."""
    members = search.with_law_discrepancy.model.members
    bases = [_without_own_law(search, h) for h in members]
    steps = [_same_set(search, base) for base in bases]
    missing = [base for base, step in zip(bases, steps, strict=True) if step is None]
    starts = [(b.model.without(b.model.members[-1]), b.z[: _first_size(b)]) for b in missing]
    refits = iter(workers.fits(starts, "taking effects out", search.with_law_discrepancy.jacobian))
    out = []
    for base, step in zip(bases, steps, strict=True):
        if step is not None:
            out.append(_from_step(search, base, step, temper, workers))
            continue
        without = next(refits)
        if without is None:  # no equilibrium without it: all that is known is how it came in
            step = accepted_at(search, base.model.members[-1])
            out.append(_from_step(search, base, step, temper, workers))
        else:
            out.append(_at_final_set(search, base, without, temper, workers))
    return tuple(out)


def _without_own_law(search: EffectSearch, member: Hypothesis) -> Fit:
    """The last set, the member last, under errors that do not grant its own law."""
    errors = search.without_own_discrepancy.get(member.name, search.with_law_discrepancy.model.likelihood)
    return last_member(refit_to_errors(search.with_law_discrepancy, errors), member)


def _first_size(base: Fit) -> int:
    return base.z.size - len(base.model.members[-1].sizes)


def _same_set(search: EffectSearch, base: Fit) -> Step | None:
    """The step that brought the last member in, if it began with exactly the set without it."""
    step = accepted_at(search, base.model.members[-1])
    before, without = step.before.model, base.model.members[:-1]
    same = {h.name for h in before.members} == {h.name for h in without}
    errors = zip(before.likelihood.curves, base.model.likelihood.curves, strict=True)
    return step if same and all(a is b for a, b in errors) else None


def _from_step(
    search: EffectSearch, base: Fit, step: Step, temper: float, workers: DiscoveryWorkers
) -> Alternatives:
    """The alternatives from refits of the search; frictional ones driven by the loops of the last set."""
    own = _own(base, step.before, search.prior)
    kept = [
        t
        for t in step.trials
        if plausible(t)
        and len(t.fit.model.members) == len(base.model.members)
        and _may_replace(base, t.hypothesis)
    ]
    axle = base.model.axle
    stale = [t for t in kept if t.fit.model.axle != axle and _frictional(t.fit)]
    starts = [(replace(t.fit.model, axle=axle), t.fit.z) for t in stale]
    fits = workers.fits(starts, "refitting rivals", step.before.jacobian) if starts else []
    again = {
        t.hypothesis.name: hypothesis_fit(f, step.before, search.prior)
        for t, f in zip(stale, fits, strict=True)
        if f is not None
    }
    rivals = sorted((again.get(t.hypothesis.name, t) for t in kept), key=lambda t: -t.gain)
    first = next(s for s in step.screened if s.hypothesis.name == own.hypothesis.name)
    others = [s for s in step.screened if _may_replace(base, s.hypothesis)]
    return Alternatives(step.before, (first, *others), (own, *rivals), temper)


def _at_final_set(
    search: EffectSearch, base: Fit, without: Fit, temper: float, workers: DiscoveryWorkers
) -> Alternatives:
    """The alternatives from refits of the last set without the member and with each rival in its place."""
    own = _own(base, without, search.prior)
    known = {s.hypothesis.name: s for s in _screened(search, without)}
    first = score_test(without, known.pop(own.hypothesis.name))
    first = replace(first, gain=max(first.gain, own.gain))
    there = [score_test(without, s) for s in known.values() if _may_replace(base, s.hypothesis)]
    there.sort(key=lambda s: -s.gain)
    near = _near([first, *there], threshold(len(known) + 1), without, workers)
    rivals = [t for t in joint_refits(without, near, search.prior, workers) if plausible(t)]
    return Alternatives(without, (first, *there), (own, *rivals), temper)


def _near(
    screened: Sequence[Screened], least: float, without: Fit, workers: DiscoveryWorkers
) -> list[Screened]:
    """Rivals of the first that are worth a refit, their sizes followed on true solutions."""
    chosen = [s.hypothesis for s in leaders(screened, without.without_traces, least / 2.0)[1:]]
    return [s for s in workers.screenings(without, chosen) if not s.failed]


def _own(base: Fit, without: Fit, prior: SetPrior) -> HypothesisFit:
    return hypothesis_fit(base, without, prior)


def _may_replace(base: Fit, hypothesis: Hypothesis) -> bool:
    """Whether it may take the last member's place: members that are in the set together are no rivals."""
    *others, own = base.model.members
    if hypothesis.name == own.name or (hypothesis.effect != own.effect and _among(others, hypothesis.effect)):
        return False
    return compatible(base.model.without(own), hypothesis)


def _among(members: Sequence[Hypothesis], effect: str) -> bool:
    return any(h.effect == effect for h in members)


def _frictional(fit: Fit) -> bool:
    return fit.model.with_effects(fit.z).topology.frictional


def _screened(search: EffectSearch, without: Fit) -> list[Screened]:
    """Every hypothesis as it was screened last, in the errors of `without`."""
    latest = {s.hypothesis.name: (s, step) for step in search.steps for s in step.screened}
    return [
        s.rewhitened(step.before.model.likelihood, without.model.likelihood) for s, step in latest.values()
    ]
