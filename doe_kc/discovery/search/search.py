"""The search for the most probable set of effects: linear proposals, decided by joint refits."""

from __future__ import annotations

from collections.abc import Mapping, Sequence, Set
from dataclasses import dataclass, replace

from doe_kc.axle.model import Axle
from doe_kc.correlation.likelihood import Likelihood
from doe_kc.discovery.fit import Fit
from doe_kc.discovery.gauss_newton import FitStart
from doe_kc.discovery.model import EffectModel
from doe_kc.discovery.screening.screen import Screened, rewhitened_screenings
from doe_kc.discovery.search.baseline import tune, with_sides_anew, with_traces
from doe_kc.discovery.search.conditioning import own_loops, with_conditioning
from doe_kc.discovery.search.convergence import both_optima, converged_fit, fit_to_errors
from doe_kc.discovery.search.decision import Decision, HypothesisGain, Step, next_decision, temper
from doe_kc.discovery.search.final_laws import with_final_laws
from doe_kc.discovery.search.free_shapes import with_free_shapes
from doe_kc.discovery.search.law_discrepancy import (
    effect_signals,
    fit_discrepancy,
    marginal,
    without_own_discrepancy,
)
from doe_kc.discovery.search.law_variants import frictions
from doe_kc.discovery.search.laws import may_open, with_free_laws, with_friction_laws
from doe_kc.discovery.search.laws_first import effect_or_laws, laws_of
from doe_kc.discovery.search.nominal_refits import refit_anew
from doe_kc.discovery.search.pruning import backward_elimination
from doe_kc.discovery.search.refits import HypothesisFit
from doe_kc.discovery.search.set_prior import SetPrior
from doe_kc.discovery.thresholds import ACCEPTED_ODDS, EFFECTS_MOST, MOST_STEPS
from doe_kc.discovery.workers import DiscoveryWorkers
from doe_kc.effects import EFFECTS
from doe_kc.effects.hypothesis import Hypothesis


@dataclass(frozen=True)
class EffectSearch:
    """The search for the most probable set of effects, and the fits that it ends with."""

    tuned: Fit
    """The re-tuned axle without any effect, nor traces of them: the baseline of every comparison."""
    steps: tuple[Step, ...]
    """In their order; the last one accepts nothing, or reached the largest number of effects or of steps."""
    first: Decision
    """The first step, or after an exchange of effects the first one since: where it began without any effect,
    all that the verdict on a single effect takes; without derivatives where any later set was another."""
    screened: tuple[Screened, ...]
    """Every hypothesis as it was screened last, in the errors of `with_law_discrepancy`."""
    with_law_discrepancy: Fit
    """With all accepted effects; the errors of the records hold the discrepancy of the effects' laws."""
    with_effects: Fit
    """With the same effects, fitted to the records' own errors alone, from there: what is handed over."""
    discrepancy_shares: Mapping[str, float]
    """Member's name -> standard deviation of its law's discrepancy, relative to what it makes of a curve."""
    without_own_discrepancy: Mapping[str, Likelihood]
    """Name of a member with such a discrepancy -> the last errors of the records without its own."""
    prior: SetPrior
    """Probabilities of sets before the records."""
    shape_loss: float
    """ln evidence that frictions of free shape cost at the last, the width of their prior; 0 without any, and
    where one has more than the closed law."""
    with_other_laws: Fit | None
    """`with_law_discrepancy` by closed laws of its frictions where those have free shapes, or by free shapes
    where those fit as well but leave what closed laws explain; None where there is none."""

    larger: tuple[HypothesisFit, ...] = ()
    """Sets with one effect more, which one of its members may hide, as probable as the last one, or more so
    by less than an effect needs. To the records' own errors, without derivatives; see
    `with_series_compliances`."""

    @property
    def evidence(self) -> float:
        """ln evidence of the last set by the closed laws of most evidence, to the records' own errors."""
        return self.with_effects.evidence + self.shape_loss

    @property
    def log_posterior(self) -> float:
        """ln of the last set's probability, relative to a constant that all sets and errors share."""
        last = self.with_law_discrepancy
        return marginal(last) + self.shape_loss + self.prior.log(last.model.members)


