"""The law of an effect is part of the set: a friction by the default law, or by one of open shape; a
compliance linear or stiffening.

What a wrong law leaves behind looks like another effect, and hides others; a law of more numbers takes up
what is another effect's. So the law of a friction is exchanged where nothing else explains what remains, or
its own discrepancy alone, and a compliance's where nothing else does.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence, Set
from dataclasses import replace

import numpy as np

from doe_kc.correlation.likelihood import Likelihood
from doe_kc.discovery.fit import Fit
from doe_kc.discovery.gauss_newton import FitStart, refit_to_errors
from doe_kc.discovery.search.convergence import fit_to_errors
from doe_kc.discovery.search.free_shapes import (
    best_fit,
    beyond_trace,
    frictions_to_free,
    is_rubber,
    with_most_numbers,
    within_trace,
)
from doe_kc.discovery.search.law_discrepancy import effect_signals, fit_discrepancy
from doe_kc.discovery.search.law_variants import (
    frictions,
    laws_of_no_more_numbers,
    open_laws,
    other_laws,
    with_law,
)
from doe_kc.discovery.thresholds import BEYOND_DOUBT, FEW_CONTRASTS, NOISE_CHANCE
from doe_kc.discovery.workers import DiscoveryWorkers
from doe_kc.effects import EFFECTS
from doe_kc.effects.hypothesis import Hypothesis


def may_open(current: Fit) -> bool:
    """Whether what remains may be another law of a friction in the set.

    That comes before further effects that nothing points to: a third law of a steering friction looked like a
    compliance of the rack's mount.
    """
    unexplained = current.residual_map.chance < NOISE_CHANCE
    return unexplained and any(open_laws(member) for member in current.model.members)


def with_explaining_law(taken: Fit, own: Likelihood, workers: DiscoveryWorkers) -> tuple[Fit, Set[str]]:
    """A set of dry frictions alone by the closed laws beside which noise explains all that remains, and their
    names; where there are none the set as it is.

    own: the records' own errors. Asked as soon as such a set is taken: a strut friction of nearly one
    breakaway, 94.9 N, left 4000 of cost by Dahl's law, and an offset of camber, a bushing's progression and
    20 s came in before laws were compared. A fit that does not promise to come near noise is given up, so
    that where further effects are missing it costs some tenths of a second.
    """
    members = frictions(taken)
    if len(members) < len(taken.model.members) or any(is_rubber(h) for h in members) or not may_open(taken):
        return taken, frozenset()
    exact = refit_to_errors(taken, own)
    most = FEW_CONTRASTS * exact.residual.size
    for member in members:
        exact = _with_closed_law(exact, member, other_laws(member), workers, most)
    if exact.residual_map.chance < NOISE_CHANCE:
        return taken, frozenset()
    return exact, {h.name for h in members}


def with_friction_laws(
    current: Fit, own: Likelihood, shares: Mapping[str, float], workers: DiscoveryWorkers
) -> tuple[Fit, Set[str]]:
    """The fit with the best laws of the frictions whose law has a discrepancy: closed ones, and free ones of
    those that `with_free_shapes` leaves; and names of those that `with_best_closed_laws` need not compare
    again.

    own: the records' own errors, see `with_free_laws`. shares: member's name -> its law's discrepancy among
    the errors of the fit. Asked once nothing else comes in: a friction of two stages, 268 N, was 211 +- 7 N
    by Dahl's law, whose discrepancy explained what it left. Not before: 489 N beside a mount of the rack of
    3675 N/mm were 234 N by Duhem's law without a mount.
    """
    members = [h for h in frictions(current) if open_laws(h) and shares.get(h.name, 0.0) > 0.0]
    if not members:
        return current, frozenset()
    exact = fit_to_errors(current, own, workers)
    later = {h.name for h in frictions_to_free(exact)}

    def best(fit: Fit, member: Hypothesis) -> Fit:
        if member.name in later:
            return _with_closed_law(fit, member, other_laws(member), workers)
        return with_best_law(fit, member, workers)

    opened, compared = _until_explained(exact, sorted(members, key=lambda h: h.name in later), best)
    return current if opened is exact else opened, compared


def with_free_laws(current: Fit, own: Likelihood, workers: DiscoveryWorkers) -> tuple[Fit, Set[str]]:
    """The fit with the laws that gain evidence, closed or free, where nothing else explains what remains; and
    names of the frictions that `with_best_closed_laws` need not compare again.

    own: the records' own errors, to which such a law is fitted: errors that hold the discrepancy of the law
    before it take a poor one for explained. A friction of two stages, 227 N over 0.19 mm, ended at 223 N over
    0.38 mm in them, 20 of ln evidence behind.

    Those of compliances count if they leave nothing that noise and their own discrepancy do not explain. Else
    the discrepancy of the linear law says as much with fewer numbers, and the effect stays named.
    """
    exact = fit_to_errors(current, own, workers)
    members = sorted((h for h in frictions(exact) if open_laws(h)), key=lambda h: not is_rubber(h))
    opened, compared = _until_explained(exact, members, lambda fit, h: with_best_law(fit, h, workers))
    bent = _bent(opened, workers)
    if bent is not opened and _explained(bent, workers):
        return bent, compared
    return current if opened is exact else opened, compared


def _until_explained(
    exact: Fit, members: Sequence[Hypothesis], best: Callable[[Fit, Hypothesis], Fit]
) -> tuple[Fit, Set[str]]:
    """The fit with the best law of each of its frictions, one after the other, until noise explains the rest.

    And names of those that need no other comparison: beside the laws that the others have now, or of a free
    shape, which `with_exchanged_laws` compares with closed ones.
    """
    compared: set[str] = set()
    for member in members:
        if exact.residual_map.chance >= NOISE_CHANCE:
            break
        before, exact = exact, best(exact, member)
        if exact is not before:
            compared = {h.name for h in frictions(exact) if h.name in compared and not open_laws(h)}
        compared.add(member.name)
    return exact, compared


def with_best_law(current: Fit, member: Hypothesis, workers: DiscoveryWorkers, useful: float = np.inf) -> Fit:
    """The fit with the law of most evidence for a friction by a closed law: its own, another closed one, or
    where noise does not explain what those leave a free one, which begins from the best of them.

    useful: cost above which no law is of use. A free shape pays for the width of its prior, so that it has to
    end below the closed law: of a strut friction by Prandtl-Iwan's law it had 26 to 81 of ln evidence less
    than that, and kept other effects out. It is not given up where it promises to end above it: its cost is
    rough, and one of two stages, 318 N, that promised 4500 more ended 3160 below. A trace has laws of no more
    numbers: 3 N in a strut had all others, beside a free play that makes each fit long.
    """
    trace = within_trace(current, member)
    laws = laws_of_no_more_numbers(member) if trace else other_laws(member)
    best = _with_closed_law(current, member, laws, workers, useful)
    if trace or best.residual_map.chance >= NOISE_CHANCE:
        return best
    closed = best.model.member(member.name)
    free = best_fit(replace(with_most_numbers(best, [closed]), ceiling=useful), workers)
    return best if free is None or free.evidence <= best.evidence else free


def _bent(current: Fit, workers: DiscoveryWorkers) -> Fit:
    for member in current.model.members:
        for law in open_laws(member)[-1:] if not EFFECTS[member.effect].frictional else ():
            current = _opened(current, member, law, workers)
    return current


def _explained(exact: Fit, workers: DiscoveryWorkers) -> bool:
    """Whether noise and the discrepancy of its laws explain what a fit to the records' own errors leaves."""
    settled, _ = fit_discrepancy(exact, effect_signals(exact, workers))
    return settled.residual_map.chance >= NOISE_CHANCE


