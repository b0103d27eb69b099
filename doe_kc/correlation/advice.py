"""Sentences about what bounds and levels allow, for a correlation that cannot reach what it is asked for."""

from __future__ import annotations

import numpy as np

from doe_kc.correlation.linearization import Linearization
from doe_kc.correlation.problem import Evaluated, Problem
from doe_kc.correlation.reach import Relaxation, conflict

COARSE = 0.25
"""Share of the rating that half a level of one variable may cost unmentioned."""


def reach_sentences(problem: Problem, relaxed: Relaxation) -> list[str]:
    """One for every target that the bounds do not reach without harm to others, known beforehand."""
    known = {t.entry.id: t for t in problem.targets.characteristics}
    out = []
    for ident, distance in relaxed.distances.items():
        target = known[ident]
        out.append(
            f"{ident}: the target {target.value:.4g} {target.entry.unit} is out of reach within the bounds "
            f"without harm to others, to first order; its interval is widened to {distance:.3g} "
            f"{target.entry.unit} either way. Wider bounds of {', '.join(relaxed.limits[ident])} would help "
            "most, or an effect that the model lacks: doe-kc discover looks for it."
        )
    return out


def conflict_sentences(problem: Problem, best: Evaluated, expansion: Linearization) -> list[str]:
    """One when the best design violates constraints that no neighbour within the bounds meets together."""
    if best.score is None or best.rating is None or best.rating.feasible:
        return []
    slopes = expansion.characteristics[problem.targets.rows]
    trade_off = conflict(problem.targets.characteristics, best.score.values, slopes, best.point)
    if trade_off is None:
        return []
    names = ", ".join(t.entry.id for t in trade_off.violated)
    against = ", ".join(t.entry.id for t in trade_off.against)
    clause = f" together with {against}" if against else ""
    return [
        f"No design within the bounds meets {names}{clause}, to first order: widen bounds, weight what "
        "matters more, try --method pareto for the trade-off, or look for an effect that the model lacks."
    ]


def level_sentences(problem: Problem, best: Evaluated, expansion: Linearization) -> list[str]:
    """One for every objective that half a level of a variable moves by more than its target's error, and by
    a share of the rating that other levels hardly make up for."""
    variables = problem.space.variables
    half = np.array([0.0 if v.levels is None else 0.5 / (v.levels - 1) for v in variables])
    moves = np.abs(expansion.characteristics[problem.targets.rows]) * half
    out = []
    for target, row in zip(problem.targets.characteristics, moves, strict=True):
        if target.objective is None or not row.any():
            continue
        at = int(np.argmax(row))
        cost = target.objective.linear * row[at] / target.objective.norm
        if row[at] > target.sd and cost > COARSE * abs(best.merit):
            out.append(
                f"{target.entry.id}: half a level of {variables[at].path} moves it by {row[at]:.2g} "
                f"{target.entry.unit}, {cost:.2g} of the rating ({best.merit:.2g}); give its variables more "
                'levels, or levels = "continuous".'
            )
    return out
