"""What the bounds allow, to first order: targets out of reach, constraints that exclude each other."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import linprog

from doe_kc.targets import Target
from doe_kc.typing import FloatArray

MARGIN = 0.2
"""Share of a range by which a first-order forecast may be wrong before a target counts as out of reach."""
ACTIVE = 1e-6


@dataclass(frozen=True)
class Conflict:
    """violated: constraints that no design within the bounds meets together with `against`."""

    violated: tuple[Target, ...]
    against: tuple[Target, ...]


def reaches(values: FloatArray, slopes: FloatArray, point: FloatArray) -> FloatArray:
    """(k, 2) lowest and highest value of each characteristic within the bounds.

    values: (k,) and slopes: (k, d) at point (d,) in [0, 1].
    """
    down, up = slopes * -point, slopes * (1.0 - point)
    low = values + np.minimum(down, up).sum(axis=1)
    high = values + np.maximum(down, up).sum(axis=1)
    return np.column_stack([low, high])


def unreachable(targets: Sequence[Target], span: FloatArray) -> list[Target]:
    """Active targets whose interval (or value, without one) the bounds do not reach."""
    out = []
    for target, (low, high) in zip(targets, span, strict=True):
        c = target.constraint
        wanted = (c.low, c.high) if c is not None else (target.value, target.value)
        margin = MARGIN * (high - low)
        aimed = target.objective is None or target.objective.goal == "target"
        if target.active and aimed and (wanted[1] < low - margin or wanted[0] > high + margin):
            out.append(target)
    return out


def conflict(
    targets: Sequence[Target], values: FloatArray, slopes: FloatArray, point: FloatArray
) -> Conflict | None:
    """Which constraints exclude each other about a design; None when a first-order step meets them all.

    Minimizes the sum of the violations in units of the intervals' half-widths over the bounds (a linear
    programme); the constraints with a price are those that pull against each other.
    """
    rows = [i for i, t in enumerate(targets) if t.constraint is not None]
    bounds = [targets[i].constraint for i in rows]
    low = np.array([c.low for c in bounds if c is not None])
    high = np.array([c.high for c in bounds if c is not None])
    half = (high - low) / 2.0
    jacobian, now = slopes[rows] / half[:, None], values[rows] / half
    d, m = point.size, len(rows)
    if m == 0:
        return None
    found = linprog(
        np.concatenate([np.zeros(d), np.ones(m)]),
        A_ub=np.block([[jacobian, -np.eye(m)], [-jacobian, -np.eye(m)]]),
        b_ub=np.concatenate([high / half - now, now - low / half]),
        bounds=[*zip(-point, 1.0 - point, strict=True), *[(0.0, None)] * m],
    )
    if found.status != 0 or found.x is None or found.fun is None or found.fun <= MARGIN:
        return None
    price = np.abs(found.ineqlin.marginals).reshape(2, m).sum(axis=0)
    missed = found.x[d:] > ACTIVE
    return Conflict(
        tuple(targets[i] for i, out in zip(rows, missed, strict=True) if out),
        tuple(targets[i] for i, out, p in zip(rows, missed, price, strict=True) if not out and p > ACTIVE),
    )