def search(model: EffectModel, library: Sequence[Hypothesis], workers: DiscoveryWorkers) -> EffectSearch:
    """Tune, then add, exchange and take out effects as long as the evidence asks for it.

    NotConverged when the nominal axle has no equilibrium.
    """
    return _continued(_start(model, library, workers), library, workers)


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
    (other,) = workers.fits([start], "exchanging effects")
    if other is None:
        return before
    last, own, prior = before.with_law_discrepancy, before.tuned.model, before.prior
    steps, added = before.steps, (changed,) if changed else ()
    if changed:
        candidates = (HypothesisGain(changed, gain, True),)
        step = Step(last.model.members, before.with_effects.rms, candidates, temper(other), added, True)
        steps = (*steps, step)
    taken, _ = _with_loops(other, added, own.axle, workers, known=False)
    following, shares, without_own = _settled(taken, own.likelihood, own, {}, prior, workers)
    errors = last.model.likelihood, following.model.likelihood
    screened = tuple(rewhitened_screenings(before.screened, *errors))
    state = _SearchState(before.tuned, steps, following, screened, shares, without_own, prior)
    return _continued(state, library, workers)


def _start(model: EffectModel, library: Sequence[Hypothesis], workers: DiscoveryWorkers) -> _SearchState:
    """Without any effect."""
    tuned = tune(model)
    workers.watch("re-tuning", 1)
    screened = workers.screenings(tuned, library)
    current = with_traces(tuned, screened)
    return _SearchState(tuned, (), current, tuple(screened), {}, {}, SetPrior.of(library))


@dataclass(frozen=True)
class _SearchState:
    """A search under way."""

    tuned: Fit
    """See `EffectSearch`, as those below of the same names."""
    steps: tuple[Step, ...]
    current: Fit
    """The set that it goes on from."""
    screened: tuple[Screened, ...]
    """Every hypothesis as it was screened last, in the errors of `current`."""
    shares: Mapping[str, float]
    without_own: Mapping[str, Likelihood]
    prior: SetPrior


