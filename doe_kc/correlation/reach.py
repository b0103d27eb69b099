"""What the bounds allow, to first order: targets out of reach, constraints that exclude each other."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import linprog, lsq_linear

from doe_kc.ground.typing import FloatArray
from doe_kc.targets import Target, Targets
from doe_kc.targets.comparison.interval import constraint_interval
from doe_kc.targets.improvement import SIGNIFICANT
from doe_kc.true_solver.outcome import Outcome

FORECAST_MARGIN = 0.2
"""Share of a range by which a first-order forecast may be wrong before a target counts as out of reach."""
ACTIVE = 1e-6
QUIET_SHARE = 1.0 / 3.0
"""Share of an interval's half-width within which a value is not harmed: forecasts are of first order."""
PURSUED = 4.0
"""Prior standard deviations that closing a target out of reach is worth: one parameter at its bound is 1.7,
so a bound too narrow is used up, while an effect that is missing does not bend all parameters."""
ALIKE_SHARE = 0.2
"""Share of an interval's half-width within which two solvers describe the same axle."""
WIDENING = 1.1
"""Times the distance that is reached to first order: the widened interval."""


@dataclass(frozen=True)
class Relaxation:
    """Targets that the bounds do not reach without harm to others, known before the search.

    distances: characteristic id -> half-width about the target that is reached. limits: id -> paths of the
    variables at a bound that move it most.
    """

    distances: Mapping[str, float]
    limits: Mapping[str, tuple[str, ...]]


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


def answers_alike(targets: Targets, own: Outcome, other: Outcome) -> bool:
    """Whether two solvers say the same of a design: every characteristic with a target within ALIKE of its
    interval's half-width."""
    rows = targets.rows
    half = np.array([_half_width(t) for t in targets.characteristics])
    apart = np.abs(own.characteristics[rows] - other.characteristics[rows])
    return not own.failed and bool((apart <= ALIKE_SHARE * half).all())


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
    programme = linprog(
        np.concatenate([np.zeros(d), np.ones(m)]),
        A_ub=np.block([[jacobian, -np.eye(m)], [-jacobian, -np.eye(m)]]),
        b_ub=np.concatenate([high / half - now, now - low / half]),
        bounds=[*zip(-point, 1.0 - point, strict=True), *[(0.0, None)] * m],
    )
    if (
        programme.status != 0
        or programme.x is None
        or programme.fun is None
        or programme.fun <= FORECAST_MARGIN
    ):
        return None
    price = np.abs(programme.ineqlin.marginals).reshape(2, m).sum(axis=0)
    missed = programme.x[d:] > ACTIVE
    return Conflict(
        tuple(targets[i] for i, out in zip(rows, missed, strict=True) if out),
        tuple(targets[i] for i, out, p in zip(rows, missed, price, strict=True) if not out and p > ACTIVE),
    )


def relaxation(
    targets: Sequence[Target],
    values: FloatArray,
    slopes: FloatArray,
    point: FloatArray,
    prior_sd: FloatArray,
    paths: Sequence[str],
) -> Relaxation:
    """What to widen, to first order about a design with values (k,) and slopes (k, d) at point (d,).

    Out of reach is a target whose interval no design within the bounds meets, alone or while all others
    stay as near to theirs as they are (a linear programme). It is then pursued as if its error were a
    quarter of its distance, beside all others and the prior (bounded least squares): the distance reached.
    """
    aimed = [i for i, t in enumerate(targets) if t.relax and _aims(t)]
    missed = out_of_reach([targets[i] for i in aimed], values[aimed], slopes[aimed], point)
    places = [aimed[i] for i in missed]
    if not places:
        return Relaxation({}, {})
    step = _pursued(targets, values, slopes, point, prior_sd, places)
    ended = values + slopes @ step
    distances: dict[str, float] = {}
    limits: dict[str, tuple[str, ...]] = {}
    for i in places:
        target = targets[i]
        before, after = abs(values[i] - target.value), abs(ended[i] - target.value)
        distances[target.entry.id] = min(before, WIDENING * after)
        towards = np.sign(target.value - values[i]) * slopes[i]
        room = np.where(towards > 0.0, 1.0 - point, point)
        order = np.argsort(-np.abs(towards) * room)[:3]
        limits[target.entry.id] = tuple(paths[j] for j in order)
    return Relaxation(distances, limits)


def out_of_reach(
    targets: Sequence[Target], values: FloatArray, slopes: FloatArray, point: FloatArray
) -> list[int]:
    """Places of the targets whose interval is not met, alone or beside all others."""
    if not targets:
        return []
    half = np.array([_half_width(t) for t in targets])
    distance = np.abs(values - np.array([t.value for t in targets]))
    span = reaches(values, slopes, point)
    wanted = np.array([t.value for t in targets])
    margin = FORECAST_MARGIN * (span[:, 1] - span[:, 0])
    alone = (wanted + half < span[:, 0] - margin) | (wanted - half > span[:, 1] + margin)
    alone &= distance > half
    outside = distance > half
    sd = np.array([t.sd for t in targets])
    quiet = np.maximum(np.maximum(SIGNIFICANT * sd, distance), QUIET_SHARE * half)
    slack = _least_slack(values - wanted, slopes, point, np.where(outside, half, quiet), half, outside)
    together = outside & (slack > FORECAST_MARGIN)
    return [int(i) for i in np.flatnonzero(alone | together)]


def _least_slack(
    residual: FloatArray,
    slopes: FloatArray,
    point: FloatArray,
    limit: FloatArray,
    half: FloatArray,
    outside: np.ndarray,
) -> FloatArray:
    """(k,) by how many half-widths each limit must be widened, least in sum; only those `outside` may be."""
    k, d = slopes.shape
    jacobian, now = slopes / half[:, None], residual / half
    freedom = np.where(outside, np.maximum(np.abs(residual) - limit, 0.0) / half, 0.0)
    solution = linprog(
        np.concatenate([np.zeros(d), np.ones(k)]),
        A_ub=np.block([[jacobian, -np.eye(k)], [-jacobian, -np.eye(k)]]),
        b_ub=np.concatenate([limit / half - now, limit / half + now]),
        bounds=[*zip(-point, 1.0 - point, strict=True), *((0.0, float(f) + ACTIVE) for f in freedom)],
    )
    return freedom if solution.x is None else np.asarray(solution.x[d:])


def _pursued(
    targets: Sequence[Target],
    values: FloatArray,
    slopes: FloatArray,
    point: FloatArray,
    prior_sd: FloatArray,
    missed: Sequence[int],
) -> FloatArray:
    """(d,) the step that the prior and all targets allow."""
    wanted = np.array([t.value for t in targets])
    error = np.array([max(t.sd, QUIET_SHARE * _half_width(t)) for t in targets])
    for i in missed:
        error[i] = max(error[i], abs(values[i] - wanted[i]) / PURSUED)
    aims = np.array([_aims(t) for t in targets])
    rows = np.vstack([np.diag(1.0 / prior_sd), slopes[aims] / error[aims, None]])
    right = np.concatenate([np.zeros(point.size), (wanted - values)[aims] / error[aims]])
    bounds = (np.minimum(-point, -ACTIVE), np.maximum(1.0 - point, ACTIVE))
    return np.asarray(lsq_linear(rows, right, bounds, method="bvls").x)


def _aims(target: Target) -> bool:
    return target.objective is None or target.objective.goal == "target"


def _half_width(target: Target) -> float:
    c = target.constraint
    low, high = (c.low, c.high) if c is not None else constraint_interval(target.value)
    return (high - low) / 2.0
