"""What could be in the place of each effect of the last set, all others in it: nothing, or another effect.

The step that brought an effect in says nothing of that: other effects were missing then, and what looked like
a rival may have come in beside it. So each is taken out of the last set, and each plausible rival that would
explain the same is put in its place, all else refitted.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import TypeVar

import numpy as np

from doe_kc.discovery.fit import Fit, member_detectability
from doe_kc.discovery.gauss_newton import FitStart
from doe_kc.discovery.screening.score_test import score_tests
from doe_kc.discovery.screening.screen import Screened, rewhitened_screenings
from doe_kc.discovery.search.compatibility import compatible
from doe_kc.discovery.search.convergence import fit_to_errors
from doe_kc.discovery.search.decision import threshold
from doe_kc.discovery.search.effect_search import EffectSearch
from doe_kc.discovery.search.refits import (
    HypothesisFit,
    hypothesis_fit,
    leaders,
    plausible,
    refit_starts,
)
from doe_kc.discovery.thresholds import NAME_ALWAYS_LEVEL
from doe_kc.discovery.verdict.removals import Removal, ceiling_of, own_errors, removals
from doe_kc.discovery.workers import DiscoveryWorkers
from doe_kc.effects.hypothesis import Hypothesis
from doe_kc.ground.typing import FloatArray

T = TypeVar("T")
AT_ONCE = 3
"""Members that are compared at the same time: the fit without one and its derivatives take some 25 MB."""


@dataclass(frozen=True)
class EffectChange:
    """What an effect makes of the records beyond what re-tuning could, in the set without it."""

    contrasts: FloatArray
    """(k,) of each contrast, without a sign."""
    correlations: tuple[tuple[str, float], ...]
    """Id of each effect that was screened in its place, and the correlation of what both make, -1 to 1."""


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
    change: EffectChange
    """What it makes of the records."""
    removal_chance: float
    """How often noise alone leaves as large a disagreement as the set without it; 0 where its removal costs
    NAME_ALWAYS_LEVEL standard deviations."""

    @property
    def hypothesis(self) -> Hypothesis:
        """The effect itself."""
        return self.trials[0].hypothesis

    @property
    def loss(self) -> float:
        """ln evidence lost by its removal."""
        return _loss(self.trials)

    @property
    def without_derivatives(self) -> Alternatives:
        """The same, its fits without derivatives and what was screened without changes."""
        return replace(
            self,
            without=self.without.without_derivatives,
            screened=tuple(s.numbers_only for s in self.screened),
            trials=tuple(replace(t, fit=t.fit.without_derivatives) for t in self.trials),
        )


def comparison(
    without: Fit,
    screened: Sequence[Screened],
    change: EffectChange,
    trials: Sequence[HypothesisFit],
    temper: float,
) -> Alternatives:
    """The alternatives of the first of the trials. without: with derivatives. screened, change, trials: see
    there."""
    strong = 2.0 * _loss(trials) >= NAME_ALWAYS_LEVEL**2
    chance = 0.0 if strong else without.residual_map.chance
    return Alternatives(without, tuple(screened), tuple(trials), temper, change, chance)


def effect_change(without: Fit, screened: Sequence[Screened]) -> EffectChange:
    """What the first of those screened makes of the records, and the others beside it."""
    first, others = screened[0], [s for s in screened[1:] if not s.failed]
    changes = without.changes(np.array([s.change for s in (first, *others)]).T)
    seen, own = without.without_traces, changes.columns(slice(1))
    left = seen.remaining(own)[:, 0]
    along, lengths = seen.inner(own, changes)[0], np.sqrt(seen.squares(changes)) * np.sqrt(seen.squares(own))
    alike = np.divide(along, lengths, out=np.zeros(along.size), where=lengths > 0.0)
    return EffectChange(
        np.asarray(np.abs(without.model.contrasts.rows.T @ left)),
        tuple(
            (s.hypothesis.effect, float(c))
            for s, c in zip(others, np.clip(alike[1:], -1.0, 1.0), strict=True)
        ),
    )


def _loss(trials: Sequence[HypothesisFit]) -> float:
    return trials[0].gain - trials[0].prior


def alternatives(search: EffectSearch, temper: float, workers: DiscoveryWorkers) -> tuple[Alternatives, ...]:
    """The alternatives of every member of the last set, in its order."""
    return in_set_order(
        search, [one for group in alternatives_by_group(search, temper, workers) for one in group]
    )


def in_set_order(search: EffectSearch, compared: Sequence[Alternatives]) -> tuple[Alternatives, ...]:
    """The alternatives of every member of the last set."""
    by_name = {one.hypothesis.name: one for one in compared}
    return tuple(by_name[h.name] for h in search.with_law_discrepancy.model.members)


def alternatives_by_group(
    search: EffectSearch, temper: float, workers: DiscoveryWorkers
) -> Iterator[list[Alternatives]]:
    """The alternatives of a few members at a time, the weakest ones first: what is exchanged is among those.

    The derivatives of ten members at once were a quarter of all memory. A decoy of another kind is put in the
    place of the strongest one, where a reader looks for it.
    """
    if _is_first(search):
        yield [_from_first_step(search, temper, workers)]
        return
    members = sorted(search.with_law_discrepancy.model.members, key=lambda h: _strength(search, h))
    for group in in_groups(members):
        yield _compared(search, group, members[-1], temper, workers)


def in_groups(members: Sequence[T]) -> list[Sequence[T]]:
    """AT_ONCE of them each, the last group fewer."""
    return [members[i : i + AT_ONCE] for i in range(0, len(members), AT_ONCE)]


def _strength(search: EffectSearch, member: Hypothesis) -> float:
    """Standard deviations that a member makes at its size, all else re-tuned; one without a size, as it was
    screened."""
    if member.sizes:
        return member_detectability(search.with_effects, member)
    return next(s.detectability for s in search.screened if s.hypothesis.name == member.name)


def _compared(
    search: EffectSearch,
    group: Sequence[Hypothesis],
    strongest: Hypothesis,
    temper: float,
    workers: DiscoveryWorkers,
) -> list[Alternatives]:
    """The alternatives of some members."""
    places = [
        _place(search, removal, decoy=removal.base.model.members[-1] == strongest)
        for removal in removals(search, group, workers)
    ]
    places = _on_true_solutions(places, workers)
    rivals = [refit_starts(p.without, p.near, ceiling_of(p.base)) for p in places]
    every = [start for own in rivals for start in own]
    refits = iter(workers.fits(every, "refitting rivals", derivatives=lambda _: False))
    return [
        _place_comparison(place, [next(refits) for _ in own], search, temper)
        for place, own in zip(places, rivals, strict=True)
    ]


@dataclass(frozen=True)
class _Place:
    """The place of one effect in the last set."""

    base: Fit
    """The set with it as the last member, without derivatives."""
    without: Fit
    """The set without it."""
    screened: tuple[Screened, ...]
    """Itself, then what may take its place, without changes."""
    change: EffectChange
    """What it makes of the records."""
    near: tuple[Screened, ...]
    """Its rivals that are worth a refit."""


def _is_first(search: EffectSearch) -> bool:
    """Whether the first step began without effects and all sets since have one alone, in the same errors."""
    members = search.with_law_discrepancy.model.members
    before = search.first.before.model
    if len(members) != 1 or before.members or not search.first.has_derivatives:
        return False
    after = own_errors(search, members[0])
    return all(a is b for a, b in zip(before.likelihood.curves, after.curves, strict=True))


def _from_first_step(search: EffectSearch, temper: float, workers: DiscoveryWorkers) -> Alternatives:
    """The alternatives from refits of the search; frictional ones driven by the loops of the last set."""
    first, final = search.first, search.with_law_discrepancy
    base = fit_to_errors(final, own_errors(search, final.model.members[0]), workers)
    own = hypothesis_fit(base, first.before, search.prior)
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
    screened = (itself, *others)
    change = effect_change(first.before, screened)
    return comparison(first.before, screened, change, (own, *rivals), temper)


def _place(search: EffectSearch, removal: Removal, *, decoy: bool) -> _Place:
    """The place of an effect that was taken out, and what is worth a refit in it."""
    base, without = removal.base, removal.without
    known = {s.hypothesis.name: s for s in _screened(search, without)}
    own = hypothesis_fit(base, without, search.prior)
    itself = known.pop(own.hypothesis.name)
    others = [s for s in known.values() if _may_replace(base, s.hypothesis)]
    first, *there = score_tests(without, [itself, *others])
    first = replace(first, gain=max(first.gain, own.gain))
    there.sort(key=lambda s: -s.gain)
    near = leaders([first, *there], without, threshold(len(known) + 1) / 2.0, decoy=decoy)
    change = effect_change(without, [first, *there])
    return _Place(base, without, tuple(s.numbers_only for s in (first, *there)), change, tuple(near[1:]))


def _on_true_solutions(places: Sequence[_Place], workers: DiscoveryWorkers) -> list[_Place]:
    """The places, the sizes of the rivals in them followed on true solutions."""
    screened = workers.screenings_beside([(p.without, [s.hypothesis for s in p.near]) for p in places])
    return [
        replace(place, near=tuple(s for s in near if not s.failed))
        for place, near in zip(places, screened, strict=True)
    ]


def _place_comparison(
    place: _Place, refits: Sequence[Fit | None], search: EffectSearch, temper: float
) -> Alternatives:
    """The alternatives from refits of the last set without the member and with each rival in its place."""
    trials = [hypothesis_fit(f, place.without, search.prior) for f in refits if f is not None]
    rivals = sorted(filter(plausible, trials), key=lambda t: -t.gain)
    own = hypothesis_fit(place.base, place.without, search.prior)
    compared = comparison(place.without, place.screened, place.change, (own, *rivals), temper)
    return compared.without_derivatives


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
