"""The search for the most probable set of effects: linear proposals, decided by joint refits."""

from __future__ import annotations

from collections.abc import Sequence, Set
from dataclasses import dataclass, replace

from doe_kc.discovery.fit import Fit
from doe_kc.discovery.gauss_newton import FitStart
from doe_kc.discovery.model import EffectModel
from doe_kc.discovery.screening.screen import Screened, rewhitened_screenings
from doe_kc.discovery.search.baseline import tune, with_traces
from doe_kc.discovery.search.convergence import both_optima
from doe_kc.discovery.search.decision import Decision, HypothesisGain, Step, next_decision, runners_up
from doe_kc.discovery.search.effect_search import EffectSearch
from doe_kc.discovery.search.final_laws import with_final_laws
from doe_kc.discovery.search.free_shapes import with_free_shapes
from doe_kc.discovery.search.law_variants import frictions
from doe_kc.discovery.search.laws import (
    may_open,
    with_explaining_law,
    with_free_laws,
    with_friction_laws,
)
from doe_kc.discovery.search.laws_first import laws_instead, laws_of, needless_beside_laws
from doe_kc.discovery.search.member_state import MemberState
from doe_kc.discovery.search.nominal_refits import refit_anew
from doe_kc.discovery.search.other_optima import at_best_free_shape
from doe_kc.discovery.search.refits import temper
from doe_kc.discovery.search.set_prior import SetPrior
from doe_kc.discovery.search.settling import settled, with_loops
from doe_kc.discovery.thresholds import EFFECTS_MOST, MOST_STEPS
from doe_kc.discovery.workers import DiscoveryWorkers
from doe_kc.effects._friction import FREE_LAW
from doe_kc.effects.hypothesis import Hypothesis


def search(model: EffectModel, library: Sequence[Hypothesis], workers: DiscoveryWorkers) -> EffectSearch:
    """Tune, then add, exchange and take out effects as long as the evidence asks for it.

    NotConverged when the nominal axle has no equilibrium.
    """
    return _SetSearch(_start(model, library, workers), library, workers).run()


def search_from(
    before: EffectSearch,
    start: FitStart,
    changed: Hypothesis | None,
    gain: float,
    library: Sequence[Hypothesis],
    workers: DiscoveryWorkers,
) -> EffectSearch:
    """The search, gone on from another set than its last one; the same where that has no equilibrium.

    start: of a fit of that set to the records' own errors. changed: its member that the last set does not
    have, or not by that law; None where it only has fewer. gain: ln of its posterior odds against the last
    set.
    """
    state = _state_of(before, start, changed, gain, workers)
    if state is None:
        return before
    following = _SetSearch(state, library, workers)
    del state  # its derivatives
    return following.run()


def _state_of(
    before: EffectSearch,
    start: FitStart,
    changed: Hypothesis | None,
    gain: float,
    workers: DiscoveryWorkers,
) -> SearchState | None:
    """See `search_from`."""
    (other,) = workers.fits([start], "exchanging effects")
    if other is None:
        return None
    last, own, prior = before.with_law_discrepancy, before.tuned.model, before.prior
    steps, added = before.steps, (changed,) if changed else ()
    if changed:
        candidates = (HypothesisGain(changed, gain, True),)
        step = Step(last.model.members, before.with_effects.rms, candidates, temper(other), added, True)
        steps = (*steps, step)
    taken, _ = with_loops(other, added, own.axle, workers, known=False)
    following, known = settled(taken, own.likelihood, own, MemberState(), prior, workers)
    errors = last.model.likelihood, following.model.likelihood
    screened = tuple(rewhitened_screenings(before.screened, *errors))
    return SearchState(before.tuned, steps, following, screened, known, prior)


