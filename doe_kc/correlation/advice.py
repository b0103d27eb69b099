"""Sentences about what the bounds allow, for a correlation that cannot reach what it is asked for."""

from __future__ import annotations

from doe_kc.correlation.linearization import Linearization
from doe_kc.correlation.problem import Evaluated, Problem
from doe_kc.correlation.reach import conflict, reaches, unreachable


def reach_sentences(problem: Problem, baseline: Evaluated, expansion: Linearization) -> list[str]:
    """One for every active target that the bounds do not reach from the baseline, to first order."""
    targets, slopes = problem.targets, expansion.characteristics[problem.targets.rows]
    if baseline.score is None:
        return []
    span = reaches(baseline.score.values, slopes, baseline.point)
    missed = {t.entry.id for t in unreachable(targets.characteristics, span)}
    return [
        f"{t.entry.id}: the target {t.value:.4g} {t.entry.unit} is out of reach, within the bounds the model "
        f"goes from about {low:.4g} to {high:.4g}; check sign and unit, widen bounds, or leave it out until "
        "the effect is found that the model lacks."
        for t, (low, high) in zip(targets.characteristics, span, strict=True)
        if t.entry.id in missed
    ]


def conflict_sentences(problem: Problem, best: Evaluated, expansion: Linearization) -> list[str]:
    """One when the best design violates constraints that no neighbour within the bounds meets together."""
    if best.score is None or best.rating is None or best.rating.feasible:
        return []
    slopes = expansion.characteristics[problem.targets.rows]
    found = conflict(problem.targets.characteristics, best.score.values, slopes, best.point)
    if found is None:
        return []
    names = ", ".join(t.entry.id for t in found.violated)
    against = ", ".join(t.entry.id for t in found.against)
    clause = f" together with {against}" if against else ""
    return [
        f"No design within the bounds meets {names}{clause}, to first order: widen bounds, weight what "
        "matters more, try --method pareto for the trade-off, or look for an effect that the model lacks."
    ]
