"""The laws and the optimum that a set ends with, beside which further effects are asked for once more."""

from __future__ import annotations

from collections.abc import Set
from dataclasses import dataclass

from doe_kc.discovery.fit import Fit
from doe_kc.discovery.search.baseline import with_traces_anew
from doe_kc.discovery.search.convergence import at_optimum
from doe_kc.discovery.search.free_shapes import with_unlike_bushings
from doe_kc.discovery.search.laws import with_best_closed_laws
from doe_kc.discovery.search.other_optima import at_best_optimum
from doe_kc.discovery.workers import DiscoveryWorkers


@dataclass(frozen=True)
class FinalLaws:
    """What a set ends with."""

    fit: Fit
    """By the best closed laws of its frictions, at the best optimum that fits reach, its bushings unlike."""
    loss: float
    """ln evidence that unlike bushings cost, 0 where they cost none."""
    changed: bool
    """Whether any of the three is another than before."""


def with_final_laws(current: Fit, compared: Set[str], workers: DiscoveryWorkers) -> FinalLaws:
    """The set by those laws.

    compared: see `with_best_closed_laws`. Beside a steering friction of free shape and a trace in the
    strut by Dahl's law a bushing's progression of 0.13 1/mm^2 was less likely than none; beside
    Prandtl-Iwan's law for both it has odds of 1600.
    """
    ended = at_optimum(with_traces_anew(current, workers), workers)
    best = at_best_optimum(with_best_closed_laws(ended, workers, compared), workers)
    unlike = with_unlike_bushings(best, workers)
    return FinalLaws(unlike, max(0.0, best.evidence - unlike.evidence), unlike is not ended)