def _continued(state: _SearchState, library: Sequence[Hypothesis], workers: DiscoveryWorkers) -> EffectSearch:
    """The search from there to its end."""
    tuned, prior, current = state.tuned, state.prior, state.current
    model, first = tuned.model, None
    steps, loops_known, laws_tried = list(state.steps), False, False
    ended = last_laws = False  # every effect asked for beside the laws of the end; the set has those
    compared: Set[str] = frozenset()
    shares, without_own = state.shares, state.without_own
    screened: Sequence[Screened] = state.screened
    tried, shape_loss = {laws_of(current)}, 0.0
    del state  # derivatives go as soon as nothing begins from them: so here, and below
    while True:
        laws_open = not laws_tried and may_open(current)
        first_screened = first.screened if first else ()
        decision = next_decision(
            current, library, prior, workers, screened, first_screened, laws_open=laws_open
        )
        first = first or decision
        steps.append(decision.step(model.likelihood, prior))
        full = decision.accepted and len(decision.trials[0].fit.model.members) > EFFECTS_MOST
        if full or len(steps) >= MOST_STEPS:
            steps[-1] = replace(decision, accepted=False).step(model.likelihood, prior)
            current, cost, _ = with_final_laws(current, compared, workers)
            shape_loss += cost
            break
        before = current.model.likelihood
        instead = None
        if decision.accepted:
            instead, taken = effect_or_laws(current, decision.trials[0], tried, model.likelihood, workers)
            if taken is not None:
                decision = replace(decision, trials=(taken, *decision.trials[1:]))
            elif instead is None:
                decision = replace(decision, accepted=False)
                steps[-1] = decision.step(model.likelihood, prior)
            del taken
        if instead is not None:
            steps.pop()
            current = instead
            tried.add(laws_of(current))
            last_laws = False
        elif decision.accepted:
            current, added, decision = decision.trials[0].fit, steps[-1].added, decision.without_trials
            current, loops_known = _with_loops(current, added, model.axle, workers, known=loops_known)
            laws_tried, compared = ended, compared if ended else frozenset()
            last_laws = False
        elif (anew := refit_anew(current, workers)) is not None:
            current = anew
            del anew
        else:
            opened = current
            if laws_open:
                opened, compared = with_free_laws(current, model.likelihood, workers)
                if opened is current:
                    laws_tried = True
                    steps.pop()  # the same step again, now with every other effect
                    continue
            elif not laws_tried:
                opened, compared = with_friction_laws(current, model.likelihood, shares, workers)
            laws_tried = True
            if opened is current:
                if last_laws:
                    break
                opened, cost, changed = with_final_laws(current, compared, workers)
                shape_loss += cost
                if ended or not changed:
                    current = opened
                    break
                ended, last_laws, compared = True, True, {h.name for h in frictions(opened)}
                steps.pop()  # the same step again, beside other laws
            current = opened
            del opened
        count = len(current.model.members)
        current, shares, without_own = _settled(current, before, model, without_own, prior, workers)
        if len(current.model.members) != count:  # laws were compared beside an effect that has gone
            compared, last_laws = frozenset(), False
        screened = _latest(screened, decision, current)
        del decision
        if len(current.model.members) != 1:
            first = first.without_derivatives
    if len(current.model.members) != 1:
        first = first.without_derivatives
    decision = decision.without_trials
    before_shapes = current.evidence
    current, other = with_free_shapes(current, workers)
    shape_loss += max(0.0, before_shapes - current.evidence)
    other = None if other is None else other.without_derivatives
    last = tuple(_latest(screened, decision, current))
    current, with_effects = both_optima(current, model.likelihood, workers)
    return EffectSearch(
        tuned,
        tuple(steps),
        first,
        last,
        current,
        with_effects,
        shares,
        without_own,
        prior,
        shape_loss,
        other,
    )


def _with_loops(
    taken: Fit, added: Sequence[Hypothesis], own: Axle, workers: DiscoveryWorkers, *, known: bool
) -> tuple[Fit, bool]:
    """A set that was taken, with the loops before the record that the records ask for, and whether those are
    known. own: the axle as given."""
    if known or not any(EFFECTS[h.effect].frictional for h in added):
        return taken, known
    return with_conditioning(taken, own, workers)


def _settled(
    current: Fit,
    before: Likelihood,
    own: EffectModel,
    without_own: Mapping[str, Likelihood],
    prior: SetPrior,
    workers: DiscoveryWorkers,
) -> tuple[Fit, dict[str, float], dict[str, Likelihood]]:
    """A set without what it makes needless, its laws' discrepancy among the errors, with that discrepancy's
    shares and what `without_own_discrepancy` says.

    before: the errors of the set before it. own: the model without effects, in the records' own errors.
    without_own: of the set before it.
    """
    current = with_sides_anew(current)
    current = backward_elimination(current, ACCEPTED_ODDS, workers, without_own, prior)
    exact = fit_to_errors(own_loops(current, own.axle), own.likelihood, workers)
    signals = effect_signals(exact)
    settled, shares = fit_discrepancy(exact, signals)
    following = without_own_discrepancy(exact, signals, shares)
    del current, exact  # before the last fit: their derivatives are large
    if settled.model.likelihood is not before:
        settled = converged_fit(settled, workers)
    return settled, shares, following


def _latest(known: Sequence[Screened], decision: Decision, current: Fit) -> list[Screened]:
    """Every hypothesis as it was screened last, in the errors of `current`; known: in those of the step."""
    newer = {s.hypothesis.name: s for s in decision.screened}
    errors = decision.before.model.likelihood, current.model.likelihood
    return rewhitened_screenings([newer.get(s.hypothesis.name, s) for s in known], *errors)
