"""Chooses the designs of a round: where the surrogates see the front, spread over it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from doe_kc.correlation.front import bearable, non_dominated
from doe_kc.correlation.methods.pareto.modelled_objectives import ModelledObjectives
from doe_kc.correlation.methods.pareto.nsga3 import Judge, nsga3, reference_directions
from doe_kc.correlation.modelled.history import SearchHistory
from doe_kc.correlation.modelled.output_model import best_predicted
from doe_kc.correlation.modelled.trust_region import TrustBox
from doe_kc.ground.typing import FloatArray

GENERATIONS = 40
STRESS = 4.0
"""Weight of the objective that a starting corner favours, the others 1."""
CORNER_SPREAD = 0.05
"""Standard deviation of the rest of the first population about the corners, share of the bounds."""


def predicted_front(
    record: SearchHistory, modelled: ModelledObjectives, box: TrustBox, count: int, rng: np.random.Generator
) -> FloatArray:
    """(p, d) non-dominated designs on levels that the surrogates expect, of `count` objectives."""
    judge = _judge(record, modelled)
    directions = reference_directions(count)
    first = _first_population(record, modelled, box, directions, rng)
    seed = int(rng.integers(2**31))
    population = nsga3(judge, first, directions, box.lower, box.upper, generations=GENERATIONS, seed=seed)
    points = np.unique(record.problem.space.snapped(population), axis=0)
    values, violation = judge(points)
    if (violation > 0.0).all():
        return np.asarray(points[non_dominated(np.column_stack([values, violation]))])
    allowed = np.flatnonzero(violation <= 0.0)
    return np.asarray(points[allowed[non_dominated(values[allowed])]])


def _judge(record: SearchHistory, modelled: ModelledObjectives) -> Judge:
    """Objectives on levels; a loss beyond what is bearable counts as a violation."""
    space = record.problem.space
    limit = bearable(modelled.values(record.best.point[None])[0].sum())

    def judge(x: FloatArray) -> tuple[FloatArray, FloatArray]:
        values, violation = modelled.values(space.snapped(x))
        return values, violation + np.maximum(values.sum(axis=1) - limit, 0.0) / max(abs(limit), 1e-12)

    return judge


def _first_population(
    record: SearchHistory,
    modelled: ModelledObjectives,
    box: TrustBox,
    directions: FloatArray,
    rng: np.random.Generator,
) -> FloatArray:
    """(r, d) corners, then confirmed designs in the box, then random ones near both.

    From random designs alone NSGA-III would need far more generations.
    """
    inside = [e.point for e in record.ranked if np.all((e.point >= box.lower) & (e.point <= box.upper))]
    seeds = [*corners(record, modelled, box, directions.shape[1]), *inside][: len(directions)]
    chosen = rng.integers(len(seeds), size=len(directions) - len(seeds))
    near = np.array(seeds)[chosen] + CORNER_SPREAD * rng.standard_normal((len(chosen), box.lower.size))
    return box.clip(np.vstack([np.array(seeds), near]))


def corners(
    record: SearchHistory, modelled: ModelledObjectives, box: TrustBox, count: int
) -> list[FloatArray]:
    """Best predicted rating with equal weights, and with each objective stressed in turn."""
    weights = [np.ones(count), *(1.0 + (STRESS - 1.0) * np.eye(count))]
    composites = [modelled.weighted(w) for w in weights]
    start = record.best.point
    return [best_predicted(record.problem, record.model, c, box, start, doubt=0.0) for c in composites]


def spread_out(values: FloatArray, known: FloatArray, number: int) -> NDArray[np.int_]:
    """Places of up to `number` rows (p, g), each the farthest from `known` (n, g) and those chosen before.

    Distances in objectives scaled by the range of the rows.
    """
    scale = np.ptp(values, axis=0)
    scale = np.where(scale > 0.0, scale, 1.0)
    taken = [*(known / scale)]
    chosen: list[int] = []
    while len(chosen) < min(number, len(values)):
        apart = np.linalg.norm((values / scale)[:, None] - np.array(taken)[None], axis=2).min(axis=1)
        chosen.append(int(np.argmax(apart)))
        taken.append(values[chosen[-1]] / scale)
    return np.array(chosen, dtype=int)
