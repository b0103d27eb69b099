"""Designs under linear constraints between their parameters: drawn more, and those kept that hold them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from doe_kc.ground.errors import InputError, nearest
from doe_kc.sampling._base import Request, Sampler, numbered
from doe_kc.sampling.design import Design
from doe_kc.variables import Space

TRIED = 4096
"""Points drawn to learn the share of the box that the constraints leave."""
LEAST_SHARE = 0.01
"""Below it a draw would be of more than a hundred designs for each that is kept."""
SURPLUS = 1.2
ROUND_OFF = 1e-9
"""Share of the sum of magnitudes by which a constraint may be missed."""


@dataclass(frozen=True)
class LinearConstraint:
    """low <= sum of factor times parameter <= high; factors by path, parameters absolute in their units."""

    factors: tuple[tuple[str, float], ...]
    low: float = -math.inf
    high: float = math.inf

    def __str__(self) -> str:
        total = " ".join(f"{factor:+g} {path}" for path, factor in self.factors)
        low = f"{self.low:g} <= " if math.isfinite(self.low) else ""
        return f"{low}{total}{f' <= {self.high:g}' if math.isfinite(self.high) else ''}"

    def holds(self, design: Design) -> np.ndarray:
        """(n,) bool of its rows."""
        columns = [design.paths.index(path) for path, _ in self.factors]
        parts = design.values[:, columns] * np.array([factor for _, factor in self.factors])
        total, slack = parts.sum(axis=1), ROUND_OFF * np.abs(parts).sum(axis=1)
        return np.asarray((total >= self.low - slack) & (total <= self.high + slack))


def constrained(
    sampler: Sampler, space: Space, request: Request, constraints: Sequence[LinearConstraint]
) -> Design:
    """Designs of the sampler that hold all constraints: n of a sized method, all that do of a full factorial.

    They fill what is left of the box as the method fills the box; each variable's slices of a hypercube are
    then no longer hit once each. InputError for a path that is neither variable nor tied nor fixed, when
    hardly any or no design is left, or for a method whose designs are given.
    """
    _check_paths(space, constraints)
    if not (sampler.sized or sampler.id == "full_factorial"):
        raise InputError(
            f"sampling: {sampler.id} has its designs from elsewhere, no constraint can choose among them; "
            "use lhs, sobol or full_factorial, or leave sampling.constraint out."
        )
    if not sampler.sized:
        design = sampler.sample(space, request)
        return _rows(design, np.flatnonzero(_hold_all(design, constraints)), 0, constraints)
    wanted = request.n
    drawn = SURPLUS * wanted / _share(space, request.seed, constraints)
    before = 0 if request.existing is None else len(request.existing)
    while True:
        design = sampler.sample(space, replace(request, n=math.ceil(drawn)))
        kept = np.flatnonzero(_hold_all(design, constraints))
        if len(kept) >= wanted:
            return _rows(design, kept[:wanted], before, constraints)
        drawn *= SURPLUS


def _check_paths(space: Space, constraints: Sequence[LinearConstraint]) -> None:
    known = set(space.values(space.start))
    for constraint in constraints:
        for path, _ in constraint.factors:
            if path not in known:
                raise InputError(
                    f"sampling.constraint: {path} is no variable of the study.{nearest(path, known)}"
                )


def _share(space: Space, seed: int, constraints: Sequence[LinearConstraint]) -> float:
    """Of the designs, those that hold the constraints."""
    points = space.drawn(np.random.default_rng(seed).random((TRIED, space.dimension)))
    rows = [space.values(point) for point in points]
    values = np.array([list(row.values()) for row in rows])
    design = Design("", tuple(rows[0]), values, tuple(map(str, range(TRIED))))
    for constraint in constraints:
        if not constraint.holds(design).any():
            raise InputError(
                f"sampling.constraint: no design within the bounds has {constraint}; widen it, or the bounds."
            )
    share = float(_hold_all(design, constraints).mean())
    if share < LEAST_SHARE:
        raise InputError(
            f"sampling.constraint: {100.0 * share:.2g} % of the designs hold all constraints, less than "
            f"{100.0 * LEAST_SHARE:g} %; widen them, tie variables that move together, or give a table."
        )
    return share


def _hold_all(design: Design, constraints: Sequence[LinearConstraint]) -> np.ndarray:
    return np.asarray(np.all([c.holds(design) for c in constraints], axis=0))


def _rows(design: Design, places: np.ndarray, before: int, constraints: Sequence[LinearConstraint]) -> Design:
    if not len(places):
        raise InputError(
            f"sampling.constraint: none of {len(design.values)} designs has {constraints[0]} and all other "
            "constraints; widen them, or take more levels."
        )
    return replace(design, values=design.values[places], labels=tuple(numbered(len(places), before)))
