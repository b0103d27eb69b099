"""The last set without each of its effects: what that loses."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TypeVar

from doe_kc.correlation.likelihood import Likelihood
from doe_kc.discovery.fit import Fit, last_member
from doe_kc.discovery.gauss_newton import FitStart
from doe_kc.discovery.search.convergence import fits_to_errors
from doe_kc.discovery.search.search import EffectSearch
from doe_kc.discovery.thresholds import BEYOND_DOUBT
from doe_kc.discovery.workers import DiscoveryWorkers
from doe_kc.effects.hypothesis import Hypothesis

T = TypeVar("T")
AT_ONCE = 3
"""Members whose fits have their derivatives at the same time: of some 15 MB each, and as much again."""


@dataclass(frozen=True)
class Removal:
    """One effect taken out of the last set."""

    base: Fit
    """The set with it as the last member, in its own errors, without derivatives."""
    start: FitStart
    """Of the fit without it, which the cache of results has from here on."""
    loss: float
    """ln evidence lost by it."""


def removals(search: EffectSearch, workers: DiscoveryWorkers) -> list[Removal]:
    """Of every member of the last set, fitted as far as anything turns on it. Their derivatives are taken up
    again by a few at a time: those of ten members at once were a quarter of all memory."""
    final = search.with_law_discrepancy
    out: list[Removal] = []
    for members in in_groups(final.model.members):
        nears = fits_to_errors(final, [own_errors(search, member) for member in members], workers)
        bases = [last_member(near, m).without_derivatives for near, m in zip(nears, members, strict=True)]
        starts = [
            FitStart(near.model.without(m), base.z[: base.z.size - len(m.sizes)], near, ceiling_of(base))
            for near, base, m in zip(nears, bases, members, strict=True)
        ]
        fits = workers.fits(starts, "taking effects out", derivatives=lambda _: False)
        for base, start, fit in zip(bases, starts, fits, strict=True):
            without = fit or search.tuned  # no equilibrium without it: nothing in the model at all
            out.append(Removal(base, replace(start, near=final), base.evidence - without.evidence))
    return out


def in_groups(members: Sequence[T]) -> list[Sequence[T]]:
    """AT_ONCE of them each, the last group fewer."""
    return [members[i : i + AT_ONCE] for i in range(0, len(members), AT_ONCE)]


def own_errors(search: EffectSearch, member: Hypothesis) -> Likelihood:
    """Errors of the records that do not grant the member's own law."""
    return search.without_own_discrepancy.get(member.name, search.with_law_discrepancy.model.likelihood)


def ceiling_of(base: Fit) -> float:
    """Cost above which another set is out of the question."""
    return base.cost + 2.0 * BEYOND_DOUBT