def _start(model: EffectModel, library: Sequence[Hypothesis], workers: DiscoveryWorkers) -> SearchState:
    """Without any effect."""
    tuned = tune(model)
    workers.watch("re-tuning", 1)
    if not tuned.residual_map.agrees:
        workers.defer(tuned)
    screened = workers.screenings(tuned, library)
    current = with_traces(tuned, screened)
    return SearchState(tuned, (), current, tuple(screened), MemberState(), SetPrior.of(library))


@dataclass(frozen=True)
class SearchState:
    """A search under way."""

    tuned: Fit
    """See `EffectSearch`, as those below of the same names."""
    steps: tuple[Step, ...]
    current: Fit
    """The set that it goes on from."""
    screened: tuple[Screened, ...]
    """Every hypothesis as it was screened last, in the errors of `current`."""
    known: MemberState
    """Of its members."""
    prior: SetPrior


class _SetSearch:
    """A search from a set to its end: the set that it goes on from, and what has been asked beside it."""

    def __init__(self, state: SearchState, library: Sequence[Hypothesis], workers: DiscoveryWorkers) -> None:
        self._tuned, self._prior = state.tuned, state.prior
        self._library, self._workers = library, workers
        self._steps = list(state.steps)
        self._first: Decision | None = None
        self._current, self._screened = state.current, state.screened
        self._known = state.known
        self._shape_loss, self._laws_had = 0.0, {laws_of(state.current)}
        self._compared: Set[str] = frozenset()
        """Frictions whose laws need no other comparison."""
        self._laws_open = self._laws_asked = False
        """Whether other laws come before effects that nothing points to; whether they were asked for."""
        self._loops_known = False
        self._at_end = self._last_laws = False
        """Whether every effect is asked for beside the laws of the end; whether the set has those."""

    def run(self) -> EffectSearch:
        """To its end."""
        while True:
            decision = self._decided()
            following = self._following(decision)
            decision = decision.without_trials
            if following is None:
                return self._ended(decision)
            if following is not self._current:
                self._settle(following, decision)
            del following, decision  # derivatives go as soon as nothing begins from them

    def _decided(self) -> Decision:
        """The next step, as it is told for now, with its first refit alone."""
        self._laws_open = not self._laws_asked and may_open(self._current)
        decision = next_decision(
            self._current,
            self._library,
            self._prior,
            self._workers,
            self._screened,
            self._first.screened if self._first else (),
            runners_up=runners_up(self._steps),
            laws_open=self._laws_open,
        )
        self._first = self._first or decision
        self._steps.append(decision.step(self._tuned.model.likelihood, self._prior))
        return replace(decision, trials=decision.trials[:1])  # derivatives of the others go

    def _following(self, decision: Decision) -> Fit | None:
        """The set that the search goes on from: the current one where the same step is asked for again, None
        at the end."""
        full = decision.accepted and len(decision.trials[0].fit.model.members) > EFFECTS_MOST
        if full or len(self._steps) >= MOST_STEPS:
            self._refuse()
            final = with_final_laws(self._current, self._compared, self._workers)
            self._current, self._shape_loss = final.fit, self._shape_loss + final.loss
            return None
        if decision.accepted and (taken := self._effect_or_laws(decision)) is not None:
            return taken
        return refit_anew(self._current, self._workers) or self._other_laws()

    def _refuse(self) -> None:
        """Tell that the last step accepts nothing."""
        self._steps[-1] = replace(self._steps[-1], added=(), accepted=False)

    def _effect_or_laws(self, decision: Decision) -> Fit | None:
        """The set with what the step accepts, beside the laws that say most with it, or by other laws in its
        stead; None where the laws of compliances make it needless.

        A set whose laws were exchanged does not return to laws that it had: a free shape has several optima,
        and what is better from one of them may not be from another.
        """
        current, own, further = self._current, self._tuned.model.likelihood, decision.trials[0]
        other = laws_instead(current, further, own, self._workers)
        if other is not None and laws_of(other) in self._laws_had:
            other = None
        if other is not None and _names(other) != _names(further.fit):
            self._steps.pop()
            self._laws_had.add(laws_of(other))
            self._last_laws = False
            return other
        if needless_beside_laws(current, further, own, self._workers):
            self._refuse()
            return None
        return self._with_effect(further.fit if other is None else other)

    def _with_effect(self, taken: Fit) -> Fit:
        """The set that a step ends with, driven by the loops that the records ask for."""
        self._last_laws, self._laws_asked = False, self._at_end
        self._compared = self._compared if self._at_end else frozenset()
        added, known, own = self._steps[-1].added, self._loops_known, self._tuned.model
        fit, self._loops_known = with_loops(taken, added, own.axle, self._workers, known=known)
        fit, explaining = with_explaining_law(fit, own.likelihood, self._workers)
        self._compared = self._compared | explaining
        return fit

    def _other_laws(self) -> Fit | None:
        """The set by other laws, where nothing else comes in."""
        current, own, opened = self._current, self._tuned.model.likelihood, self._current
        compared = self._compared
        if self._laws_open:
            opened, compared = with_free_laws(current, own, self._workers)
        elif not self._laws_asked:
            opened, compared = with_friction_laws(current, own, self._known.shares, self._workers)
        self._compared = self._compared | compared if opened is current else compared
        self._laws_asked = True
        if opened is not current:
            return opened
        if self._laws_open:
            self._steps.pop()  # the same step again, now with every other effect
            return current
        return None if self._last_laws else self._laws_of_the_end()

    def _laws_of_the_end(self) -> Fit | None:
        """The set by those, beside which every effect is asked for once more; None where it has been, or they
        are no others."""
        final = with_final_laws(self._current, self._compared, self._workers)
        self._shape_loss += final.loss
        if self._at_end or not final.changed:
            self._current = final.fit
            return None
        self._at_end = self._last_laws = True
        self._compared = {h.name for h in frictions(final.fit)}
        self._steps.pop()  # the same step again, beside other laws
        return final.fit

    def _settle(self, following: Fit, decision: Decision) -> None:
        """Go on from a set, once it is at rest."""
        count, before = len(following.model.members), self._current.model.likelihood
        self._current, self._known = settled(
            following, before, self._tuned.model, self._known, self._prior, self._workers
        )
        if len(self._current.model.members) != count:  # laws were compared beside an effect that has gone
            self._compared, self._last_laws = frozenset(), False
        self._screened = tuple(_latest(self._screened, decision, self._current))
        self._let_go()

    def _let_go(self) -> None:
        """Of the derivatives of the first step, with which only the verdict on a single effect begins."""
        if self._first is not None and len(self._current.model.members) != 1:
            self._first = self._first.without_derivatives

    def _ended(self, decision: Decision) -> EffectSearch:
        """The search with the fits that it ends with. decision: the last one."""
        self._let_go()
        before = self._current.evidence
        current, other = with_free_shapes(self._current, self._workers)
        own = {h.name for h in self._current.model.members if h.law == FREE_LAW}
        current, optima = at_best_free_shape(current, own, self._workers)
        self._shape_loss += max(0.0, before - current.evidence)
        last = tuple(_latest(self._screened, decision, current))
        current, with_effects = both_optima(current, self._tuned.model.likelihood, self._workers)
        assert self._first is not None
        return EffectSearch(
            self._tuned,
            tuple(self._steps),
            self._first,
            last,
            current,
            with_effects,
            self._known.shares,
            self._known.without_own,
            self._prior,
            self._shape_loss,
            None if other is None else other.without_derivatives,
            optima,
        )


def _names(fit: Fit) -> set[str]:
    return {h.name for h in fit.model.members}


def _latest(known: Sequence[Screened], decision: Decision, current: Fit) -> list[Screened]:
    """Every hypothesis as it was screened last, in the errors of `current`; known: in those of the step."""
    newer = {s.hypothesis.name: s for s in decision.screened}
    errors = decision.before.model.likelihood, current.model.likelihood
    return rewhitened_screenings([newer.get(s.hypothesis.name, s) for s in known], *errors)
