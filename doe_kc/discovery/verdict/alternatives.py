"""What could be in the place of each effect of the last set, all others in it: nothing, or another effect.

The step that brought an effect in says nothing of that: other effects were missing then, and what looked like
a rival may have come in beside it. So each is taken out of the last set, and each plausible rival that would
explain the same is put in its place, all else refitted.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from doe_kc.discovery.fit import Fit, FitStart, last_member, refit_to_errors
from doe_kc.discovery.screening.disagreement import Map
from doe_kc.discovery.screening.screen import Screened, rewhitened_screenings, score_tests
from doe_kc.discovery.search.compatibility import compatible
from doe_kc.discovery.search.refits import (
    HypothesisFit,
    hypothesis_fit,
    leaders,
    plausible,
    refit_starts,
)
from doe_kc.discovery.search.search import Decision, EffectSearch, threshold
from doe_kc.discovery.search.set_prior import SetPrior
from doe_kc.discovery.thresholds import BEYOND_DOUBT
from doe_kc.discovery.workers import DiscoveryWorkers
from doe_kc.effects.hypothesis import Hypothesis


@dataclass(frozen=True)
class Alternatives:
    """One effect of the last set, its removal and its rivals."""

    without: Fit
    """The set without it, refitted; the errors hold the discrepancy of all others' laws, not that of its own
    nor of its rivals'."""
    screened: tuple[Screened, ...]
    """Itself, then the library without the other members, added to `without`; some without derivatives."""
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
    """The alternatives of every member of the last set, in its order.

    A decoy of another kind is put in the place of the one whose removal costs most, where a reader looks
    for it.
    """
    final = search.with_law_discrepancy
    bases = [_without_own_law(search, h) for h in final.model.members]
    if len(bases) == 1 and _is_first(search, bases[0]):
        return (_from_first_step(search, bases[0], search.first, temper, workers),)
    removals = workers.fits([_removal(base) for base in bases], "taking effects out")
    withouts = [w or search.tuned for w in removals]  # no equilibrium without it: nothing in the model at all
    losses = [base.evidence - w.evidence for base, w in zip(bases, withouts, strict=True)]
    places = [
        _place(search, base, without, decoy=loss == max(losses))
        for base, without, loss in zip(bases, withouts, losses, strict=True)
    ]
    places = _on_true_solutions(places, workers)
    starts = [refit_starts(p.without, p.near, _ceiling(p.base)) for p in places]
    refits = iter(workers.fits([start for own in starts for start in own], "refitting rivals"))
    return tuple(
        _judged(place, [next(refits) for _ in own], search, temper)
        for place, own in zip(places, starts, strict=True)
    )


@dataclass(frozen=True)
class _Place:
    """The place of one effect in the last set."""

    base: Fit
    """The set with it as the last member."""
    without: Fit
    """The set without it."""
    screened: tuple[Screened, ...]
    """Itself, then what may take its place, without derivatives."""
    near: tuple[Screened, ...]
    """Its rivals that are worth a refit."""


def _without_own_law(search: EffectSearch, member: Hypothesis) -> Fit:
    """The last set, the member last, under errors that do not grant its own law."""
    errors = search.without_own_discrepancy.get(member.name, search.with_law_discrepancy.model.likelihood)
    return last_member(refit_to_errors(search.with_law_discrepancy, errors), member)


def _removal(base: Fit) -> FitStart:
    """The last set without the last member, to be fitted as far as anything turns on it."""
    member = base.model.members[-1]
    z = base.z[: base.z.size - len(member.sizes)]
    return FitStart(base.model.without(member), z, base, _ceiling(base))


def _ceiling(base: Fit) -> float:
    """Cost above which another set is out of the question."""
    return base.cost + 2.0 * BEYOND_DOUBT


def _is_first(search: EffectSearch, base: Fit) -> bool:
    """Whether the first step began with exactly the set without the last member, in the same errors."""
    before = search.first.before.model
    errors = zip(before.likelihood.curves, base.model.likelihood.curves, strict=True)
    alone = len(base.model.members) == 1 and not before.members
    return alone and all(a is b for a, b in errors)


def _from_first_step(
    search: EffectSearch, base: Fit, first: Decision, temper: float, workers: DiscoveryWorkers
) -> Alternatives:
    """The alternatives from refits of the search; frictional ones driven by the loops of the last set."""
    own = _own(base, first.before, search.prior)
    kept = [
        t
        for t in first.trials
        if plausible(t) and len(t.fit.model.members) == 1 and _may_replace(base, t.hypothesis)
    ]
    axle = base.model.axle
    stale = [t for t in kept if t.fit.model.axle != axle and _frictional(t.fit)]
    starts = [FitStart(replace(t.fit.model, axle=axle), t.fit.z, t.fit) for t in stale]
    fits = workers.fits(starts, "refitting rivals")
    again = {
        t.hypothesis.name: hypothesis_fit(f, first.before, search.prior)
        for t, f in zip(stale, fits, strict=True)
        if f is not None
    }
    rivals = sorted((again.get(t.hypothesis.name, t) for t in kept), key=lambda t: -t.gain)
    itself = next(s for s in first.screened if s.hypothesis.name == own.hypothesis.name)
    others = [s for s in first.screened if _may_replace(base, s.hypothesis)]
    return Alternatives(first.before, (itself, *others), (own, *rivals), temper)


def _place(search: EffectSearch, base: Fit, without: Fit, *, decoy: bool) -> _Place:
    """The place of the last member of `base`, and what is worth a refit in it."""
    known = {s.hypothesis.name: s for s in _screened(search, without)}
    own = _own(base, without, search.prior)
    itself = known.pop(own.hypothesis.name)
    others = [s for s in known.values() if _may_replace(base, s.hypothesis)]
    first, *there = score_tests(without, [itself, *others])
    first = replace(first, gain=max(first.gain, own.gain))
    there.sort(key=lambda s: -s.gain)
    near = leaders([first, *there], without, threshold(len(known) + 1) / 2.0, decoy=decoy)
    return _Place(base, without, tuple(s.change_only for s in (first, *there)), tuple(near[1:]))


def _on_true_solutions(places: Sequence[_Place], workers: DiscoveryWorkers) -> list[_Place]:
    """The places, the sizes of the rivals in them followed on true solutions."""
    screened = workers.screenings_beside([(p.without, [s.hypothesis for s in p.near]) for p in places])
    return [
        replace(place, near=tuple(s for s in near if not s.failed))
        for place, near in zip(places, screened, strict=True)
    ]


def _judged(place: _Place, refits: Sequence[Fit | None], search: EffectSearch, temper: float) -> Alternatives:
    """The alternatives from refits of the last set without the member and with each rival in its place."""
    trials = [hypothesis_fit(f, place.without, search.prior) for f in refits if f is not None]
    rivals = sorted(filter(plausible, trials), key=lambda t: -t.gain)
    own = _own(place.base, place.without, search.prior)
    return Alternatives(place.without, place.screened, (own, *rivals), temper)


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
    errors = search.with_law_discrepancy.model.likelihood, without.model.likelihood
    return rewhitened_screenings(search.screened, *errors)
