"""The last set without each of its effects."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from doe_kc.correlation.likelihood import Likelihood
from doe_kc.discovery.fit import Fit, last_member
from doe_kc.discovery.gauss_newton import FitStart
from doe_kc.discovery.search.convergence import fits_to_errors
from doe_kc.discovery.search.effect_search import EffectSearch
from doe_kc.discovery.thresholds import BEYOND_DOUBT
from doe_kc.discovery.workers import DiscoveryWorkers
from doe_kc.effects.hypothesis import Hypothesis


@dataclass(frozen=True)
class Removal:
    """One effect taken out of the last set."""

    base: Fit
    """The set with it as the last member, in its own errors, without derivatives."""
    without: Fit
    """The set without it in the same errors, fitted as far as anything turns on it; the re-tuned axle where
    that has no equilibrium."""


def removals(search: EffectSearch, members: Sequence[Hypothesis], workers: DiscoveryWorkers) -> list[Removal]:
    """Of some members of the last set."""
    final = search.with_law_discrepancy
    nears = fits_to_errors(final, [own_errors(search, member) for member in members], workers)
    bases = [last_member(near, m).without_derivatives for near, m in zip(nears, members, strict=True)]
    starts = [
        FitStart(near.model.without(m), base.z[: base.z.size - len(m.sizes)], near, ceiling_of(base))
        for near, base, m in zip(nears, bases, members, strict=True)
    ]
    workers.fits(starts, "taking effects out", derivatives=lambda _: False)
    starts = [replace(start, near=final) for start in starts]
    del nears  # before the cache of results gives those fits with derivatives: 25 MB
    fits = workers.fits(starts, "taking effects out")
    return [Removal(base, fit or search.tuned) for base, fit in zip(bases, fits, strict=True)]


def own_errors(search: EffectSearch, member: Hypothesis) -> Likelihood:
    """Errors of the records that do not grant the member's own law."""
    return search.without_own_discrepancy.get(member.name, search.with_law_discrepancy.model.likelihood)


def ceiling_of(base: Fit) -> float:
    """Cost above which another set is out of the question."""
    return base.cost + 2.0 * BEYOND_DOUBT
