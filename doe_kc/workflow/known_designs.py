"""Designs that a correlation need not find: those sampled before, and the one that a discovery fitted."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from doe_kc.campaign.runner import Campaign
from doe_kc.correlation.problem import Candidate, Problem
from doe_kc.true_solver.outcome import Outcome
from doe_kc.variables import Space
from doe_kc.workflow.adopt import Adoption

NEAREST = 160
"""Sampled designs that count as known, those nearest the start."""
NEAREST_WITH_SLOPES = 16
"""The same beside exact slopes. On the example 200 of them made a run ten times as long and no better."""


def sampled(campaign: Campaign, problem: Problem) -> list[tuple[Candidate, Outcome]]:
    """Stored designs of sampling campaigns that lie in the problem's space, those nearest the start.

    Beside exact slopes they say little, and surrogates slow down with the cube of their number.
    """
    start, most = problem.space.start, NEAREST_WITH_SLOPES if problem.exact else NEAREST
    designs = [
        (candidate, record.key)
        for record in campaign.store.records("sample:*")
        if (candidate := inside(problem.space, record.parameters)) is not None
    ]
    designs.sort(key=lambda d: float(np.linalg.norm(d[0].point - start)))
    windows = campaign.solver.windows
    return [(c, campaign.store.outcome(key, windows)) for c, key in designs[:most]]


def inside(space: Space, values: Mapping[str, float]) -> Candidate | None:
    """The design as a point of the space; None when it is not one of it."""
    if not set(space.paths) <= set(values):
        return None
    point = space.unit(values)
    same = space.values(point)
    if set(same) != set(values) or any(abs(same[p] - v) > 1e-9 * max(1.0, abs(v)) for p, v in values.items()):
        return None
    return Candidate(point, "sample") if bool(((point >= 0.0) & (point <= 1.0)).all()) else None


def refit_proposal(problem: Problem, adoption: Adoption | None) -> list[Candidate]:
    """The design that a discovery fitted, within the bounds; none without one."""
    if adoption is None or not adoption.refit:
        return []
    space = problem.space
    point = np.array([v.place(adoption.refit.get(v.path, v.start)) for v in space.variables])
    return [Candidate(space.snapped(point), "discovery refit")]