def with_best_closed_laws(current: Fit, workers: DiscoveryWorkers, compared: Set[str] = frozenset()) -> Fit:
    """The fit with the closed law of most evidence for every friction but those that have been compared: on
    it hang its own size and those of others.

    The free shape begins from it, and does not find back from a wrong one: its sliders make the cost rough.
    A trace has the laws of no more numbers to choose from, beside another effect: 5 N in a strut by Dahl's
    law where Prandtl-Iwan's is the car's left 0.7 standard deviations in a tyre's compliance.
    """
    free = frictions_to_free(current)
    others = any(h not in frictions(current) for h in current.model.members)
    for member in frictions(current):
        if member.name in compared or not EFFECTS[member.effect].laws:
            continue
        laws = other_laws(member)
        if member not in free and not beyond_trace(current, member):
            laws = laws_of_no_more_numbers(member) if others else []
        current = _with_closed_law(current, member, laws, workers)
    return current


def _with_closed_law(
    current: Fit,
    member: Hypothesis,
    laws: Sequence[Hypothesis],
    workers: DiscoveryWorkers,
    useful: float = np.inf,
) -> Fit:
    # from the numbers of another law a fit promises little at first: one given up 40 of cost behind Dahl's
    # was 46 better at its end, and a hub's stiffness beside Dahl's 5309 +- 719 for 13 900
    most = min(useful, current.cost + 2.0 * BEYOND_DOUBT)
    starts = [FitStart(*with_law(current.model, current.z, member, law), current, most) for law in laws]
    refits = [f for f in workers.fits(starts, "exchanging laws") if f is not None]
    return max([current, *refits], key=lambda f: f.evidence)


def _opened(current: Fit, member: Hypothesis, law: Hypothesis, workers: DiscoveryWorkers) -> Fit:
    if current.residual_map.chance >= NOISE_CHANCE:
        return current
    refit = best_fit(FitStart(*with_law(current.model, current.z, member, law), current), workers)
    if refit is None or refit.evidence < current.evidence:
        return current
    return refit
