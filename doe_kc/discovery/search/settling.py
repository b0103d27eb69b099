"""A set that was taken, brought to rest before the search goes on: its loops, needless members, errors."""

from __future__ import annotations

from collections.abc import Sequence

from doe_kc.axle.model import Axle
from doe_kc.correlation.likelihood import Likelihood
from doe_kc.discovery.fit import Fit
from doe_kc.discovery.gauss_newton import refit_to_errors
from doe_kc.discovery.model import EffectModel
from doe_kc.discovery.search.baseline import with_sides_anew
from doe_kc.discovery.search.conditioning import own_loops, with_conditioning
from doe_kc.discovery.search.convergence import at_optimum, converged_fit
from doe_kc.discovery.search.law_discrepancy import effect_signals, fit_discrepancy, without_own_discrepancy
from doe_kc.discovery.search.member_state import MemberState
from doe_kc.discovery.search.pruning import backward_elimination
from doe_kc.discovery.search.set_prior import SetPrior
from doe_kc.discovery.thresholds import ACCEPTED_ODDS
from doe_kc.discovery.workers import DiscoveryWorkers
from doe_kc.effects import EFFECTS
from doe_kc.effects.hypothesis import Hypothesis


def with_loops(
    taken: Fit, added: Sequence[Hypothesis], own: Axle, workers: DiscoveryWorkers, *, known: bool
) -> tuple[Fit, bool]:
    """A set that was taken, with the loops before the record that the records ask for, and whether those are
    known. own: the axle as given."""
    if known or not any(EFFECTS[h.effect].frictional for h in added):
        return taken, known
    return with_conditioning(taken, own, workers)


def settled(
    current: Fit,
    before: Likelihood,
    own: EffectModel,
    known: MemberState,
    prior: SetPrior,
    workers: DiscoveryWorkers,
) -> tuple[Fit, MemberState]:
    """A set without what it makes needless, its laws' discrepancy among the errors, and what is known of its
    members.

    before: the errors of the set before it. own: the model without effects, in the records' own errors.
    known: of the set before it.
    """
    current = with_sides_anew(current)
    near = refit_to_errors(own_loops(current, own.axle), own.likelihood)
    kept = backward_elimination(current, ACCEPTED_ODDS, workers, known, prior, near)
    if kept.fit is not current:
        near = refit_to_errors(own_loops(kept.fit, own.axle), own.likelihood)
    exact = kept.beside or at_optimum(near, workers)
    removals = kept.removals
    del near, kept
    signals = effect_signals(exact, workers)
    at_rest, shares = fit_discrepancy(exact, signals)
    state = MemberState(shares, without_own_discrepancy(exact, signals, shares), removals)
    del current, exact  # before the last fit: their derivatives are large
    if at_rest.model.likelihood is not before:
        at_rest = converged_fit(at_rest, workers)
    return at_rest, state
